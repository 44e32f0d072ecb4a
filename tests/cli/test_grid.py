"""beltrami grid: structured grids on surfaces."""

import json
import math
import pathlib
import unittest

import numpy as np

from support import MESHES, Command, bump, disk_with_holes, read_faces, ring, write_obj


def domain(path, outer, holes=()):
    pathlib.Path(path).write_text(json.dumps({"outer": outer, "holes": list(holes)}))
    return path


def corner_turns(points, faces):
    """Twice the area of the triangle at every corner of planar faces."""
    turns = []
    for f in faces:
        p = points[f]
        a, b = np.roll(p, -1, axis=0) - p, np.roll(p, 1, axis=0) - p
        turns.append(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    return turns


class Grids(Command):
    def grid(self, *arguments, out="grid.obj"):
        record = self.record("grid", *arguments, "-o", self.path(out))
        self.assertEqual(record["command"], "grid")
        return record, *read_faces(self.path(out))

    def assert_on_surface(self, record, v, places, points):
        """Vertices are where their faces and weights say, on the source's mesh."""
        rows = np.loadtxt(places)
        self.assertEqual(len(rows), len(v))
        for added in record.get("split", {}).get("added", []):
            self.assertEqual(added[0], len(points))
            points = np.vstack([points, points[added[1:]].mean(axis=0)])
        weights = rows[:, 5:8]
        self.assertGreater(weights.min(), -1e-12)
        np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-12)
        np.testing.assert_allclose((points[rows[:, 2:5].astype(int)] * weights[:, :, None]).sum(axis=1), v, atol=1e-12)

    def test_a_square_is_filled_with_quads(self):
        points, _ = bump(16)
        target = domain(self.path("square.json"), {"polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]})
        record, v, vt, faces, _ = self.grid(self.bump_file(), "--onto", target, "--cells", 12, "--places",
                                            self.path("places.txt"))
        grid = record["grid"]
        self.assertEqual((grid["quads"], grid["triangles"], grid["omitted_cells"]), (144, 0, 0))
        self.assertEqual((grid["vertices"], len(v)), (169, 169))
        self.assertEqual(grid["folded"], [])
        self.assertEqual((grid["carried_by"], grid["lines"], grid["cells"]), ("extremal", "rectangular", 12))
        self.assertTrue(all(len(f) == 4 for f in faces))
        self.assertGreater(min(turn.min() for turn in corner_turns(vt, faces)), 0)
        inside = (np.abs(vt - 0.5) < 0.499).all(axis=1)
        self.assertLess(np.abs(vt[inside] * 12 - np.round(vt[inside] * 12)).max(), 1e-12)
        self.assert_on_surface(record, v, self.path("places.txt"), points)
        # Nothing is turned over on the surface: the bump is a graph.
        self.assertGreater(min(turn.min() for turn in corner_turns(v[:, :2], faces)), 0)
        self.assertGreater(grid["area_part"], 0.97)
        # The quality is that of the faces in the file.
        angles, skews, aspects = [], [], []
        for f in faces:
            p = v[f]
            a, b = np.roll(p, -1, axis=0) - p, np.roll(p, 1, axis=0) - p
            angle = np.arccos((a * b).sum(axis=1) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1))
            angles += list(angle)
            skews += list(np.abs(angle - math.pi / 2))
            edges = np.linalg.norm(a, axis=1)
            aspects.append(edges.max() / edges.min())
        quality = grid["quality"]
        self.assertAlmostEqual(quality["min_angle"], min(angles), delta=1e-9)
        self.assertAlmostEqual(quality["max_angle"], max(angles), delta=1e-9)
        self.assertAlmostEqual(quality["mean_skew"], np.mean(skews), delta=1e-9)
        self.assertAlmostEqual(quality["mean_aspect"], np.mean(aspects), delta=1e-9)
        self.assertAlmostEqual(quality["max_aspect"], max(aspects), delta=1e-9)

    def test_a_ring_gets_circles_and_rays(self):
        points, faces = ring(48, 10, 0.5)
        write_obj(self.path("ring.obj"), points, faces)
        target = domain(self.path("ring.json"), {"circle": [1, 2, 3]}, [{"circle": [1, 2, 1]}])
        record, v, vt, faces, _ = self.grid(self.path("ring.obj"), "--onto", target, "--cells", 24)
        grid = record["grid"]
        self.assertEqual(grid["lines"], "log-polar")
        rows = round(24 * math.log(3) / (2 * math.pi))
        self.assertEqual((grid["quads"], grid["triangles"], grid["folded"]), (24 * rows, 0, []))
        self.assertAlmostEqual(record["map"]["K"], math.log(3) / math.log(2), delta=0.005)
        # The radial stretch carries circles to circles.
        radii = np.sort(np.linalg.norm(v[:, :2], axis=1)).reshape(rows + 1, 24)
        np.testing.assert_allclose(radii.mean(axis=1), 0.5 ** (1 - np.arange(rows + 1) / rows), rtol=5e-3)
        self.assertLess((radii.max(axis=1) - radii.min(axis=1)).max(), 0.01)

    def test_holes_and_the_border(self):
        holes = [((-0.35, 0.25), 0.13), ((0.3, -0.2), 0.2)]
        points, faces = disk_with_holes(28, holes)
        z = 0.3 * np.cos(2 * points[:, 0])
        write_obj(self.path("two.obj"), np.column_stack([points, z]), faces)
        target = domain(self.path("target.json"), {"polygon": [[-1, -1], [1, -1], [1, 1], [-1, 1]]},
                        [{"circle": [-0.4, 0.2, 0.15]}, {"polygon": [[0.15, -0.4], [0.5, -0.4], [0.5, 0], [0.15, 0]]}])
        stepped, v, vt, quads, _ = self.grid(self.path("two.obj"), "--onto", target, "--cells", 30, "--places",
                                             self.path("p.txt"))
        self.assertTrue(all(len(f) == 4 for f in quads))
        self.assertEqual(stepped["grid"]["folded"], [])
        self.assertGreater(stepped["grid"]["omitted_cells"], 0)
        self.assert_on_surface(stepped, v, self.path("p.txt"), np.column_stack([points, z]))
        self.assertEqual(len(self.record("info", self.path("grid.obj"))["source"]["boundary_loops"]), 3)
        trimmed, v, vt, mixed, _ = self.grid(self.path("two.obj"), "--onto", target, "--cells", 30, "--border", "trimmed")
        self.assertEqual(trimmed["grid"]["quads"] + trimmed["grid"]["triangles"], len(mixed))
        self.assertGreater(trimmed["grid"]["triangles"], 0)
        self.assertGreater(trimmed["grid"]["area_part"], stepped["grid"]["area_part"])
        self.assertGreater(min(turn.min() for turn in corner_turns(vt, mixed)), 0)

    def test_conformal_grids_have_right_angles(self):
        skews = []
        for rings, cells in ((16, 20), (32, 40)):
            record, _, _, faces, _ = self.grid(self.bump_file(rings), "--map", "conformal", "--cells", cells)
            self.assertEqual(record["grid"]["carried_by"], "conformal")
            self.assertTrue(all(len(f) == 4 for f in faces))
            self.assertEqual(record["grid"]["folded"], [])
            skews.append(record["grid"]["quality"]["mean_skew"])
        self.assertLess(skews[0], 0.03)
        self.assertLess(skews[1], 0.6 * skews[0])
        # A ring, its hole moved aside by a Möbius map of the disk: the grid has the circles of the ring again.
        points, faces = ring(72, 20, 0.3)
        z = points[:, 0] + 1j * points[:, 1]
        z = (z + 0.4) / (1 + 0.4 * z)
        write_obj(self.path("one.obj"), np.column_stack([z.real, z.imag]), faces)
        record, v, vt, faces, _ = self.grid(self.path("one.obj"), "--map", "conformal", "--cells", 36)
        self.assertEqual(record["grid"]["lines"], "log-polar")
        self.assertEqual(record["grid"]["omitted_cells"], 0)
        self.assertEqual(record["grid"]["quads"], 36 * round(36 * math.log(1 / 0.3) / (2 * math.pi)))
        self.assertAlmostEqual(record["grid"]["quality"]["mean_skew"], math.pi / 36, delta=0.004)  # of chords
        radii = np.linalg.norm(vt, axis=1)
        self.assertEqual(((radii > 0.99).sum(), (radii < 0.31).sum()), (36, 36))
        self.assertAlmostEqual(radii.min(), 0.3, delta=2e-3)

    def test_a_chess_board_in_every_format(self):
        source, square = self.bump_file(), domain(self.path("s.json"), {"polygon": [[0, 0], [2, 0], [2, 1], [0, 1]]})
        record, _, vt, faces, materials = self.grid(source, "--onto", square, "--cells", 12, "--pattern", "checker")
        self.assertEqual(record["grid"]["pattern"], "checker")
        self.assertEqual(len(faces), 72)
        for f, material in zip(faces, materials):
            column, row = np.floor(vt[f].mean(axis=0) * 6).astype(int)
            self.assertEqual(material, "light" if (column + row) % 2 == 0 else "dark")
        for name in ("grid.ply", "grid.off"):
            self.run_command("grid", source, "--onto", square, "--cells", 12, "--pattern", "checker", "-o", self.path(name))
            self.assertEqual(self.record("info", self.path(name))["source"]["faces"], 72)
        header = (self.folder / "grid.ply").read_bytes().split(b"end_header")[0].decode()
        for line in ("property double column", "property double row", "property uchar red"):
            self.assertIn(line, header)
        rows = [line.split() for line in (self.folder / "grid.off").read_text().splitlines()[-72:]]
        self.assertEqual(sorted({row[-1] for row in rows}), ["240", "40"])
        self.assertEqual([row[-1] == "240" for row in rows], [material == "light" for material in materials])

    def test_the_terminal_shows_the_quality(self):
        square = domain(self.path("s.json"), {"polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]})
        text = self.run_command("grid", self.bump_file(), "--onto", square, "-o", self.path("g.obj"), "--cells", 8,
                                "--report", self.path("g.html")).stdout
        head = next(line for line in text.splitlines() if line.startswith("grid "))
        row = next(line for line in text.splitlines() if line.startswith("rectangular"))
        for word in ("quads", "folded", "min angle", "mean skew", "max aspect", "area ratio"):
            self.assertIn(word, head)
        self.assertEqual(row.split()[1:5], ["64", "0", "0", "0"])
        self.assertIn("area_part", (self.folder / "g.html").read_text())

    def test_the_map_of_a_file_is_sampled(self):
        """Prescribed boundary, through a hole, without T-junctions."""
        points, faces = disk_with_holes(16, [(np.array([0.2, 0.1]), 0.3)])
        write_obj(self.path("a.obj"), points, faces)
        edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), 1)
        keys, count = np.unique(edges, axis=0, return_counts=True)
        rim = np.unique(keys[count == 1])
        image = points + 0.1 * np.sin(2 * points[:, ::-1])
        pathlib.Path(self.path("pins.txt")).write_text("".join(f"{v} {image[v, 0]!r} {image[v, 1]!r}\n" for v in rim.tolist()))
        self.run_command("map", self.path("a.obj"), "--pin", self.path("pins.txt"), "-o", self.path("map.obj"))
        for border in ("stepped", "trimmed"):
            record, v, vt, quads, _ = self.grid(self.path("a.obj"), "--from-map", self.path("map.obj"), "--cells", 30,
                                                "--border", border, "--places", self.path("places.txt"))
            self.assertEqual(record["grid"]["carried_by"], "file")
            self.assertEqual(record["grid"]["folded"], [])
            self.assert_on_surface(record, v, self.path("places.txt"), np.column_stack([points, 0 * points[:, 0]]))
            if border == "stepped":
                self.assertTrue(all(len(f) == 4 for f in quads))
            # No vertex lies inside an edge of another face.
            owners = {}
            for f in quads:
                for a, b in zip(f, f[1:] + f[:1]):
                    owners[(a, b)] = owners.get((a, b), 0) + 1
            self.assertEqual(max(owners.values()), 1)
            open_edges = [(a, b) for a, b in owners if (b, a) not in owners]
            for a, b in open_edges:
                d = vt[b] - vt[a]
                t = (vt - vt[a]) @ d / (d @ d)
                away = np.linalg.norm(vt - vt[a] - t[:, None] * d, axis=1)
                self.assertFalse(((t > 1e-6) & (t < 1 - 1e-6) & (away < 1e-9)).any())
        write_obj(self.path("bent.obj"), np.column_stack([points, points[:, 0] ** 2]), faces)
        self.assertIn("no vt", self.run_command(
            "grid", self.path("a.obj"), "--from-map", self.path("bent.obj"), "-o", self.path("g.obj"), code=4).stderr)


class Mistakes(Command):
    def setUp(self):
        super().setUp()
        self.source = self.bump_file(6)
        self.square = domain(self.path("s.json"), {"polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]})
        self.disk = domain(self.path("d.json"), {"circle": [0, 0, 1]})

    def fails(self, *arguments, code=2, out="out.obj"):
        before = sorted(p.name for p in self.folder.iterdir())
        done = self.run_command("grid", self.source, "-o", self.path(out), *arguments, code=code)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), before)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def test_options(self):
        self.assertIn("--onto", self.fails())
        self.assertIn("--map conformal", self.fails())
        self.assertIn("conformal", self.fails("--map", "conformal", "--onto", self.disk))
        self.assertIn("--loops belongs to --onto", self.fails("--map", "conformal", "--loops", "0:0"))
        self.assertIn("no domain in JSON", self.fails("--onto", self.source))
        self.assertIn("circle", self.fails("--onto", self.square, "--lines", "polar"))
        self.assertIn("hole at the centre", self.fails("--onto", self.disk, "--lines", "log-polar"))
        self.assertIn("at least 3 around", self.fails("--onto", self.disk, "--lines", "polar", "--cells", 2))
        self.assertIn("ten million", self.fails("--onto", self.disk, "--cells", 1000000))
        self.assertIn("--border", self.fails("--onto", self.disk, "--border", "round"))
        self.assertIn("--cells", self.fails("--onto", self.disk, "--cells", 0))
        self.assertIn(".ply", self.fails("--onto", self.disk, out="out.stl"))
        self.assertIn("would overwrite SURFACE", self.fails("--onto", self.disk, out="bump.obj"))
        self.assertIn("boundary loop 1", self.fails("--onto", self.disk, "--outer", 1))

    def test_holes_must_agree(self):
        target = domain(self.path("ring.json"), {"circle": [0, 0, 1]}, [{"circle": [0, 0, 0.3]}])
        self.assertIn("1 boundary loops, the target 2", self.fails("--onto", target, code=5))


@unittest.skipUnless(MESHES.is_dir() and (MESHES / "alex_3.obj").exists(), "no folder of real scans")
class Scans(Command):
    def test_a_face_with_three_holes(self):
        # Ng, Gu & Lui 2014, figure 22.
        target = domain(self.path("target.json"), {"circle": [0, 0, 1]},
                        [{"circle": [0.1, 0.1, 0.15]}, {"circle": [-0.5, -0.5, 0.15]}, {"circle": [-0.55, 0.3, 0.15]}])
        record = self.record("grid", MESHES / "alex_3.obj", "--onto", target, "--cells", 60, "-o", self.path("grid.obj"))
        grid = record["grid"]
        self.assertEqual((grid["triangles"], grid["folded"], record["map"]["flipped"]), (0, [], 0))
        self.assertGreater(grid["quads"], 2300)
        self.assertGreater(grid["area_part"], 0.9)
        self.assertGreater(grid["quality"]["min_angle"], 0.5)
        own = self.record("grid", MESHES / "alex_3.obj", "--map", "conformal", "--cells", 60, "-o", self.path("own.obj"))
        self.assertEqual((own["grid"]["triangles"], own["grid"]["folded"]), (0, []))
        self.assertLess(own["grid"]["quality"]["mean_skew"], 0.06)
        self.assertLess(own["grid"]["quality"]["mean_skew"], grid["quality"]["mean_skew"])


if __name__ == "__main__":
    unittest.main()
