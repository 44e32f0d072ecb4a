"""beltrami map --certify."""

import os
import pathlib
import unittest

from support import Command, disk, read_obj, ring, write_obj


class Certify(Command):
    def test_a_gap_that_can_be_had(self):
        source = self.bump_file(10)
        arguments = ["map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.6"]
        plain = self.record(*arguments)
        self.assertNotIn("certificate", plain)
        record = self.record(*arguments, "--certify", 2, "--report", self.path("out.html"))
        certificate, m = record["certificate"], record["map"]
        self.assertTrue(certificate["proved"], certificate)
        self.assertEqual(certificate["wanted"], 0.02)
        self.assertLessEqual(certificate["gap"], 0.02)
        self.assertAlmostEqual(certificate["gap"], certificate["K_upper"] / certificate["K_lower_proved"] - 1, delta=1e-12)
        self.assertEqual(certificate["K_upper"], m["K_upper"])
        self.assertEqual(certificate["K_lower_proved"], m["K_lower_proved"])
        self.assertLessEqual(m["K_lower_proved"], m["K_lower"])
        self.assertLessEqual(m["K_lower"], m["K"])
        self.assertLessEqual(m["K"], m["K_upper"])
        self.assertEqual(m["mu"]["max"], plain["map"]["mu"]["max"])  # the map is that of SOURCE's mesh
        self.assertEqual(len(read_obj(self.path("out.obj"))[1]), len(read_obj(source)[0]))
        text = self.run_command(*arguments, "--certify", 2).stdout
        self.assertIn("certificate of 2 %: proved: K* in [", text)
        self.assertIn("(floating point)", text)

    def test_a_gap_that_is_not_proved(self):
        record = self.record("map", self.bump_file(4), "-o", self.path("out.obj"), "--boundary", "disk:0.9", "--certify", 1e-4)
        certificate = record["certificate"]
        self.assertFalse(certificate["proved"])
        self.assertTrue(certificate["reason"].startswith("not proved: known is K* in ["), certificate)
        self.assertIn("the estimate is K = ", certificate["reason"])
        self.assertGreaterEqual(certificate["refinements"], 1)
        self.assertEqual(record["source"]["faces"], 6 * 16)

    def test_a_gap_that_cannot_be_had_is_no_error(self):
        # A circle to a square by arc length: the corners alone force K = 2, which no differential attains.
        points, faces = disk(16)
        write_obj(self.path("disk.obj"), points, faces)
        record = self.record("map", self.path("disk.obj"), "-o", self.path("out.obj"), "--boundary", "rectangle:1,1", "--certify", 0.001)
        self.assertFalse(record["certificate"]["proved"])
        self.assertTrue(record["certificate"]["reason"])
        self.assertTrue((self.folder / "out.obj").exists())

    def test_with_holes_turns_and_ways(self):
        points, faces = ring(36, 12)
        write_obj(self.path("ring.obj"), points, faces)
        identity = ["map", self.path("ring.obj"), "-o", self.path("out.obj"), "--boundary", "disk", "--hole", "1=disk:0,0,0.3,0.5", "--certify", 20]
        self.assertTrue(self.record(*identity, "--turns", "1=0")["certificate"]["proved"])
        (self.folder / "way.txt").write_text("")
        self.assertTrue(self.record(*identity, "--waypoints", self.path("way.txt"))["certificate"]["proved"])

    def test_bad_values(self):
        out = ["map", self.bump_file(4), "-o", self.path("o.obj"), "--boundary", "disk"]
        for percent in ("0", "-1", "x"):
            self.run_command(*out, "--certify", percent, code=2)
        self.run_command(*out, "--certify", "1", "--method", "mips", code=2)
        self.run_command(*out, "--certify", "1", "--minimize", "max", code=2)
        self.run_command(*out, "--certify", "nan", code=2)
        self.assertFalse((self.folder / "o.obj").exists())

    def test_measured_maps(self):
        source = self.bump_file(8)
        self.record("map", source, "-o", self.path("mapped.obj"), "--boundary", "disk:0.6")
        plain = self.record("measure", self.path("mapped.obj"))
        self.assertNotIn("K_lower", plain["map"])
        m = self.record("measure", self.path("mapped.obj"), "--certify")["map"]
        self.assertEqual(m["K_lower"], m["K_lower_proved"])
        self.assertGreater(m["K_lower"], 1.05)
        self.assertLess(m["K_lower"], m["K_max"])
        self.assertIn("attained", [bound["kind"] for bound in m["bounds"]])
        text = self.run_command("measure", self.path("mapped.obj"), "--certify").stdout
        self.assertIn("no map with these boundary values stretches less than K = ", text)
        self.assertIn("(proved up to rounding)", text)
        # A ring is no disk.
        points, faces = ring(36, 12)
        write_obj(self.path("ring.obj"), points, faces)
        self.run_command("measure", self.path("ring.obj"), self.path("ring.obj"), "--certify", code=4)

    CASES = pathlib.Path(os.environ.get("BELTRAMI_TEST_MESHES", "")).parent / "cases"

    def case(self, name, *arguments):
        """The map record of one of the small meshes that were wrong once."""
        if not (self.CASES / name).exists():
            self.skipTest("the folder of cases is absent")
        return self.record("map", str(self.CASES / name), "-o", self.path("case.obj"), *arguments)

    def test_two_triangles(self):
        record = self.case("two.obj", "--boundary", "rectangle:1,1", "--certify", 1)
        c = record["certificate"]
        self.assertTrue(c["proved"], c)
        self.assertGreaterEqual(c["K_upper"], 1.1483)
        self.assertLessEqual(c["K_lower_proved"], 1.1524)
        self.assertGreaterEqual(record["map"]["K"], 1.1470)
        self.assertEqual(record["solve"]["termination"], "below_bound")

    def test_bump8(self):
        record = self.case("bump8.obj", "--boundary", "rectangle:1,1", "--corners", "0,8,80,72", "--certify", 1)
        c = record["certificate"]
        self.assertTrue(c["proved"], c)
        self.assertGreaterEqual(c["K_lower_proved"], 1.0592)
        self.assertLessEqual(c["K_upper"], 1.0710)
        self.assertGreaterEqual(record["map"]["K"], 1.0592)

    def test_cert1(self):
        record = self.case("cert1.obj", "--pin", str(self.CASES / "cert1.pin"), "--certify", 1.2)
        c = record["certificate"]
        self.assertTrue(c["proved"], c)
        self.assertGreaterEqual(c["K_upper"], 1.5752)  # which is proved of K* on finer meshes
        self.assertGreaterEqual(c["K_lower_proved"], 1.566)

    def test_one_triangle_is_affine(self):
        record = self.case("one.obj", "--boundary", "disk", "--certify", 0.1)
        self.assertTrue(record["certificate"]["proved"], record["certificate"])
        self.assertAlmostEqual(record["map"]["K"], 1.3137, delta=1e-4)

    def test_a_long_rectangle(self):
        record = self.case("jb.obj", "--boundary", "rectangle:100,1", "--corners", "0,16,288,272")
        m = record["map"]
        self.assertGreaterEqual(m["K_lower_proved"], 98.402)
        self.assertLessEqual(m["K_lower_proved"], 98.6)
        self.assertGreaterEqual(m["K"], m["K_lower_proved"])

    def test_camel(self):
        meshes = pathlib.Path(os.environ.get("BELTRAMI_TEST_MESHES", ""))
        if not (meshes / "camel_b.obj").exists():
            self.skipTest("the folder of real meshes is absent")
        m = self.record("map", str(meshes / "camel_b.obj"), "-o", self.path("case.obj"), "--boundary", "disk:0.5")["map"]
        self.assertGreaterEqual(m["K_lower_proved"], 5.2)
        self.assertGreaterEqual(m["K"], m["K_lower_proved"])


if __name__ == "__main__":
    unittest.main()
