"""beltrami deform: a surface in space deformed by handles."""

import pathlib
import unittest

import numpy as np

from support import Command, bump, read_obj, write_obj
from test_tori import torus


class Deform(Command):
    def setUp(self):
        super().setUp()
        points, faces = torus(2, 1, 32, 16)
        keep = np.linalg.norm(points[faces].mean(1) - [-3, 0, 0], axis=1) > 0.85
        used = np.unique(faces[keep])
        self.points, self.faces = points[used], np.searchsorted(used, faces[keep])
        write_obj(self.path("a.obj"), self.points, self.faces)
        edges = np.concatenate([self.faces[:, [0, 1]], self.faces[:, [1, 2]], self.faces[:, [2, 0]]])
        keys, count = np.unique(np.sort(edges, 1), axis=0, return_counts=True)
        self.loop = np.unique(keys[count == 1])

    def pins(self, angle, shift):
        p = self.points[self.loop]
        c, s = np.cos(angle), np.sin(angle)
        p = np.column_stack([p[:, 0] - shift, c * p[:, 1] - s * p[:, 2], s * p[:, 1] + c * p[:, 2]])
        pathlib.Path(self.path("pins.txt")).write_text(
            "".join(f"{v} {x!r} {y!r} {z!r}\n" for v, (x, y, z) in zip(self.loop.tolist(), p.tolist())))
        return p

    def deform(self, *arguments):
        return self.record("deform", self.path("a.obj"), "--pin", self.path("pins.txt"), "-o", self.path("out.obj"), *arguments)

    def test_a_loop_is_turned(self):
        places = self.pins(1.0, 0.5)
        record = self.deform()
        out, _, faces = read_obj(self.path("out.obj"))
        np.testing.assert_array_equal(faces, self.faces)
        np.testing.assert_allclose(out[self.loop], places, atol=1e-9)
        self.assertEqual(record["deform"]["surface"], "thin-plate")
        self.assertEqual(record["deform"]["handles"], len(self.loop))
        self.assertEqual(record["deform"]["folds"], [])
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertLess(record["map"]["mu"]["max"], 0.7 * record["deform"]["surface_mu"]["max"])
        rigid = self.deform("--surface", "rigid")
        self.assertLess(rigid["map"]["mu"]["mean"], record["map"]["mu"]["mean"])
        # Onto the surface that has been found: the same one again.
        write_obj(self.path("onto.obj"), out, faces)
        onto = self.deform("--onto", self.path("onto.obj"))
        self.assertEqual(onto["deform"]["surface"], "given")
        self.assertEqual(onto["map"]["flipped"], 0)

    def test_what_is_made_small(self):
        points, faces = bump(10)
        write_obj(self.path("a.obj"), points, faces)
        border = range(len(points) - 60, len(points))
        # The rim becomes an ellipse with a wave, in its plane and in space.
        angle = np.arctan2(points[:, 1], points[:, 0])
        for height, onto in ((0, ("--onto", "plane")), (0.3, ())):
            wave = 1 + 0.15 * np.cos(3 * angle)
            image = np.column_stack([1.5 * wave * np.cos(angle), wave * np.sin(angle), height * np.sin(2 * angle)])
            pathlib.Path(self.path("pins.txt")).write_text(
                "".join(f"{v} {x!r} {y!r} {z!r}\n" for v, (x, y, z) in ((v, image[v].tolist()) for v in border)))
            found = {goal: self.deform("--minimize", goal, *onto) for goal in ("K", "max", "spread")}
            for goal, record in found.items():
                self.assertEqual(record["deform"]["minimized"], goal)
                self.assertEqual(record["map"]["flipped"], 0)
            k = found["K"]["map"]
            self.assertLessEqual(k["K_lower"], k["K"] * (1 + 1e-6))
            self.assertAlmostEqual(k["k"], k["mu"]["mean"], delta=0.1 * k["k"])
            self.assertLessEqual(found["max"]["map"]["mu"]["max"], k["mu"]["max"] * (1 + 1e-9))
            self.assertLessEqual(found["spread"]["map"]["mu"]["std"], found["max"]["map"]["mu"]["std"] * (1 + 1e-9))
            out, _, _ = read_obj(self.path("out.obj"))
            np.testing.assert_allclose(out[border], image[border], atol=1e-9)
            if onto:
                self.assertEqual(np.abs(out[:, 2]).max(), 0)
        self.assertIn("--surface", self.run_command(
            "deform", self.path("a.obj"), "--pin", self.path("pins.txt"), "-o", self.path("b.obj"), "--onto", "plane",
            "--surface", "rigid", code=2).stderr)

    def test_handles_of_a_torus_have_no_extremal_map(self):
        self.pins(0.5, 0.2)
        record = self.deform("--minimize", "K")
        self.assertEqual(record["deform"]["minimized"], "max")
        self.assertTrue(any("genus 1" in warning for warning in record["warnings"]))

    def test_what_the_data_alone_turn_over_is_told(self):
        n = 10
        grid = np.array([(i / n, j / n, 0) for i in range(n + 1) for j in range(n + 1)])
        faces = [[i * (n + 1) + j, (i + 1) * (n + 1) + j, (i + 1) * (n + 1) + j + 1, i * (n + 1) + j + 1] for i in range(n) for j in range(n)]
        pathlib.Path(self.path("a.obj")).write_text(
            "".join(f"v {x} {y} {z}\n" for x, y, z in grid) + "".join("f " + " ".join(str(v + 1) for v in f) + "\n" for f in faces))
        # One corner is pushed in, so far that its own triangle is turned over.
        pins = ""
        for v, (x, y, _) in enumerate(grid):
            if {x, y} & {0.0, 1.0}:
                by = 0.65 * x * y if 1.0 in (x, y) else 0
                pins += f"{v} {x - by} {y - by} 0\n"
        pathlib.Path(self.path("pins.txt")).write_text(pins)
        record = self.deform("--onto", "plane")
        said = [warning for warning in record["warnings"] if "flipped" in warning]
        self.assertEqual(len(said), 1, record["warnings"])
        self.assertIn("no map opens it", said[0])
        self.assertEqual(record["map"]["flipped"], 1)

    def test_bad_handles_are_refused(self):
        path = pathlib.Path(self.path("pins.txt"))
        path.write_text("0 1 2 3\n0 1 2 4\n")
        arguments = ("deform", self.path("a.obj"), "--pin", self.path("pins.txt"), "-o", self.path("out.obj"))
        self.assertIn("twice", self.run_command(*arguments, code=5).stderr)
        path.write_text("0 1 2\n")
        self.assertIn("pins.txt:1", self.run_command(*arguments, code=3).stderr)
        # In the hole of the surface that is given, of whose points the nearest are on its rim.
        places = [-3, 0, 0] + 0.3 * (self.points[self.loop[::-1]] - [-3, 0, 0])
        path.write_text("".join(f"{v} {x!r} {y!r} {z!r}\n" for v, (x, y, z) in zip(self.loop.tolist(), places.tolist())))
        self.assertIn("away from it", self.run_command(*arguments, "--onto", self.path("a.obj"), code=6).stderr)


if __name__ == "__main__":
    unittest.main()
