"""beltrami uniformize: round disks, circle domains and their moduli."""

import math
import unittest

import numpy as np

from support import Command, disk, disk_with_holes, read_obj, ring, write_obj


def on_sphere(points):
    """By inverse stereographic projection, which is conformal."""
    n = (points**2).sum(axis=1)
    return np.column_stack([2 * points / (1 + n)[:, None], (n - 1) / (1 + n)])


class Uniformize(Command):
    def test_a_disk_goes_to_the_round_disk(self):
        record = self.record("uniformize", self.bump_file(14), "-o", self.path("out.obj"))
        self.assertEqual(record["uniformization"]["moduli"], [])
        self.assertEqual(record["uniformization"]["circles"], [])
        self.assertNotIn("module", record["uniformization"])
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertLess(record["map"]["mu"]["mean"], 0.05)
        _, vt, _ = read_obj(self.path("out.obj"))
        np.testing.assert_allclose(np.linalg.norm(vt[-84:], axis=1), 1, atol=1e-12)

    def test_the_module_of_a_ring(self):
        points, faces = ring(96, 24, 0.4)
        write_obj(self.path("ring.obj"), on_sphere(points), faces)
        arguments = ("uniformize", self.path("ring.obj"), "-o", self.path("out.obj"))
        record = self.record(*arguments)["uniformization"]
        exact = math.log(1 / 0.4) / (2 * math.pi)
        self.assertAlmostEqual(record["module"], exact, delta=3e-4)
        self.assertAlmostEqual(record["module"], -math.log(record["moduli"][0]) / (2 * math.pi), delta=1e-12)
        self.assertEqual(record["circles"][0]["centre"], [0, 0])
        self.assertIn("conformal module log(1/r)/2pi = 0.145", self.run_command(*arguments).stdout)
        # The ring itself is exact, and its map is what is written.
        write_obj(self.path("flat.obj"), 3 * points + [5, -1], faces)
        record = self.record("uniformize", self.path("flat.obj"), "-o", self.path("out.obj"))
        self.assertAlmostEqual(record["uniformization"]["module"], exact, delta=1e-12)
        _, vt, _ = read_obj(self.path("out.obj"))
        np.testing.assert_allclose(np.linalg.norm(vt, axis=1), np.linalg.norm(points, axis=1), atol=1e-12)
        self.assertLess(record["map"]["mu"]["max"], 1e-10)

    def test_moduli_of_holes_are_those_of_the_circles_written(self):
        points, faces = disk_with_holes(40, [((-0.45, 0.1), 0.2), ((0.35, 0.3), 0.15), ((0.2, -0.45), 0.25)])
        write_obj(self.path("holes.obj"), on_sphere(points), faces)
        arguments = ("uniformize", self.path("holes.obj"), "-o", self.path("out.obj"))
        record = self.record(*arguments)
        found = record["uniformization"]
        self.assertEqual(len(found["moduli"]), 6)
        circles = found["circles"]
        self.assertEqual([c["loop"] for c in circles], [1, 2, 3])
        self.assertEqual(circles[0]["centre"], [0, 0])
        self.assertEqual(circles[1]["centre"][1], 0)
        expected = [circles[0]["radius"], circles[1]["centre"][0], circles[1]["radius"], *circles[2]["centre"],
                    circles[2]["radius"]]
        self.assertEqual(found["moduli"], expected)
        _, vt, _ = read_obj(self.path("out.obj"))
        for circle, loop in zip(circles, record["source"]["loops"][1:]):
            self.assertAlmostEqual(np.linalg.norm(vt[loop["first_vertex"]] - circle["centre"]), circle["radius"],
                                   delta=1e-12)
        self.assertIn("moduli: ", self.run_command(*arguments, "--report", self.path("page.html")).stdout)
        # Another hole at the centre, another loop outside.
        other = self.record(*arguments, "--centre", "2", "--outer", "1")["uniformization"]
        self.assertEqual(other["outer_loop"], 1)
        self.assertEqual([c["loop"] for c in other["circles"]], [2, 0, 3])

    def test_a_torus_with_a_hole_has_a_hyperbolic_metric(self):
        n, m = 12, 8
        at = lambda i, j: (i % n) * m + j % m
        torus = np.array([((2 + math.cos(2 * math.pi * j / m)) * math.cos(2 * math.pi * i / n),
                           (2 + math.cos(2 * math.pi * j / m)) * math.sin(2 * math.pi * i / n),
                           math.sin(2 * math.pi * j / m)) for i in range(n) for j in range(m)])
        faces = [t for i in range(n) for j in range(m)
                 for t in ((at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1)))]
        write_obj(self.path("torus.obj"), torus, np.array(faces[1:]))
        found = self.record("uniformize", self.path("torus.obj"), "-o", self.path("out.obj"))["hyperbolic"]
        self.assertAlmostEqual(found["area"], 2 * math.pi, delta=1e-8)
        self.assertEqual((len(found["generators"]), len(found["boundary"])), (2, 1))
        text = self.run_command("uniformize", self.path("torus.obj"), "-o", self.path("other.obj"), "--outer", "0",
                                code=2).stderr
        self.assertIn("genus 1", text)

    def test_loops_that_are_not_there(self):
        points, faces = ring(24, 4, 0.4)
        write_obj(self.path("ring.obj"), points, faces)
        for arguments in (("--outer", "2"), ("--centre", "2"), ("--centre", "0"), ("--outer", "1", "--centre", "1")):
            text = self.run_command("uniformize", self.path("ring.obj"), "-o", self.path("out.obj"), *arguments,
                                    code=2).stderr
            self.assertIn(arguments[-2], text)
        self.assert_nothing_left("ring.obj")


if __name__ == "__main__":
    unittest.main()
