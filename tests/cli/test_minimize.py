"""beltrami map --minimize max."""

import unittest

import numpy as np

from support import Command, abs_mu, disk, read_obj, ring, write_obj


class LeastMaximum(Command):
    def test_the_largest_stretch_falls(self):
        source = self.bump_file(10)
        arguments = ["map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.6"]
        extremal = self.record(*arguments)
        self.assertNotIn("least_maximum", extremal)
        record = self.record(*arguments, "--minimize", "max", "--report", self.path("out.html"), "--compare", "harmonic")
        least = record["least_maximum"]
        self.assertEqual(least["before"], extremal["map"]["mu"]["max"])
        self.assertEqual(least["after"], record["map"]["mu"]["max"])
        self.assertLess(least["after"], least["before"])
        v, vt, f = read_obj(self.path("out.obj"))
        self.assertAlmostEqual(abs_mu(v, vt, f)[0].max(), least["after"], delta=1e-12)
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertNotIn("K", record["map"])
        self.assertEqual(record["map"]["K_lower"], extremal["map"]["K_lower"])
        self.assertLessEqual(record["map"]["K_lower"], record["map"]["K_max"])
        attained = [b["K"] for b in record["map"]["bounds"] if b["kind"] == "attained"]
        self.assertEqual(attained, [record["map"]["K_max"]])
        text = self.run_command(*arguments, "--minimize", "max").stdout
        self.assertIn("largest |mu| of a face: ", text)
        self.assertIn("least maximum", text)

    def test_parts_of_the_boundary_may_be_free(self):
        points, faces = disk(12)
        write_obj(self.path("disk.obj"), points, faces)
        rim = range(len(points) - 72, len(points))
        half = [v for v in rim if abs(points[v, 1]) > 0.5]
        (self.folder / "pins.txt").write_text("".join(f"{v} {float(points[v, 0])!r} {float(1.4 * points[v, 1])!r}\n" for v in half))
        arguments = ["map", self.path("disk.obj"), "-o", self.path("out.obj"), "--pin", self.path("pins.txt")]
        record = self.record(*arguments)
        warned = [w for w in record["warnings"] if "boundary vertices are free" in w]
        self.assertEqual(len(warned), 1)
        self.assertTrue(warned[0].startswith(f"{len(rim) - len(half)} "))
        self.assertIn("there is nothing to certify", self.run_command(*arguments, "--certify", 1, code=5).stderr)
        asked = self.record(*arguments, "--minimize", "max")
        self.assertEqual(asked["map"], record["map"])
        self.assertEqual(asked["warnings"], [])
        vt = read_obj(self.path("out.obj"))[1]
        np.testing.assert_allclose(vt[half], points[half] * [1, 1.4], atol=1e-12)
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertLessEqual(record["map"]["mu"]["max"], 0.4 / 2.4 + 1e-6)  # (x, 1.4 y) obeys the same pins
        self.assertNotIn("corners", record)

    def test_a_hole_may_be_free(self):
        points, faces = ring(36, 8)
        write_obj(self.path("ring.obj"), points, faces)
        arguments = ["map", self.path("ring.obj"), "-o", self.path("out.obj"), "--boundary", "disk"]
        self.assertIn("--minimize max", self.run_command(*arguments, code=5).stderr)
        record = self.record(*arguments, "--minimize", "max")
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertLess(record["map"]["mu"]["max"], 1e-3)
        z = read_obj(self.path("out.obj"))[1] @ [1, 1j]
        turn = z[-1] / (points[-1] @ [1, 1j])
        np.testing.assert_allclose(z, turn * (points @ [1, 1j]), atol=1e-3)

    def test_threads_give_the_same_bytes(self):
        source = self.bump_file(8)
        texts = set()
        for threads in (1, 3):
            self.run_command("map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.5", "--minimize", "max", "--threads", threads)
            texts.add((self.folder / "out.obj").read_bytes())
        self.assertEqual(len(texts), 1)

    def test_bad_values(self):
        source = self.bump_file(4)
        out = ["map", source, "-o", self.path("o.obj"), "--boundary", "disk"]
        self.run_command(*out, "--minimize", "mean", code=2)
        self.assertIn("extremal", self.run_command(*out, "--minimize", "max", "--method", "arap", code=2).stderr)
        self.assertFalse((self.folder / "o.obj").exists())


if __name__ == "__main__":
    unittest.main()
