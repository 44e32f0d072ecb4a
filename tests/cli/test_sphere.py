"""beltrami uniformize of closed surfaces: the round sphere."""

import math
import pathlib
import unittest

import numpy as np

from support import MESHES, Command, read_faces, read_obj, write_obj


def ball(levels=3, radius=lambda p: np.ones(len(p))):
    """An octahedron split into four, the points on the sphere times radius(points)."""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(levels):
        middles, finer = {}, []
        for a, b, c in faces:
            at = []
            for p, q in ((a, b), (b, c), (c, a)):
                key = min(p, q), max(p, q)
                if key not in middles:
                    middles[key] = len(points)
                    m = np.add(points[p], points[q])
                    points.append(tuple(m / np.linalg.norm(m)))
                at.append(middles[key])
            x, y, z = at
            finer += [(a, x, z), (x, b, y), (z, y, c), (x, y, z)]
        faces = finer
    points = np.array(points, float)
    return points * radius(points)[:, None], np.array(faces)


def bumps(p):
    return 1 + 0.3 * np.cos(4 * p[:, 2] - p[:, 0]) + 0.1 * p[:, 1]


def flips(sphere, faces):
    a, b, c = (sphere[np.array(faces)[:, i]] for i in range(3))
    return int((np.einsum("ij,ij->i", a, np.cross(b - a, c - a)) <= 0).sum())


