"""beltrami register and transfer: surfaces carried onto each other by landmarks."""

import pathlib
import unittest

import numpy as np

from support import MESHES, Command, bump, read_faces, read_obj, write_obj
from test_sphere import ball, bumps, flips

CASES = MESHES.parent / "cases"


def other_bumps(p):
    return 1 + 0.2 * np.sin(3 * p[:, 0] + p[:, 1]) + 0.1 * p[:, 2]


class Register(Command):
    def write_text(self, name, rows):
        pathlib.Path(self.path(name)).write_text("# rows\n" + "".join(" ".join(map(repr, row)) + "\n" for row in rows))
        return self.path(name)

    def balls(self, levels=4):
        self.source, self.faces = ball(levels, bumps)
        self.target, _ = ball(levels, other_bumps)
        write_obj(self.path("a.obj"), self.source, self.faces)
        write_obj(self.path("b.obj"), self.target, self.faces)

    def register(self, *arguments, a="a.obj", b="b.obj"):
        return self.record("register", self.path(a), self.path(b), "-o", self.path("out.obj"), *arguments)

    def refused(self, code, *arguments, a="a.obj", b="b.obj"):
        return self.run_command("register", self.path(a), self.path(b), "-o", self.path("out.obj"), *arguments,
                                code=code).stderr

    def test_landmarks_go_to_their_places(self):
        self.balls()
        rows = [(0, 0), (1, 1), (2, 30), (3, 3), (4, 4), (5, 5)]
        apart = np.linalg.norm(self.source[:, None] - self.source[[a for a, _ in rows]], axis=2).min(axis=1)
        last = int(apart.argmax())
        face = self.faces[(self.faces == last).any(axis=1)][0]
        point = self.target[face].mean(axis=0) * 1.001
        landmarks = self.write_text("pairs.txt", [*rows, (last, *point.tolist())])
        record = self.register("--landmarks", landmarks, "--places", self.path("places.txt"))
        self.assertEqual(record["registration"]["landmarks"], 7)
        self.assertEqual(record["registration"]["dimension"], 4)
        self.assertEqual(record["solve"]["termination"], "converged")
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertAlmostEqual(record["registration"]["inverse_k"], record["map"]["k"], delta=0.02)
        out, _, faces = read_obj(self.path("out.obj"))
        np.testing.assert_array_equal(faces, self.faces)
        for a, b in rows:
            np.testing.assert_allclose(out[a], self.target[b], atol=1e-12)
        self.assertLess(np.linalg.norm(out[last] - point), 0.01)
        # Places are where the vertices are.
        places = np.loadtxt(self.path("places.txt"))
        corners = self.target[self.faces[places[:, 0].astype(int)]]
        np.testing.assert_allclose(np.einsum("ij,ijk->ik", places[:, 1:], corners), out, atol=1e-12)

    def test_the_map_and_its_inverse(self):
        self.balls()
        pairs = [(0, 0), (1, 1), (2, 30), (3, 3), (4, 4), (5, 77)]
        there = self.register("--landmarks", self.write_text("pairs.txt", pairs))
        back = self.register("--landmarks", self.write_text("back.txt", [(b, a) for a, b in pairs]), a="b.obj",
                             b="a.obj")
        self.assertAlmostEqual(there["map"]["k"], back["map"]["k"], delta=5e-3)

    def test_a_start_and_a_way(self):
        self.balls(3)
        pairs = self.write_text("pairs.txt", [(v, v) for v in range(6)])
        first = self.register("--landmarks", pairs)
        pathlib.Path(self.path("out.obj")).rename(self.path("start.obj"))
        again = self.register("--landmarks", pairs, "--start-map", self.path("start.obj"))
        self.assertAlmostEqual(first["map"]["k"], again["map"]["k"], delta=1e-3)
        way = self.register("--landmarks", pairs, "--waypoints", self.write_text("way.txt", [(1, 0, 20)]))
        self.assertAlmostEqual(first["map"]["k"], way["map"]["k"], delta=1e-3)  # there and back: the same class

    def test_soft_landmarks_balance(self):
        self.balls()
        pairs = [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (5, 77)]
        landmarks = self.write_text("pairs.txt", pairs)
        hard = self.register("--landmarks", landmarks)
        last, distances = hard["map"]["k"], []
        for weight in (1000, 30, 1):
            soft = self.register("--landmarks", landmarks, "--weights", self.write_text("w.txt", [(5, weight)]))
            self.assertEqual(soft["map"]["flipped"], 0)
            self.assertLess(soft["map"]["k"], last)
            last = soft["map"]["k"]
            distances.append(soft["registration"]["largest_distance"])
            out, _, _ = read_obj(self.path("out.obj"))
            self.assertAlmostEqual(np.linalg.norm(out[5] - self.target[77]), distances[-1], delta=1e-9)
            np.testing.assert_allclose(out[4], self.target[4], atol=1e-12)
        self.assertEqual(distances, sorted(distances))

    def test_disks_with_landmarks_inside(self):
        points, faces = bump(16)
        write_obj(self.path("a.obj"), points, faces)
        moved = points + np.column_stack([0.05 * np.sin(3 * points[:, 1]), np.zeros(len(points)), 0.1 * points[:, 0]])
        write_obj(self.path("b.obj"), moved, faces)
        inside = [20, 60, 110, 200]
        landmarks = self.write_text("pairs.txt", [(v, v) for v in inside])
        record = self.register("--landmarks", landmarks)
        self.assertEqual(record["map"]["flipped"], 0)
        out, _, _ = read_obj(self.path("out.obj"))
        for v in inside:
            np.testing.assert_allclose(out[v], moved[v], atol=1e-12)
        soft = self.register("--landmarks", landmarks, "--weights",
                             self.write_text("w.txt", [(v, 10) for v in inside]))
        self.assertLessEqual(soft["map"]["k"], record["map"]["k"] + 1e-4)
        self.assertGreater(soft["registration"]["largest_distance"], 0)

    def test_disks_have_starts_and_inverses(self):
        points, faces = bump(16)
        write_obj(self.path("a.obj"), points, faces)
        write_obj(self.path("b.obj"), points, faces)
        pairs = self.write_text("pairs.txt", [(v, v + 1) for v in (40, 90, 140)])
        first = self.register("--landmarks", pairs)
        self.assertAlmostEqual(first["registration"]["inverse_k"], first["map"]["k"], delta=.1 * first["map"]["k"])
        pathlib.Path(self.path("out.obj")).rename(self.path("start.obj"))
        again = self.register("--landmarks", pairs, "--start-map", self.path("start.obj"))
        self.assertAlmostEqual(again["map"]["k"], first["map"]["k"], delta=2e-3)
        # A way there and back is the class of none; one into another landmark is none at all.
        way = self.register("--landmarks", pairs, "--waypoints", self.write_text("way.txt", [(1, 40, 60)]))
        self.assertAlmostEqual(way["map"]["k"], first["map"]["k"], delta=1e-3)
        into = self.write_text("way.txt", [(1, 40, 90), (1, 90, 90)])
        self.assertIn("step 1", self.refused(5, "--landmarks", pairs, "--waypoints", into))
        self.assertIn("waypoint", self.refused(2, "--landmarks", pairs, "--waypoints", into, "--start-map",
                                               self.path("start.obj")))

    def test_transfer_between_surfaces_with_boundary(self):
        points, faces = bump(12)
        write_obj(self.path("a.obj"), points, faces, points[:, :2])
        other, other_faces = bump(17)
        write_obj(self.path("b.obj"), other, other_faces)
        places = self.path("places.txt")
        self.register("--places", places)
        arguments = ("transfer", self.path("a.obj"), self.path("b.obj"), "--places", places, "-o")
        np.savetxt(self.path("ones.txt"), np.ones(len(faces)))
        self.run_command(*arguments, self.path("faces.txt"), "--face-values", self.path("ones.txt"))
        np.testing.assert_allclose(np.loadtxt(self.path("faces.txt")), np.ones(len(other_faces)))
        np.savetxt(self.path("field.txt"), points)
        self.run_command(*arguments, self.path("there.txt"), "--values", self.path("field.txt"))
        # Points go and come back, boundary vertices too.
        np.savetxt(self.path("line.txt"), points)
        self.run_command(*arguments, self.path("on_b.txt"), "--points", self.path("line.txt"), "--as-places")
        self.run_command(*arguments, self.path("back.txt"), "--points", self.path("on_b.txt"), "--back")
        np.testing.assert_allclose(np.loadtxt(self.path("back.txt")), points, atol=1e-7)
        # The overlay is B's surface, with A's texture exactly.
        self.run_command(*arguments, self.path("both.obj"), "--overlay")
        v, vt, both, of_corners = read_faces(self.path("both.obj"))
        area = lambda p, f: np.linalg.norm(np.cross(p[f[:, 1]] - p[f[:, 0]], p[f[:, 2]] - p[f[:, 0]]), axis=1).sum()
        self.assertAlmostEqual(area(np.array(v), np.array(both)), area(other, other_faces), delta=1e-6)
        self.assertGreater(len(both), len(other_faces))
        self.assertEqual(len(vt), 3 * len(both))

    def curve_file(self, *blocks):
        """Blocks (mode, vertices of A, vertices or points of B)."""
        text = ""
        for mode, here, there in blocks:
            text += f"curve {mode}  # a block\n" + "".join(f"{v}\n" for v in here) + "onto\n"
            text += "".join((f"{v}" if np.ndim(v) == 0 else " ".join(map(repr, v))) + "\n" for v in there)
        pathlib.Path(self.path("curves.txt")).write_text(text)
        return self.path("curves.txt")

    def test_curves_slide_or_stay(self):
        self.balls(3)
        # Two geodesics between vertices of the icosahedron, one of them past a point of space, and a closed one.
        nearest = lambda p: int(np.linalg.norm(self.source / np.linalg.norm(self.source, axis=1)[:, None] - p, axis=1).argmin())
        ring = [nearest(np.array(p)) for p in ((.87, 0, -.5), (0, .87, -.5), (-.87, 0, -.5), (0, -.87, -.5))]
        arc = [nearest(np.array(p)) for p in ((.9, .1, .45), (0, .8, .6), (-.6, .6, .5))]
        there = [arc[0], self.target[arc[1]].tolist(), arc[2]]
        records = {}
        for mode in ("slide", "fixed"):
            curves = self.curve_file((mode, arc, there), (mode, [*ring, ring[0]], [*ring, ring[0]]))
            records[mode] = self.register("--curves", curves, "--method", "lp")
            lp = records[mode]["registration"]["lp"]
            self.assertEqual(lp["curves"], 2)
            self.assertLess(lp["curve_distance"], 5e-3)
            self.assertEqual(records[mode]["solve"]["termination"], "converged")
            out, _, _ = read_obj(self.path("out.obj"))
            for v in (arc[0], arc[2]) if mode == "slide" else (*arc, *ring):
                np.testing.assert_allclose(out[v], self.target[v], atol=1e-6)
            extremal = self.register("--curves", curves, "--method", "extremal")
            least, even = records[mode]["map"], extremal["map"]
            self.assertLess(even["mu"]["std"], least["mu"]["std"])
            self.assertLess(even["mu"]["max"], least["mu"]["max"])
            self.assertLessEqual(even["K_lower"], even["K"])
            self.assertGreater(even["k"], least["mu"]["mean"])
            self.assertLess(extremal["registration"]["by_phi"]["std"], 0.35 * even["k"])
        self.assertLess(records["slide"]["map"]["mu"]["mean"], records["fixed"]["map"]["mu"]["mean"])
        # Least Lᵖ maps need no curves.
        pairs = self.write_text("pairs.txt", [(v, v) for v in range(5)])
        even = self.register("--landmarks", pairs, "--method", "lp", "--p", "8")
        self.assertLess(even["map"]["mu"]["max"],
                        self.register("--landmarks", pairs, "--method", "lp")["map"]["mu"]["max"])

    def test_curves_that_cannot_be(self):
        self.balls(3)
        crossing = self.curve_file(("slide", [0, 5], [0, 5]), ("slide", [0, 7], [0, 7]))
        self.assertIn("curve 2 meets curve 1", self.refused(5, "--curves", crossing))
        self.assertIn("coincide", self.refused(5, "--curves", self.curve_file(("slide", [0, 0], [0, 5]))))
        self.assertIn("does not exist", self.refused(5, "--curves", self.curve_file(("slide", [0, 10**6], [0, 5]))))
        self.assertIn("partner", self.refused(5, "--curves", self.curve_file(("slide", [0, 5], [0, 5, 7]))))
        curves = self.curve_file(("slide", [0, 5], [0, 5]))
        way = self.write_text("way.txt", [(1, 0, 5)])
        self.assertIn("--waypoints", self.refused(2, "--curves", curves, "--method", "extremal", "--waypoints", way))
        for text, said in (("curve wide\n", "curves.txt:1"), ("0\n", "curves.txt:1"), ("curve slide\n0\n5\n", "onto"),
                           ("curve slide\n0\nx\n", "'x' is no number"), ("# none\n", "no curve")):
            pathlib.Path(self.path("curves.txt")).write_text(text)
            self.assertIn(said, self.refused(3, "--curves", self.path("curves.txt")))

    def test_refusals(self):
        self.balls(3)
        pairs = self.write_text("pairs.txt", [(v, v) for v in range(5)])
        write_obj(self.path("open.obj"), self.source, self.faces[1:])
        self.assertIn("closed", self.refused(4, "--landmarks", pairs, a="open.obj"))
        both = np.vstack([self.source, self.source + [5, 0, 0]])
        write_obj(self.path("two.obj"), both, np.vstack([self.faces, self.faces + len(self.source)]))
        self.assertIn("2 components", self.refused(4, "--landmarks", pairs, a="two.obj"))
        self.assertIn("target", self.refused(4, "--landmarks", pairs, b="two.obj"))
        twice = self.write_text("twice.txt", [(0, 0), (1, 1), (2, 2), (0, 5)])
        self.assertIn("twice", self.refused(5, "--landmarks", twice))
        same = self.write_text("same.txt", [(0, 0), (1, 1), (2, 2), (3, 2)])
        self.assertIn("coincide", self.refused(5, "--landmarks", same))
        swapped = [(v, v + 1 if v % 2 == 0 else v - 1) for v in range(40)]
        self.assertIn("folds", self.refused(5, "--landmarks", self.write_text("swap.txt", swapped)))
        self.assertIn("pairs.txt:2", self.refused(3, "--landmarks", self.write_text("pairs.txt", [(0, 1, 2)])))
        self.assertIn("does not exist", self.refused(5, "--landmarks", self.write_text("far.txt", [(10**6, 1)])))
        self.assertIn("--landmarks", self.refused(2, "--weights", pairs))

    def test_a_torus_has_no_sphere(self):
        n = 12
        t = 2 * np.pi * np.arange(n) / n
        u, v = (x.ravel() for x in np.meshgrid(t, t, indexing="ij"))
        points = np.column_stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)])
        at = lambda i, j: i % n * n + j % n
        faces = [f for i in range(n) for j in range(n)
                 for f in ((at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1)))]
        write_obj(self.path("a.obj"), points, np.array(faces))
        self.balls_target = ball(2)
        write_obj(self.path("b.obj"), *self.balls_target)
        self.assertIn("genus 1", self.refused(4))

    def test_transfer(self):
        self.balls()
        pairs = self.write_text("pairs.txt", [(0, 0), (1, 1), (2, 30), (3, 3), (4, 4), (5, 5)])
        places = self.path("places.txt")
        self.register("--landmarks", pairs, "--places", places)
        arguments = ("transfer", self.path("a.obj"), self.path("b.obj"), "--places", places, "-o",
                     self.path("values.txt"))
        np.savetxt(self.path("field.txt"), self.source)
        self.run_command(*arguments, "--values", self.path("field.txt"))
        there = np.loadtxt(self.path("values.txt"))
        np.testing.assert_allclose(there[30], self.source[2], atol=1e-9)
        # There and back is near where it began: twice linear interpolation.
        pathlib.Path(self.path("values.txt")).rename(self.path("there.txt"))
        self.run_command(*arguments, "--values", self.path("there.txt"), "--back")
        back = np.loadtxt(self.path("values.txt"))
        self.assertLess(np.abs(back - self.source).max(), 0.12)
        np.savetxt(self.path("faces.txt"), np.ones(len(self.faces)))
        self.run_command(*arguments, "--face-values", self.path("faces.txt"))
        np.testing.assert_allclose(np.loadtxt(self.path("values.txt")), 1)
        # Points: there as places, back as points.
        line = np.linspace(self.source[self.faces[50][0]], self.source[self.faces[50][1]], 5)
        np.savetxt(self.path("line.txt"), line)
        self.run_command(*arguments, "--points", self.path("line.txt"), "--as-places")
        pathlib.Path(self.path("values.txt")).rename(self.path("on_b.txt"))
        self.run_command(*arguments, "--points", self.path("on_b.txt"), "--back")
        np.testing.assert_allclose(np.loadtxt(self.path("values.txt")), line, atol=1e-6)
        # A polyline bends at the edges of both, and is where its points are.
        self.run_command(*arguments, "--points", self.path("line.txt"))
        points = np.loadtxt(self.path("values.txt"))
        np.savetxt(self.path("ends.txt"), line[[0, -1]])
        self.run_command(*arguments, "--polyline", self.path("ends.txt"))
        bent = np.loadtxt(self.path("values.txt"))
        self.assertGreater(len(bent), 2)
        np.testing.assert_allclose(bent[[0, -1]], points[[0, -1]], atol=1e-9)
        ways = np.diff(bent, axis=0)
        for point in points:
            t = np.clip(((point - bent[:-1]) * ways).sum(1) / (ways**2).sum(1), 0, 1)
            self.assertLess(np.linalg.norm(bent[:-1] + t[:, None] * ways - point, axis=1).min(), 1e-6)
        # A mesh on the surface: the surface itself goes where its vertices are.
        self.run_command(*arguments[:-1], self.path("carried.obj"), "--mesh", self.path("a.obj"))
        out, _, _ = read_obj(self.path("out.obj"))
        carried, _, _ = read_obj(self.path("carried.obj"))
        np.testing.assert_allclose(carried, out, atol=1e-9)
        # Its colours and its polygons go along.
        lines = pathlib.Path(self.path("a.obj")).read_text().splitlines()
        coloured = [line + f" {i % 3 / 2} 0.25 1" if line.startswith("v ") else line for i, line in enumerate(lines)]
        pathlib.Path(self.path("coloured.obj")).write_text("\n".join(coloured) + "\nf 1 2 3 4 5\n")
        self.run_command(*arguments[:-1], self.path("carried.obj"), "--mesh", self.path("coloured.obj"))
        carried = pathlib.Path(self.path("carried.obj")).read_text().splitlines()
        colours = [[float(x) for x in line.split()[4:]] for line in carried if line.startswith("v ")]
        wanted = [[float(x) for x in line.split()[4:]] for line in coloured if line.startswith("v ")]
        np.testing.assert_allclose(colours, wanted)
        self.assertEqual([len(line.split()) for line in carried if line.startswith("f ")][-1], 6)
        self.run_command("uniformize", self.path("a.obj"), "-o", self.path("textured.obj"))
        self.run_command("transfer", self.path("textured.obj"), self.path("b.obj"), "--places", places, "-o",
                         self.path("on_b.obj"), "--texture")
        v, vt, faces, _ = read_faces(self.path("on_b.obj"))
        np.testing.assert_allclose(v, self.target)
        self.assertEqual(len(vt), 3 * len(faces))
        text = self.run_command(*arguments, "--texture", code=2).stderr
        self.assertIn("extension", text)
        text = self.run_command(*arguments, "--values", self.path("faces.txt"), code=3).stderr
        self.assertIn("rows", text)

    @unittest.skipUnless((CASES / "landmarks_hand_closed_hippocampus_8.txt").exists(), "no real meshes")
    def test_scans(self):
        for a, b, name, k in (("hand_closed", "hippocampus", "hand_closed_hippocampus_8", .1759),
                              ("fish_quad", "hand_closed", "fish_quad_hand_closed_8", .1617),
                              ("fish_quad", "hand_closed", "fish_quad_hand_closed_20", .1452)):
            pairs = np.loadtxt(CASES / f"landmarks_{name}.txt", dtype=int)
            back = self.write_text("back.txt", pairs[:, ::-1].tolist())
            scans = [str(MESHES / f"{n}.obj") for n in (a, b)]
            there = self.record("register", *scans, "--landmarks", str(CASES / f"landmarks_{name}.txt"), "-o",
                                self.path("out.ply"))
            returned = self.record("register", *scans[::-1], "--landmarks", back, "-o", self.path("out.ply"))
            with self.subTest(pair=name):
                for record in (there, returned):
                    self.assertEqual(record["map"]["flipped"], 0)
                    self.assertAlmostEqual(record["map"]["k"], k, delta=2e-3)
                    self.assertLess(record["registration"]["by_phi"]["std"], .027)
                self.assertAlmostEqual(there["map"]["k"], returned["map"]["k"], delta=1e-3)

    @unittest.skipUnless((CASES / "landmarks_hand_closed_hippocampus_8.txt").exists(), "no real meshes")
    def test_a_start_goes_in_parts_where_the_mesh_cannot_follow(self):
        points, _, faces = read_obj(str(MESHES / "hippocampus.obj"))
        write_obj(self.path("long.obj"), points * [1, 1, 3], faces)
        vertices = np.loadtxt(CASES / "landmarks_hand_closed_hippocampus_8.txt", dtype=int)[:, 1]
        same = self.write_text("same.txt", np.stack([vertices, vertices], 1).tolist())
        record = self.record("register", str(MESHES / "hippocampus.obj"), self.path("long.obj"), "--landmarks", same,
                             "-o", self.path("out.ply"))
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertAlmostEqual(record["map"]["k"], .3651, delta=3e-3)  # as on the divided mesh
        self.assertAlmostEqual(record["registration"]["inverse_k"], record["map"]["k"], delta=1e-3)


if __name__ == "__main__":
    unittest.main()
