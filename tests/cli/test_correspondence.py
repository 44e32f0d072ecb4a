"""beltrami map --onto MESH --correspondence FILE: onto a surface, the boundary prescribed."""

import math
import pathlib
import unittest

import numpy as np

from support import Command, disk, read_obj, ring, write_obj


def on_sphere(points):
    """By inverse stereographic projection, which is conformal."""
    n = (points**2).sum(axis=1)
    return np.column_stack([2 * points / (1 + n)[:, None], (n - 1) / (1 + n)])


class Correspondence(Command):
    """The Teichmüller map z|z|^(a-1) e^{ic log|z|} of a ring, then onto the sphere."""

    def setUp(self):
        super().setUp()
        self.points, self.faces = ring(96, 28, 0.5)
        self.source, self.target, self.out = (self.path(n) for n in ("ring.obj", "sphere.obj", "out.obj"))
        write_obj(self.source, self.points, self.faces)
        self.a, c = 1.5, 0.6
        r = np.linalg.norm(self.points, axis=1)
        image = self.points @ [1, 1j] * r ** (self.a - 1) * np.exp(1j * c * np.log(r))
        self.image = on_sphere(np.column_stack([image.real, image.imag]))
        write_obj(self.target, self.image, self.faces)
        w = self.a + 1j * c
        self.k = abs(w - 1) / abs(w + 1)
        self.rims = [np.arange(96), np.arange(len(self.points) - 96, len(self.points))]

    def pairs(self, rows):
        path = self.path("pairs.txt")
        pathlib.Path(path).write_text("# source_vertex target_vertex\n" + "".join(f"{a} {b}\n" for a, b in rows))
        return path

    def map(self, pairs, *arguments, **more):
        return self.record("map", self.source, "--onto", self.target, "--correspondence", pairs, "-o", self.out,
                           *arguments, **more)

    def test_the_known_map(self):
        record = self.map(self.pairs((v, v) for rim in self.rims for v in rim), "--places", self.path("places.txt"),
                          "--report", self.path("page.html"))
        self.assertAlmostEqual(record["map"]["k"], self.k, delta=1e-3)
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertFalse(any(bound["rigorous"] for bound in record["map"]["bounds"]))
        self.assertEqual(record["correspondence"], {"target": self.target, "pairs": 192, "loops": [[0, 0], [1, 1]]})
        self.assertNotIn("onto", record)
        v, vt, _ = read_obj(self.out)
        self.assertLess(np.linalg.norm(v - self.image, axis=1).max(), 3e-3)
        for rim in self.rims:
            np.testing.assert_allclose(v[rim], self.image[rim], atol=1e-12)
        rows = np.loadtxt(self.path("places.txt"))
        found = (self.image[rows[:, 2:5].astype(int)] * rows[:, 5:8, None]).sum(axis=1)
        np.testing.assert_allclose(found, v, atol=1e-12)

    def test_one_pair_a_loop_is_enough_where_both_run_evenly(self):
        self.map(self.pairs((v, v) for rim in self.rims for v in rim))
        every = read_obj(self.out)[0]
        record = self.map(self.pairs((rim[5], rim[5]) for rim in self.rims))
        self.assertEqual(record["correspondence"]["pairs"], 2)
        np.testing.assert_allclose(read_obj(self.out)[0], every, atol=1e-9)

    def test_turns_and_other_methods(self):
        pairs = self.pairs((v, v) for rim in self.rims for v in rim)
        turned = self.map(pairs, "--turns", "1=1", "--compare", "harmonic,arap")
        self.assertEqual(turned["homotopy"]["holes"][0]["turns"], 1)
        self.assertEqual([line["method"] for line in turned["comparison"]], ["harmonic", "arap"])
        self.assertGreater(turned["map"]["k"], self.k + 0.2)

    def test_mistakes(self):
        good = self.pairs((rim[0], rim[0]) for rim in self.rims)

        def refused(code, *arguments, says):
            text = self.run_command("map", self.source, "-o", self.out, *arguments, code=code).stderr
            self.assertIn(says, text)

        onto = ("--onto", self.target, "--correspondence")
        refused(2, "--boundary", "disk", "--correspondence", good, says="--correspondence belongs to --onto")
        refused(2, *onto, good, "--boundary", "disk", says="where --correspondence prescribes the boundary")
        refused(2, *onto, good, "--loops", "0:0", says="--loops or --match")
        refused(2, *onto, good, "--certify", "1", says="--certify")
        refused(2, *onto, good, "--p", "8", says="--p")
        refused(3, *onto, self.path("none.txt"), says="none.txt")
        one = self.path("one.txt")
        pathlib.Path(one).write_text(f"{self.rims[1][0]} {self.rims[1][0]}\n")
        refused(5, *onto, one, says="no pair says where boundary loop 1 goes")
        pathlib.Path(one).write_text("200 0\n")
        refused(5, *onto, one, says="vertex 200 of a pair is not on the boundary of the source")
        pathlib.Path(self.path("domain.json")).write_text('{"outer": {"circle": [0, 0, 1]}}')
        refused(2, "--onto", self.path("domain.json"), "--correspondence", good, says="TARGET is a domain")
        points, faces = disk(5)
        write_obj(self.path("disk.obj"), points, faces)
        refused(5, "--onto", self.path("disk.obj"), "--correspondence", good, says="2 boundary loops, the target 1")
        self.assertFalse(pathlib.Path(self.out).exists())


if __name__ == "__main__":
    unittest.main()
