"""Real scans, where there are any."""

import unittest

from support import MESHES, Command


@unittest.skipUnless((MESHES / "human_face.obj").exists(), "no scans in BELTRAMI_TEST_MESHES")
class Scans(Command):
    def test_human_face(self):
        record = self.record("map", MESHES / "human_face.obj", "-o", self.path("face.obj"), "--boundary", "disk:0.5")
        self.assertAlmostEqual(record["map"]["k"], 0.184, delta=0.002)
        self.assertEqual(record["map"]["flipped"], 0)

    def test_defective_scans_are_refused(self):
        for name in ("moebius", "triple_vierbein", "inverted_triangles"):
            failed = self.run_command("info", MESHES / "defects" / f"{name}.obj", code=4)
            self.assertTrue(failed.stderr)


if __name__ == "__main__":
    unittest.main()