class Sphere(Command):
    def write_ball(self, name="ball.obj", levels=3):
        points, faces = ball(levels, bumps)
        write_obj(self.path(name), points, faces)
        return points, faces

    def test_positions_on_the_sphere(self):
        points, faces = self.write_ball()
        arguments = ("uniformize", self.path("ball.obj"), "-o", self.path("out.obj"), "--as-positions")
        record = self.record(*arguments)
        self.assertEqual(record["sphere"]["method"], "conformal_equivalence")
        self.assertEqual(record["sphere"]["route"], "direct")
        self.assertLess(record["sphere"]["residual"], 1e-10)
        self.assertLess(record["sphere"]["centre_distance"], 1e-10)
        self.assertEqual(record["sphere"]["unresolved"], {"faces": 0, "area": 0})
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertLess(record["map"]["mu"]["max"], 0.3)
        sphere, _, out = read_obj(self.path("out.obj"))
        np.testing.assert_array_equal(out, faces)
        np.testing.assert_allclose(np.linalg.norm(sphere, axis=1), 1, atol=1e-14)
        self.assertEqual(flips(sphere, faces), 0)
        # What measure says of the two meshes is what was said.
        measured = self.record("measure", self.path("ball.obj"), self.path("out.obj"))
        self.assertAlmostEqual(measured["map"]["mu"]["mean"], record["map"]["mu"]["mean"], delta=1e-9)
        self.assertIn("a sphere: no moduli", self.run_command(*arguments, "--report", self.path("page.html")).stdout)

    def test_texture_in_a_pair_of_charts(self):
        points, faces = self.write_ball()
        record = self.record("uniformize", self.path("ball.obj"), "-o", self.path("out.obj"))
        v, vt, out, _ = read_faces(self.path("out.obj"))
        np.testing.assert_allclose(v, points)
        self.assertEqual([tuple(f) for f in out], [tuple(f) for f in faces])
        lines = pathlib.Path(self.path("out.obj")).read_text().splitlines()
        corners = [[int(c.split("/")[1]) - 1 for c in line.split()[1:]] for line in lines if line.startswith("f ")]
        p, q, w = (vt[np.array(corners)[:, i]] for i in range(3))
        area = np.cross(q - p, w - p)
        self.assertGreater(area.min(), 0)
        # The charts do not overlap: their areas are no larger than the boxes they lie in side by side.
        self.assertGreater(len(vt), len(v))
        north = (p[:, 0] < 1.3) & (q[:, 0] < 1.3) & (w[:, 0] < 1.3)
        self.assertLess(vt[np.array(corners)[north].ravel(), 0].max(), vt[np.array(corners)[~north].ravel(), 0].min())
        # Texture coordinates measure like the map: conformal charts of it.
        measured = self.record("measure", self.path("out.obj"))
        self.assertEqual(measured["map"]["flipped"], 0)
        self.assertAlmostEqual(measured["map"]["mu"]["mean"], record["map"]["mu"]["mean"], delta=0.02)
        self.run_command("uniformize", self.path("ball.obj"), "-o", self.path("fit.ply"), "--fit", "unit")
        self.assertEqual(self.record("measure", self.path("fit.ply"))["map"]["flipped"], 0)

    def test_methods(self):
        self.write_ball()
        arguments = ("uniformize", self.path("ball.obj"), "-o", self.path("out.obj"), "--as-positions", "--method")
        means = {}
        for method, name in (("equivalence", "conformal_equivalence"), ("distortion", "least_distortion"),
                             ("tutte", "tutte")):
            record = self.record(*arguments, method)
            self.assertEqual(record["sphere"]["method"], name)
            self.assertEqual(record["map"]["flipped"], 0)
            means[method] = record["map"]["mu"]["mean"]
        self.assertLess(means["distortion"], 1.05 * means["equivalence"])
        self.assertGreater(means["tutte"], 2 * means["equivalence"])

    def test_quads_that_fold_are_cut(self):
        # A cube whose top is a quad with a corner pushed in past the diagonal.
        points = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
        points[7] = (0.3, 0.3, 1)
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        write_obj(self.path("cube.obj"), points, faces)
        record = self.record("uniformize", self.path("cube.obj"), "-o", self.path("out.obj"), "--as-positions")
        self.assertIn("cut into triangles", " ".join(record["warnings"]))
        self.assertEqual(record["map"]["flipped"], 0)
        sphere, _, out, _ = read_faces(self.path("out.obj"))
        self.assertEqual(flips(sphere, [f[:3] for f in out if len(f) == 3]), 0)
        self.assertGreater(len(out), 6)

    def test_limbs_below_double_precision_are_refused_by_name(self):
        # A rod of length 60 and radius 1 on a ball shrinks by about e^-60.
        sides, rings = 12, 90
        angles = 2 * np.pi * np.arange(sides) / sides
        profile = [(1.0, 10 + 60 - 0.5 * i) for i in range(121)]
        profile += [(10 * math.sin(t), 10 * math.cos(t)) for t in np.linspace(0.15, 3.0, 20)]
        points = [(r * math.cos(a), r * math.sin(a), z) for r, z in profile for a in angles]
        top, bottom = len(points), len(points) + 1
        points += [(0, 0, 70.5), (0, 0, -10)]
        at = lambda r, s: r * sides + s % sides
        faces = [(top, at(0, s), at(0, s + 1)) for s in range(sides)]
        for r in range(len(profile) - 1):
            for s in range(sides):
                faces += [(at(r, s), at(r + 1, s), at(r + 1, s + 1)), (at(r, s), at(r + 1, s + 1), at(r, s + 1))]
        faces += [(bottom, at(len(profile) - 1, s + 1), at(len(profile) - 1, s)) for s in range(sides)]
        write_obj(self.path("rod.obj"), np.array(points), np.array(faces))
        text = self.run_command("uniformize", self.path("rod.obj"), "-o", self.path("out.obj"), code=6).stderr
        self.assertRegex(text, r"faces \([\d.]+ % of the area\) have edges below 1e-13")
        self.assert_nothing_left("rod.obj")

    def test_what_does_not_fit_closed_surfaces(self):
        self.write_ball(levels=1)
        text = self.run_command("uniformize", self.path("ball.obj"), "-o", self.path("out.off"), code=2).stderr
        self.assertIn("--as-positions", text)
        self.run_command("uniformize", self.path("ball.obj"), "-o", self.path("out.off"), "--as-positions")
        text = self.run_command("uniformize", self.path("ball.obj"), "-o", self.path("out.obj"), "--outer", "0",
                                code=2).stderr
        self.assertIn("--outer", text)
        points, faces = ball(1)
        write_obj(self.path("open.obj"), points, faces[1:])
        text = self.run_command("uniformize", self.path("open.obj"), "-o", self.path("out.obj"), "--method", "tutte",
                                code=2).stderr
        self.assertIn("--method", text)
        both = np.vstack([points, points + [5, 0, 0]])
        write_obj(self.path("two.obj"), both, np.vstack([faces, faces + len(points)]))
        text = self.run_command("uniformize", self.path("two.obj"), "-o", self.path("out.obj"), code=4).stderr
        self.assertIn("2 components", text)
        self.assertIn("--keep-largest", text)

    @unittest.skipUnless((MESHES / "cow.off").exists(), "no real meshes")
    def test_scans(self):
        for name, mean, std, largest in (("cow.off", .1105, .1325, .9956), ("hand_closed.obj", .0459, .0385, .177),
                                         ("spot_control_mesh.obj", .34, .26, .996)):
            record = self.record("uniformize", str(MESHES / name), "-o", self.path("out.ply"), "--drop-unreferenced")
            with self.subTest(mesh=name):
                self.assertEqual(record["map"]["flipped"], 0)
                self.assertLess(record["map"]["mu"]["mean"], mean)
                self.assertLess(record["map"]["mu"]["std"], std)
                self.assertLess(record["map"]["mu"]["max"], largest)


if __name__ == "__main__":
    unittest.main()
