"""beltrami map --certify."""

import unittest

from support import Command, disk, read_obj, ring, write_obj


class Certify(Command):
    def test_a_gap_that_can_be_had(self):
        source = self.bump_file(10)
        arguments = ["map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.6"]
        plain = self.record(*arguments)
        self.assertNotIn("certificate", plain)
        record = self.record(*arguments, "--certify", 0.05, "--report", self.path("out.html"))
        certificate, m = record["certificate"], record["map"]
        self.assertTrue(certificate["reached"], certificate)
        self.assertEqual(certificate["wanted"], 0.0005)
        self.assertLessEqual(certificate["gap"], 0.0005)
        self.assertAlmostEqual(certificate["gap"], m["K"] / m["K_lower"] - 1, delta=1e-12)
        self.assertGreater(m["K_lower"], plain["map"]["K_lower"])
        self.assertGreater(plain["map"]["K"] / plain["map"]["K_lower"] - 1, 2 * certificate["gap"])
        self.assertEqual(m["mu"]["max"], plain["map"]["mu"]["max"])  # the map is that of SOURCE's mesh
        self.assertEqual(len(read_obj(self.path("out.obj"))[1]), len(read_obj(source)[0]))
        text = self.run_command(*arguments, "--certify", 0.05).stdout
        self.assertIn("certificate of 0.05 %: reached; the gap is ", text)

    def test_refinements_are_counted(self):
        record = self.record("map", self.bump_file(4), "-o", self.path("out.obj"), "--boundary", "disk:0.9", "--certify", 0.1)
        self.assertGreaterEqual(record["certificate"]["refinements"], 1)
        self.assertEqual(record["source"]["faces"], 6 * 16)

    def test_a_gap_that_cannot_be_had_is_no_error(self):
        # A circle to a square by arc length: the corners alone force K = 2, which no differential attains.
        points, faces = disk(16)
        write_obj(self.path("disk.obj"), points, faces)
        record = self.record("map", self.path("disk.obj"), "-o", self.path("out.obj"), "--boundary", "rectangle:1,1", "--certify", 0.01)
        self.assertFalse(record["certificate"]["reached"])
        self.assertTrue(record["certificate"]["reason"])
        self.assertTrue((self.folder / "out.obj").exists())

    def test_with_holes_turns_and_ways(self):
        points, faces = ring(36, 12)
        write_obj(self.path("ring.obj"), points, faces)
        identity = ["map", self.path("ring.obj"), "-o", self.path("out.obj"), "--boundary", "disk", "--hole", "1=disk:0,0,0.3,0.5", "--certify", 5]
        self.assertTrue(self.record(*identity, "--turns", "1=0")["certificate"]["reached"])
        (self.folder / "way.txt").write_text("")
        self.assertTrue(self.record(*identity, "--waypoints", self.path("way.txt"))["certificate"]["reached"])

    def test_bad_values(self):
        out = ["map", self.bump_file(4), "-o", self.path("o.obj"), "--boundary", "disk"]
        for percent in ("0", "-1", "x"):
            self.run_command(*out, "--certify", percent, code=2)
        self.run_command(*out, "--certify", "1", "--method", "mips", code=2)
        self.run_command(*out, "--certify", "1", "--minimize", "max", code=2)
        self.run_command(*out, "--certify", "nan", code=2)
        self.assertFalse((self.folder / "o.obj").exists())


if __name__ == "__main__":
    unittest.main()
