"""beltrami measure."""

import math
import unittest

import numpy as np

from support import Command, abs_mu, bump, disk, moebius, write_obj


class Measure(Command):
    def test_agrees_with_singular_values(self):
        points, faces = bump(14)
        z = points[:, 0] + 1j * points[:, 1]
        w = z + 0.4 * np.conj(z) + 0.3 * z * z + 0.08 * np.sin(40 * points[:, 0])
        image = np.column_stack([w.real, w.imag])
        write_obj(self.path("source.obj"), points, faces, image)
        write_obj(self.path("image.obj"), image, faces)
        expected, area = abs_mu(points, image, faces)
        self.assertGreater((expected > 1).sum(), 3)
        for arguments in (["source.obj"], ["source.obj", "image.obj"]):
            m = self.record("measure", *map(self.path, arguments))["map"]
            mean = (area * expected).sum() / area.sum()
            self.assertAlmostEqual(m["mu"]["mean"], mean, delta=1e-12)
            self.assertAlmostEqual(m["mu"]["std"], math.sqrt((area * (expected - mean) ** 2).sum() / area.sum()), delta=1e-12)
            self.assertAlmostEqual(m["mu"]["max"] / expected.max(), 1, delta=1e-12)
            order = np.argsort(expected)
            p99 = expected[order][np.searchsorted(np.cumsum(area[order]), 0.99 * area.sum())]
            self.assertAlmostEqual(m["mu"]["p99"], p99, delta=1e-12)
            self.assertEqual(m["flipped"], (expected > 1).sum())
            self.assertNotIn("K_max", m)

    def test_seams_are_read_per_corner(self):
        # Two triangles whose texture pieces lie apart: each is a similarity, though the vertices' images differ.
        with open(self.path("seam.obj"), "w") as out:
            out.write("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n")
            out.write("vt 0 0\nvt 2 0\nvt 2 2\nvt 10 10\nvt 10 13\nvt 7 13\n")
            out.write("f 1/1 2/2 3/3\nf 1/4 3/6 4/4\n")
        self.record("measure", self.path("seam.obj"))
        with open(self.path("seam.obj"), "w") as out:
            out.write("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n")
            out.write("vt 0 0\nvt 2 0\nvt 2 2\nvt 10 10\nvt 13 13\nvt 10 13\n")
            out.write("f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n")
        m = self.record("measure", self.path("seam.obj"))["map"]
        self.assertLess(m["mu"]["max"], 1e-14)
        self.assertEqual(m["flipped"], 0)

    def test_collapsed_faces_are_null_not_nan(self):
        points, faces = disk(1)
        write_obj(self.path("a.obj"), points, faces, 0 * points)
        m = self.record("measure", self.path("a.obj"))["map"]
        self.assertIsNone(m["mu"]["mean"])
        self.assertEqual(m["degenerate"], 6)

    def test_numbers_of_warnings_agree_with_their_nouns(self):
        points, faces = disk(2)
        for count, words in ((1, "1 face is flipped: face 0"), (2, "2 faces are flipped, the first is face 0")):
            with open(self.path("a.obj"), "w") as out:
                out.writelines("v %r %r 0\n" % tuple(map(float, p)) for p in points)
                out.writelines("vt %r %r\n" % tuple(map(float, p)) for p in points)
                for i, f in enumerate(faces):
                    turned = f[[0, 2, 1]] if i < count else f  # of the vt alone
                    out.write("f " + " ".join(f"{a + 1}/{b + 1}" for a, b in zip(f, turned)) + "\n")
            record = self.record("measure", self.path("a.obj"))
            self.assertEqual(record["map"]["flipped"], count)
            self.assertEqual(record["warnings"], [words])
        write_obj(self.path("b.obj"), points, faces, points * [1, 0])
        self.assertIn("faces collapse, the first is face 0", self.record("measure", self.path("b.obj"))["warnings"][0])

    def test_texture_coordinates_that_are_not_finite_are_an_error(self):
        points, faces = disk(3)
        vt = points.copy()
        last = len(points) - 1
        first = int(np.flatnonzero((faces == last).any(axis=1))[0])
        for value in (math.nan, math.inf):
            vt[last, 1] = value
            write_obj(self.path("a.obj"), points, faces, vt)
            self.assertIn(f"face {first} ", self.run_command("measure", self.path("a.obj"), code=4).stderr)
            failed = self.run_command("map", self.path("a.obj"), "-o", self.path("o.obj"), "--boundary", "disk", "--metric", "vt", code=4)
            self.assertIn(f"face {first} ", failed.stderr)

    def check_topological_defect(self, words, points, faces, vt, corners):
        """Warned of, without topology in the record; the numbers are those of the faces one by one."""
        with open(self.path("a.obj"), "w") as out:
            out.writelines("v %r %r %r\n" % tuple(map(float, p)) for p in points)
            out.writelines("vt %r %r\n" % tuple(map(float, p)) for p in vt)
            for f, c in zip(faces, corners):
                out.write("f " + " ".join(f"{i + 1}/{j + 1}" for i, j in zip(f, c)) + "\n")
        record = self.record("measure", self.path("a.obj"), "--report", self.path("a.html"))
        self.assertTrue(any(words in warning for warning in record["warnings"]), record["warnings"])
        self.assertEqual(set(record["source"]), {"vertices", "faces"})
        expected, area = zip(*(abs_mu(points[f], vt[c], np.array([[0, 1, 2]])) for f, c in zip(faces, corners)))
        expected, area = np.concatenate(expected), np.concatenate(area)
        self.assertAlmostEqual(record["map"]["mu"]["mean"], (area * expected).sum() / area.sum(), delta=1e-12)
        self.assertEqual(record["map"]["flipped"], (expected > 1).sum())
        self.record("measure", self.path("a.obj"), self.path("a.obj"))
        self.run_command("map", self.path("a.obj"), "-o", self.path("o.obj"), "--boundary", "disk", code=4)
        return record

    def test_topological_defects_are_warnings(self):
        points, faces, vt, corners = moebius(24)
        self.check_topological_defect("one-sided", points, faces, vt, corners)
        points, faces = bump(4)
        vt = points[:, :2] * [1.2, 0.9]
        turned = faces.copy()
        turned[5] = turned[5][[0, 2, 1]]
        record = self.check_topological_defect("oriented against", points, turned, vt, turned)
        self.assertEqual(record["map"]["flipped"], 1)
        twice = np.vstack([faces, faces[7:8]])
        self.check_topological_defect("the same corners", points, twice, vt, twice)
        # Three faces at an edge, and two that touch in a vertex.
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0.5], [0.3, 0, 1], [-1, -0.2, 0.1], [-1, 0.3, 0]], dtype=float)
        vt = points[:, :2] + 0.2 * points[:, 2:]
        fins = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
        self.check_topological_defect("more than two faces", points[:5], fins, vt[:5], fins)
        bow = np.array([[0, 1, 2], [0, 6, 5]])
        used = [0, 1, 2, 5, 6]
        bow = np.searchsorted(used, bow)
        self.check_topological_defect("share no edge", points[used], bow, vt[used], bow)

    def test_geometric_defects_are_errors(self):
        points, faces = bump(3)
        for name, p, f in (("zero area", np.where(np.arange(len(points))[:, None] == 1, points[0], points), faces),
                           ("degenerate", points, np.vstack([faces, [[0, 0, 1]]])),
                           ("zero area beside an inverted face", np.where(np.arange(len(points))[:, None] == 1, points[0], points),
                            np.vstack([faces[:-1], faces[-1:, ::-1]])),
                           ("folded in the plane", points[:, :2], np.vstack([faces[:-1], faces[-1:, ::-1]]))):
            with self.subTest(name):
                write_obj(self.path("a.obj"), p, f, points[:, :2])
                self.run_command("measure", self.path("a.obj"), code=4)

    def test_a_surface_in_space(self):
        points, faces = bump(10)
        write_obj(self.path("a.obj"), points, faces)
        turned = points @ np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]) * 3
        write_obj(self.path("b.obj"), turned, faces)
        m = self.record("measure", self.path("a.obj"), self.path("b.obj"))["map"]
        self.assertLess(m["mu"]["max"], 1e-12)
        self.assertEqual(m["flipped"], 0)

    def test_other_faces_are_refused(self):
        points, faces = disk(3)
        write_obj(self.path("a.obj"), points, faces)
        write_obj(self.path("b.obj"), points, faces[::-1])
        self.assertIn("same order", self.run_command("measure", self.path("a.obj"), self.path("b.obj"), code=4).stderr)
        self.assertIn("texture", self.run_command("measure", self.path("a.obj"), code=4).stderr)


if __name__ == "__main__":
    unittest.main()
