"""beltrami map: when iterations stop, what comes after them, and where they start."""

import math
import pathlib
import unittest

import numpy as np

from support import Command, disk, read_obj, ring, write_obj


class Options(Command):
    def setUp(self):
        super().setUp()
        self.source, self.out = self.bump_file(12), self.path("out.obj")

    def map(self, *arguments, **more):
        return self.record("map", self.source, "-o", self.out, "--boundary", "disk:0.6", *arguments, **more)

    def test_tolerance_and_limit_of_the_extremal_map(self):
        plain, loose = self.map(), self.map("--tolerance", "1e-3")
        self.assertLess(loose["solve"]["iterations"], plain["solve"]["iterations"])
        self.assertAlmostEqual(loose["map"]["k"], plain["map"]["k"], delta=1e-3)
        # By itself φ settles to 1e-5, which leaves k, of second order, exact to 1e-8.
        exact = self.map("--tolerance", "1e-8")
        self.assertGreater(exact["solve"]["iterations"], plain["solve"]["iterations"])
        self.assertAlmostEqual(exact["map"]["k"], plain["map"]["k"], delta=1e-9)
        limited = self.map("--max-iterations", "2")
        self.assertEqual((limited["solve"]["termination"], limited["solve"]["iterations"]), ("iteration_limit", 2))

    def test_history(self):
        record = self.map("--evening", "never")
        history = record["solve"]["history"]
        self.assertEqual({len(values) for values in history.values()}, {record["solve"]["iterations"] + 1})
        self.assertLess(history["change"][-1], 1e-5)
        self.assertLess(abs(history["k"][-1] - history["k"][-2]), 1e-8)
        # The map of the last iteration is the one that is written; the harmonic start is more uneven.
        self.assertAlmostEqual(history["largest_mu"][-1], record["map"]["mu"]["max"], delta=1e-12)
        self.assertGreater(history["largest_mu"][0], 1.2 * history["largest_mu"][-1])
        self.assertNotIn("history", self.map("--method", "arap")["solve"])

    def test_evening(self):
        plain = self.map("--evening", "never")["map"]["mu"]
        even = self.map("--evening", "always")["map"]["mu"]
        self.assertLess(even["std"], 0.7 * plain["std"])
        self.assertEqual(self.map("--evening", "where-needed")["map"], self.map()["map"])

    def test_power_of_the_least_maximum(self):
        few, many = (self.map("--minimize", "max", "--p", p)["least_maximum"] for p in ("4", "128"))
        self.assertEqual((few["power"], many["power"]), (4, 128))
        self.assertLess(many["after"], few["after"])
        self.assertEqual(self.map("--minimize", "max")["least_maximum"], many)
        loose = self.map("--minimize", "max", "--tolerance", "1e-2")
        self.assertLess(loose["solve"]["iterations"], self.map("--minimize", "max")["solve"]["iterations"])

    def test_epsilon_of_the_alternation_and_of_other_methods(self):
        for method in ("alternation", "qc", "arap", "mips"):
            loose, tight = (self.map("--method", method, "--tolerance", t, "--max-iterations", "150")["solve"]
                            for t in ("1e-2", "1e-5"))
            self.assertLess(loose["iterations"], tight["iterations"], method)
        limited = self.map("--method", "alternation", "--max-iterations", "2")["solve"]
        self.assertEqual((limited["iterations"], limited["termination"]), (2, "iteration_limit"))

    def test_sliding_boundaries(self):
        points, faces = ring(36, 8, 0.5)
        write_obj(self.path("ring.obj"), points, faces)
        pathlib.Path(self.path("target.json")).write_text(
            '{"outer": {"circle": [0, 0, 1]}, "holes": [{"circle": [0.2, 0, 0.3]}]}')
        arguments = ("map", self.path("ring.obj"), "--onto", self.path("target.json"), "-o", self.out)
        plain, loose = self.record(*arguments), self.record(*arguments, "--tolerance", "1e-2")
        # The space of differentials has one dimension here: only the last steps of the boundary are left out.
        self.assertLessEqual(loose["solve"]["iterations"], plain["solve"]["iterations"])
        self.assertEqual(self.record(*arguments, "--max-iterations", "1")["solve"]["termination"], "iteration_limit")
        even = self.record(*arguments, "--evening", "always")["map"]
        self.assertLess(even["mu"]["std"], plain["map"]["mu"]["std"])
        self.assertAlmostEqual(even["k"], plain["map"]["k"], delta=1e-3)
        self.assertEqual(self.record(*arguments, "--evening", "where-needed")["map"], plain["map"])

    def test_impossible_values(self):
        for arguments, says in (
            (("--tolerance", "0"), "--tolerance must lie between 0 and 1"),
            (("--tolerance", "2"), "--tolerance must lie between 0 and 1"),
            (("--max-iterations", "0"), "--max-iterations"),
            (("--evening", "sometimes"), "--evening"),
            (("--p", "64"), "--p belongs to --minimize max"),
            (("--minimize", "max", "--p", "0.5"), "--p must lie between 1 and 1e6"),
            (("--minimize", "max", "--p", "nan"), "--p must lie between 1 and 1e6"),
            (("--method", "harmonic", "--tolerance", "1e-3"), "--tolerance says nothing about --method harmonic"),
            (("--method", "lscm", "--max-iterations", "3"), "--max-iterations says nothing about --method lscm"),
            (("--method", "arap", "--evening", "never"), "--evening belongs to --method extremal"),
            (("--method", "arap", "--p", "8"), "--p belongs to --minimize max"),
        ):
            text = self.run_command("map", self.source, "-o", self.out, "--boundary", "disk", *arguments, code=2).stderr
            self.assertIn(says, text)
        self.assert_nothing_left("bump.obj")


