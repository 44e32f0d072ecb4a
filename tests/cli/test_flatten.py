"""beltrami flatten."""

import unittest

import numpy as np

from support import MESHES, Command, read_obj, write_obj
from test_tori import corners_of_vt, torus


class Flatten(Command):
    def test_flatten(self):
        source = self.bump_file(14)
        for arguments in ([], ["--disk"]):
            record = self.record("flatten", source, "-o", self.path("flat.obj"), *arguments)
            self.assertLess(record["map"]["mu"]["mean"], 0.05)
            self.assertEqual(record["map"]["flipped"], 0)
        _, vt, _ = read_obj(self.path("flat.obj"))
        np.testing.assert_allclose(np.linalg.norm(vt[-84:], axis=1), 1, atol=1e-12)

    def test_closed_surfaces_are_cut_open(self):
        points, faces = torus(2, 0.7, 24, 12)
        write_obj(self.path("torus.obj"), points, faces)
        for arguments in ([], ["--disk"]):
            record = self.record("flatten", self.path("torus.obj"), "-o", self.path("flat.obj"), *arguments)
            self.assertEqual(record["map"]["flipped"], 0)
            self.assertIn("it was cut open along", record["warnings"][0])
            vt, vertices = corners_of_vt(self.path("flat.obj"))
            np.testing.assert_array_equal(vertices, faces)
            # Every vertex has a place, those on the cut more than one.
            places = {(v, *np.round(p, 9)) for v, p in zip(vertices.ravel(), vt.reshape(-1, 2))}
            self.assertGreater(len(places), len(points))
        self.assertIn("several places", self.run_command("flatten", self.path("torus.obj"), "-o", self.path("flat.obj"),
                                                         "--as-positions", code=2).stderr)


@unittest.skipUnless((MESHES / "cow.off").exists(), "no scans in BELTRAMI_TEST_MESHES")
class FlattenScans(Command):
    def test_closed_scans_have_no_flips(self):
        for name in ("cow.off", "hippocampus.obj", "skull_g2.obj"):
            record = self.record("flatten", MESHES / name, "-o", self.path("flat.obj"))
            self.assertEqual(record["map"]["flipped"], 0, name)
            self.assertLess(record["map"]["mu"]["mean"], 0.09, name)


if __name__ == "__main__":
    unittest.main()
