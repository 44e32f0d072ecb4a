"""beltrami remesh: better shapes of a mesh's own faces."""

import pathlib
import unittest

import numpy as np

from support import MESHES, Command, bump, read_faces, read_obj, write_obj


def angles(points, faces):
    out = []
    for j in range(3):
        a, b = points[faces[:, (j + 1) % 3]] - points[faces[:, j]], points[faces[:, (j + 2) % 3]] - points[faces[:, j]]
        cosine = (a * b).sum(1) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
        out.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))))
    return np.concatenate(out)


def shaken_bump(rings=12, amount=0.3):
    """The bump with its vertices inside moved along it."""
    points, faces = bump(rings)
    inside = np.hypot(points[:, 0], points[:, 1]) < 0.98
    r = np.random.default_rng(1)
    points[inside, :2] += amount / rings * r.uniform(-1, 1, (inside.sum(), 2))
    points[:, 2] = 0.5 * np.exp(-4 * ((points[:, 0] - 0.2) ** 2 + points[:, 1] ** 2))
    return points, faces


class Remesh(Command):
    def setUp(self):
        super().setUp()
        self.points, self.faces = shaken_bump()
        write_obj(self.path("a.obj"), self.points, self.faces)

    def remesh(self, *arguments, out="out.obj"):
        return self.record("remesh", self.path("a.obj"), "-o", self.path(out), *arguments)

    def test_shapes_get_better_and_the_surface_stays(self):
        record = self.remesh()
        out, _, faces = read_obj(self.path("out.obj"))
        np.testing.assert_array_equal(faces, self.faces)
        r = record["remesh"]
        before, after = angles(self.points, self.faces), angles(out, faces)
        self.assertAlmostEqual(r["angles"]["before"]["min"], before.min(), places=6)
        self.assertAlmostEqual(r["angles"]["after"]["min"], after.min(), places=6)
        self.assertAlmostEqual(r["angles"]["after"]["mean_deviation"], abs(after - 60).mean(), places=6)
        self.assertEqual(sum(r["angles"]["after"]["histogram"]), faces.size)
        self.assertGreater(after.min(), before.min() + 10)
        self.assertLess(abs(after - 60).mean(), 0.6 * abs(before - 60).mean())
        self.assertLess(r["distance"]["largest"], 1.4 * 0.003)
        self.assertEqual(r["opposed"], {"before": 0, "after": 0})
        self.assertEqual(record["comparison"][0]["method"], "before")
        self.assertLess(record["map"]["mu"]["mean"], record["comparison"][0]["map"]["mu"]["mean"])
        # The border slides along itself.
        self.assertGreater(np.hypot(out[-72:, 0], out[-72:, 1]).min(), np.cos(np.pi / 72) - 1e-9)

    def test_small_angles_are_opened(self):
        closed, opened = self.remesh("--p", "2")["remesh"], self.remesh("--p", "2", "--open-angles")["remesh"]
        for what in ("min", "p1"):
            self.assertGreaterEqual(opened["angles"]["after"][what], closed["angles"]["after"][what])
        self.assertGreater(opened["angles"]["after"]["min"], closed["angles"]["after"]["min"] + 1)
        self.assertLess(opened["distance"]["largest"], 1.4 * 0.003)
        for other in (("--fast",), ("--preserve", "normals")):
            self.assertIn("--open-angles", self.run_command(
                "remesh", self.path("a.obj"), "-o", self.path("b.obj"), "--open-angles", *other, code=2).stderr)

    def test_a_fixed_border_stays(self):
        self.remesh("--border", "fixed", "--p", "2")
        out, _, _ = read_obj(self.path("out.obj"))
        np.testing.assert_array_equal(out[-72:], self.points[-72:])

    def test_places_and_texture_go_along(self):
        write_obj(self.path("a.obj"), self.points, self.faces, self.points[:, :2])
        self.remesh("--places", self.path("places.txt"))
        out, vt, faces = read_obj(self.path("out.obj"))
        places = np.loadtxt(self.path("places.txt"))
        corners = self.points[self.faces[places[:, 0].astype(int)]]
        np.testing.assert_allclose(np.einsum("ij,ijk->ik", places[:, 1:], corners), out, atol=1e-12)
        # The texture is (x, y), linear on the faces: it is so still.
        used = np.unique(faces)
        np.testing.assert_allclose(vt[used], out[used, :2], atol=1e-9)

    def test_references(self):
        own = self.remesh("--reference", "original")
        self.assertLess(own["map"]["mu"]["max"], 1e-6)
        rows = "".join(f"{f} 60 60 60\n" for f in range(len(self.faces)))
        pathlib.Path(self.path("angles.txt")).write_text(rows)
        file, equilateral = self.remesh("--reference", self.path("angles.txt")), self.remesh()
        self.assertAlmostEqual(file["remesh"]["angles"]["after"]["min"], equilateral["remesh"]["angles"]["after"]["min"], 3)
        self.remesh("--reference", "valence")
        pathlib.Path(self.path("angles.txt")).write_text(rows.replace("0 60 60 60\n", "0 60 60 70\n", 1))
        error = self.run_command("remesh", self.path("a.obj"), "-o", self.path("b.obj"), "--reference",
                                 self.path("angles.txt"), code=2).stderr
        self.assertIn("face 0", error)

    def test_sizes_are_positive(self):
        pathlib.Path(self.path("sizes.txt")).write_text("3 2\n5 0\n")
        error = self.run_command("remesh", self.path("a.obj"), "-o", self.path("b.obj"), "--sizing", self.path("sizes.txt"),
                                 code=2).stderr
        self.assertIn("vertex 5", error)
        self.assertFalse(pathlib.Path(self.path("b.obj")).exists())

    def test_least_squares_maps(self):
        plain = self.remesh("--preserve", "normals")
        even = self.remesh("--preserve", "normals", "--uniform")
        self.assertEqual(plain["remesh"]["method"], "normals")
        self.assertEqual(plain["solve"]["iterations"], 1)
        self.assertLess(even["map"]["mu"]["std"], plain["map"]["mu"]["std"])
        self.run_command("remesh", self.path("a.obj"), "-o", self.path("b.obj"), "--uniform", code=2)

    def test_a_torus_says_what_its_grid_forbids(self):
        path = MESHES / "torus.obj"
        if not path.is_file():
            self.skipTest("no torus.obj")
        record = self.record("remesh", str(path), "-o", self.path("out.obj"), "--even-size", "0", "--max-distance", ".03")
        self.assertAlmostEqual(record["remesh"]["k_reference"], 0.2683, delta=0.002)
        self.assertGreater(record["map"]["mu"]["mean"], 0.265)
        self.assertLess(record["map"]["mu"]["mean"], 0.275)


    def test_polygons_stay_polygons(self):
        """A honeycomb on a bump, vertices moved: corners are kept, and every command reads them the same way."""
        points, faces = [], []
        numbers = {}
        for a in range(-4, 5):
            for b in range(-4, 5):
                if abs(a + b) > 4:
                    continue
                x, y = 3 ** 0.5 * (a + 0.5 * b), 1.5 * b
                face = []
                for j in range(6):
                    t = np.pi / 6 + j * np.pi / 3
                    key = (round(x + np.cos(t), 6), round(y + np.sin(t), 6))
                    if key not in numbers:
                        numbers[key] = len(points)
                        points.append(key)
                    face.append(numbers[key])
                faces.append(face)
        points = np.array(points)
        points += 0.2 * np.sin(np.arange(points.size).reshape(points.shape) * 37.0)
        points = np.column_stack([points, 2 * np.exp(-0.03 * (points ** 2).sum(1))])
        write_obj(self.path("a.obj"), points, faces)
        record = self.remesh("--max-distance", "0.01")
        self.assertFalse(any("triangles" in warning for warning in record["warnings"]))
        out, _, kept, _ = read_faces(self.path("out.obj"))
        self.assertEqual(kept, faces)
        r = record["remesh"]
        # The border's vertices are corners all, and stay.
        self.assertLess(r["angles"]["after"]["mean_deviation"], 0.6 * r["angles"]["before"]["mean_deviation"])
        before, after = (self.record("measure", self.path(name), "--reference", "equilateral") for name in ("a.obj", "out.obj"))
        self.assertLess(after["map"]["mu"]["mean"], before["map"]["mu"]["mean"])
        self.assertAlmostEqual(after["map"]["mu"]["mean"], record["map"]["mu"]["mean"], places=6)
        self.assertEqual(self.record("measure", self.path("a.obj"), self.path("out.obj"))["map"]["flipped"], 0)
        self.assertEqual(before["source"]["faces"], len(faces))


if __name__ == "__main__":
    unittest.main()