class StartMap(Command):
    def setUp(self):
        super().setUp()
        self.points, self.faces = ring(60, 24, 0.4)
        self.source, self.out, self.start = self.path("ring.obj"), self.path("out.obj"), self.path("start.obj")
        write_obj(self.source, self.points, self.faces)
        self.r = np.linalg.norm(self.points, axis=1)

    def twisted(self, turns):
        """The ring's points, turned the more the nearer to the hole."""
        z = self.points @ [1, 1j] * np.exp(2j * math.pi * turns * (1 - self.r) / 0.6)
        return np.column_stack([z.real, z.imag])

    def map(self, *arguments):
        # A vertex of each loop lies at the angle 0, or half a step from it.
        return self.record("map", self.source, "-o", self.out, "--pin", self.pins(), *arguments)

    def pins(self):
        rim = np.nonzero((self.r < 0.4 + 1e-9) | (self.r > 1 - 1e-9))[0]
        pathlib.Path(self.path("pins.txt")).write_text(
            "".join(f"{v} {self.points[v][0]!r} {self.points[v][1]!r}\n" for v in rim))
        return self.path("pins.txt")

    def test_the_class_is_that_of_the_start(self):
        write_obj(self.start, self.points, self.faces, self.twisted(1))
        plain, turned, started = self.map(), self.map("--turns", "1=1"), self.map("--start-map", self.start)
        turns = lambda record: record["homotopy"]["holes"][0]["turns"]
        self.assertEqual([abs(turns(r)) for r in (plain, turned, started)], [0, 1, 1])
        if turns(started) != turns(turned):
            turned = self.map("--turns", "1=-1")
        self.assertEqual(turns(started), turns(turned))
        self.assertAlmostEqual(started["map"]["k"], turned["map"]["k"], delta=1e-3)
        self.assertGreater(started["map"]["k"], plain["map"]["k"] + 0.3)
        self.assertEqual(started["map"]["flipped"], 0)

    def test_a_folded_start_of_the_class_will_do(self):
        rng = np.random.default_rng(2)
        inside = np.arange(60, len(self.points) - 60)
        start = self.points.copy()
        start[inside] += 0.03 * rng.standard_normal((len(inside), 2))
        write_obj(self.start, self.points, self.faces, start)
        self.assertGreater(self.record("measure", self.start)["map"]["flipped"], 10)
        record = self.map("--start-map", self.start)
        self.assertLess(record["map"]["k"], 1e-6)
        self.assertEqual(record["map"]["flipped"], 0)

    def test_mistakes(self):
        write_obj(self.start, self.points, self.faces, self.points)

        def refused(code, *arguments, says):
            text = self.run_command("map", self.source, "-o", self.out, "--pin", self.pins(), *arguments,
                                    code=code).stderr
            self.assertIn(says, text)

        refused(4, "--start-map", self.source, says="no texture coordinates")
        refused(3, "--start-map", self.path("nowhere.obj"), says="nowhere.obj")
        points, faces = disk(4)
        write_obj(self.path("disk.obj"), points, faces, points)
        refused(4, "--start-map", self.path("disk.obj"), says="another mesh than SOURCE: it has 61 vertices, SOURCE 1500")
        refused(2, "--start-map", self.start, "--turns", "1=1", says="leave one of them out")
        refused(2, "--start-map", self.start, "--method", "arap", says="--start-map belongs to --method extremal")
        text = self.run_command("map", self.source, "-o", self.start, "--pin", self.pins(), "--start-map", self.start,
                                code=2).stderr
        self.assertIn("would overwrite --start-map", text)
        self.assertFalse(pathlib.Path(self.out).exists())


if __name__ == "__main__":
    unittest.main()
