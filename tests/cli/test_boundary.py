"""beltrami map: where loops and pins go, with holes too."""

import unittest

import numpy as np

from support import Command, disk, disk_with_holes, read_obj, ring, write_obj


class Holes(Command):
    def setUp(self):
        super().setUp()
        self.points, faces = ring()
        self.around = 48
        self.source = self.path("ring.obj")
        write_obj(self.source, self.points, faces)

    def image(self, *arguments):
        self.run_command("map", self.source, "-o", self.path("out.obj"), *arguments)
        return read_obj(self.path("out.obj"))[1]

    def test_a_hole_runs_clockwise_around_its_circle(self):
        vt = self.image("--method", "harmonic", "--boundary", "disk", "--hole", "1=disk:0.1,-0.2,0.4,0.7")
        # The source's hole has even edges from angle 0 on; faces on the left it runs clockwise.
        angle = 0.7 + 2 * np.pi * np.arange(self.around) / self.around
        np.testing.assert_allclose(vt[: self.around], np.column_stack([0.1 + 0.4 * np.cos(angle), -0.2 + 0.4 * np.sin(angle)]), atol=1e-9)
        start = self.image("--method", "harmonic", "--boundary", "disk", "--hole", "1=disk:0,0,0.3")
        np.testing.assert_allclose(start, self.points, atol=2e-3)

    def test_the_boundary_belongs_to_the_outer_loop(self):
        # Inside out: r/z takes the hole to the unit circle and the outer circle to the hole.
        vt = self.image("--boundary", "disk", "--outer", 1, "--hole", "0=disk:0,0,0.3")
        z = self.points @ [1, 1j]
        np.testing.assert_allclose(vt @ [1, 1j], 0.3 / z, atol=2e-3)
        for speed in ("arclength", "conformal"):
            vt = self.image("--boundary", "rectangle:2,1", "--outer", 1, "--hole", "0=disk:1,0.5,0.2", "--speed", speed)
            inner = vt[: self.around]
            for corner in ((0, 0), (2, 0), (2, 1), (0, 1)):
                self.assertLess(np.abs(inner - corner).sum(axis=1).min(), 1e-12)

    def test_conformal_speed_of_a_domain_with_holes(self):
        points, faces = disk_with_holes(14, [((0.3, 0.1), 0.25)])
        write_obj(self.path("one.obj"), points, faces)
        self.run_command("map", self.path("one.obj"), "-o", self.path("out.obj"), "--method", "mips", "--boundary", "disk", "--speed", "conformal")
        vt = read_obj(self.path("out.obj"))[1]
        rim = np.linalg.norm(points, axis=1) > 1 - 1e-9
        angles = np.unwrap(np.angle(vt[rim] @ [1, 1j]))
        self.assertTrue((np.diff(angles) > 0).all())
        np.testing.assert_allclose(np.linalg.norm(vt[rim], axis=1), 1, atol=1e-12)

    def test_bad_holes(self):
        out = ["-o", self.path("o.obj"), "--boundary", "disk"]
        for hole in ("1=disk:0,0", "1=disk:0,0,x", "1=circle:0,0,1", "disk:0,0,0.2", "-1=disk:0,0,0.2", "1.5=disk:0,0,0.2", "1=disk:0,0,0.2,1,2",
                     "1=disk:0,0,-0.2", "1=disk:0,0,0", "7=disk:0,0,0.2", "0=disk:0,0,0.2", "1=disk:nan,0,0.2", "1=disk:inf,0,0.2"):
            with self.subTest(hole):
                failed = self.run_command("map", self.source, *out, "--hole", hole, code=2)
                self.assertIn("beltrami: ", failed.stderr)
        twice = self.run_command("map", self.source, *out, "--hole", "1=disk:0,0,0.2", "--hole", "1=disk:0,0,0.3", code=2)
        self.assertIn("twice for loop 1", twice.stderr)
        self.run_command("map", self.source, *out, "--outer", 2, code=2)
        self.run_command("map", self.source, *out, "--outer", -1, code=2)
        # Outside the outer loop's image, or prescribed by pins too.
        self.run_command("map", self.source, *out, "--hole", "1=disk:2,0,0.3", code=5)
        (self.folder / "pins.txt").write_text("0 0.3 0\n")
        self.run_command("map", self.source, *out, "--hole", "1=disk:0,0,0.3", "--pin", self.path("pins.txt"), code=5)
        self.assertFalse((self.folder / "o.obj").exists())


class Stars(Command):
    def setUp(self):
        super().setUp()
        self.points, faces = disk(10)
        write_obj(self.path("disk.obj"), self.points, faces)

    def pins(self, text):
        (self.folder / "pins.txt").write_text(text)
        return ["map", self.path("disk.obj"), "-o", self.path("out.obj"), "--boundary", "disk", "--pin", self.path("pins.txt")]

    def test_a_coordinate_that_is_free(self):
        column = np.flatnonzero((np.abs(self.points[:, 0]) < 1e-9) & (np.abs(self.points[:, 1]) < 0.75))
        self.assertGreater(len(column), 4)
        record = self.record(*self.pins("".join(f"{v} 0.1 *\n" for v in column)))
        vt = read_obj(self.path("out.obj"))[1]
        np.testing.assert_allclose(vt[column, 0], 0.1, atol=1e-12)
        self.assertTrue((np.diff(vt[column[np.argsort(self.points[column, 1])], 1]) > 0).all())
        self.assertEqual(record["map"]["flipped"], 0)
        self.record(*self.pins("".join(f"{v} * 0.1\n" for v in [1])))
        vt = read_obj(self.path("out.obj"))[1]
        self.assertAlmostEqual(vt[1, 1], 0.1, delta=1e-12)

    def test_free_coordinates_that_cannot_be(self):
        self.assertIn("both coordinates of vertex 1", self.run_command(*self.pins("1 * *\n"), code=5).stderr)
        last = len(self.points) - 1
        alone = [a for a in self.pins(f"{last} 1 *\n") if a not in ("--boundary", "disk")]
        self.assertIn("boundary", self.run_command(*alone, code=5).stderr)
        self.run_command(*self.pins("1 0.1 *\n1 0.1 *\n"), code=5)
        self.assertIn("pins.txt:1", self.run_command(*self.pins("* 0.1 1\n"), code=3).stderr)
        self.assertIn("pins.txt:2", self.run_command(*self.pins("1 0.1 *\n2 0.2 **\n"), code=3).stderr)

    def test_other_methods_do_not_slide(self):
        arguments = self.pins("1 0.1 *\n")
        for method in ("harmonic", "lscm", "arap", "mips", "alternation", "qc"):
            self.assertIn("vertex 1 may slide", self.run_command(*arguments, "--method", method, code=5).stderr)
        record = self.record(*arguments, "--compare", "harmonic,lscm")
        self.assertEqual([other["method"] for other in record["comparison"]], ["lscm"])
        self.assertTrue(any(w.startswith("harmonic is not in the comparison: vertex 1") for w in record["warnings"]), record["warnings"])


if __name__ == "__main__":
    unittest.main()
