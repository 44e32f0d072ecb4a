"""Boundary conditions that mix: --onto beside --boundary, --hole and --pin, and --slide."""

import json
import math
import pathlib

import numpy as np

from support import Command, abs_mu, read_obj, ring, write_obj


def square(n):
    """Points and triangles of the unit square in n×n cells; the vertex of column i and row j is j (n+1) + i."""
    points = np.array([(i / n, j / n) for j in range(n + 1) for i in range(n + 1)])
    faces = []
    for j in range(n):
        for i in range(n):
            a, b, c, d = j * (n + 1) + i, j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i
            faces += [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
    return points, np.array(faces)


class Mixed(Command):
    def write(self, name, text):
        pathlib.Path(self.path(name)).write_text(text)
        return self.path(name)

    def test_two_sides_prescribed_two_sliding(self):
        n = 20
        write_obj(self.path("square.obj"), *square(n))
        at = lambda i, j: j * (n + 1) + i
        pins = "".join(f"{at(i, j)} {0 if i == 0 else 2} {j / n}\n" for j in range(n + 1) for i in (0, n))
        slide = f"{at(0, 0)} {at(n, 0)}\n{at(n, n)} {at(0, n)}\n"
        domain = {"outer": {"polygon": [[0, 0], [2, 0], [2, 1], [0, 1]]}}
        record = self.record("map", self.path("square.obj"), "--onto", self.write("r.json", json.dumps(domain)), "--pin",
                             self.write("pins.txt", pins), "--slide", self.write("slide.txt", slide), "-o", self.path("o.obj"))
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertAlmostEqual(record["map"]["K"], 2, delta=1e-3)
        v, vt, faces = read_obj(self.path("o.obj"))
        # The affine map is extremal, and unique: the sliding vertices stand where it puts them.
        self.assertLess(np.abs(vt - v[:, :2] * [2, 1]).max(), 1e-3)
        mu, _ = abs_mu(v, vt, faces)
        self.assertLess(mu.max(), 0.34)

    def test_outer_circle_prescribed_and_the_hole_slides(self):
        points, faces = ring(inner=0.5)
        write_obj(self.path("ring.obj"), points, faces)
        domain = {"outer": {"circle": [0, 0, 1]}, "holes": [{"circle": [0, 0, 0.25]}]}
        record = self.record("map", self.path("ring.obj"), "--onto", self.write("t.json", json.dumps(domain)),
                             "--boundary", "disk:0.3", "-o", self.path("o.obj"))
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertGreater(record["map"]["K"], 1.9)  # the modulus alone asks for 2
        _, vt, _ = read_obj(self.path("o.obj"))
        radius = np.linalg.norm(points, axis=1)
        inner, outer = radius < 0.5 + 1e-9, radius > 1 - 1e-9
        self.assertLess(np.abs(np.linalg.norm(vt[inner], axis=1) - 0.25).max(), 1e-9)
        self.assertLess(np.abs(np.linalg.norm(vt[outer], axis=1) - 1).max(), 1e-9)

    def test_an_arc_slides_on_the_circle_of_its_prescription(self):
        points, faces = ring(inner=0.5)
        write_obj(self.path("ring.obj"), points, faces)
        outer = [i for i, p in enumerate(points) if np.linalg.norm(p) > 1 - 1e-9]
        outer.sort(key=lambda i: math.atan2(points[i][1], points[i][0]))
        first, last = outer[10], outer[30]
        record = self.record("map", self.path("ring.obj"), "--boundary", "disk:0.3", "--hole", "1=disk:0,0,0.5", "--slide",
                             self.write("arc.txt", f"{first} {last}\n"), "-o", self.path("o.obj"))
        plain = self.record("map", self.path("ring.obj"), "--boundary", "disk:0.3", "--hole", "1=disk:0,0,0.5", "-o",
                            self.path("p.obj"))
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertLess(record["map"]["K"], plain["map"]["K"])  # less is prescribed
        _, vt, _ = read_obj(self.path("o.obj"))
        _, fixed, _ = read_obj(self.path("p.obj"))
        self.assertLess(np.abs(np.linalg.norm(vt[outer], axis=1) - 1).max(), 1e-9)
        self.assertLess(np.abs(vt[[first, last]] - fixed[[first, last]]).max(), 1e-9)

    def test_mistakes(self):
        points, faces = ring(inner=0.5)
        write_obj(self.path("ring.obj"), points, faces)
        inside = next(i for i, p in enumerate(points) if 0.6 < np.linalg.norm(p) < 0.8)
        done = self.run_command("map", self.path("ring.obj"), "--boundary", "disk", "--hole", "1=disk:0,0,0.5", "--slide",
                                self.write("arc.txt", f"{inside} 0\n"), "-o", self.path("o.obj"), code=5)
        self.assertIn("not on the boundary", done.stderr)
        done = self.run_command("map", self.path("ring.obj"), "--boundary", "disk", "--slide",
                                self.write("arc.txt", "0 5\n"), "-o", self.path("o.obj"), code=5)
        self.assertFalse(pathlib.Path(self.path("o.obj")).exists())


if __name__ == "__main__":
    import unittest

    unittest.main()
