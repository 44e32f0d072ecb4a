"""beltrami map --onto and beltrami distance: boundaries that slide."""

import json
import math
import pathlib
import unittest

import numpy as np

from support import MESHES, Command, abs_mu, disk, disk_with_holes, read_obj, ring, write_obj


def domain(path, outer, holes=()):
    pathlib.Path(path).write_text(json.dumps({"outer": outer, "holes": list(holes)}))
    return path


class WithRing(Command):
    def setUp(self):
        super().setUp()
        self.inner = 0.5
        self.points, self.faces = ring(48, 10, self.inner)
        self.source = self.path("ring.obj")
        write_obj(self.source, self.points, self.faces)
        self.target = domain(self.path("target.json"), {"circle": [0, 0, 1]}, [{"circle": [0, 0, 0.3]}])


class Onto(WithRing):
    def test_ring_to_ring_is_the_radial_stretch(self):
        record = self.record("map", self.source, "--onto", self.target, "-o", self.path("out.obj"))
        exact = math.log(0.3) / math.log(0.5)
        self.assertAlmostEqual(record["map"]["K"], exact, delta=0.005)
        self.assertEqual(record["map"]["flipped"], 0)
        onto = record["onto"]
        self.assertEqual((onto["dimension"], onto["expected_dimension"]), (1, 1))
        self.assertEqual([loop["curve"] for loop in onto["loops"]], [0, 1])
        for loop, described in zip(onto["loops"], record["source"]["loops"]):
            self.assertEqual(len(loop["parameters"]), described["vertices"])
            self.assertTrue(all(a < b for a, b in zip(loop["parameters"], loop["parameters"][1:])))
        v, vt, f = read_obj(self.path("out.obj"))
        self.assertTrue((f == self.faces).all())
        np.testing.assert_allclose(v[:, :2], self.points, atol=1e-12)
        radii = np.linalg.norm(vt, axis=1)
        source_radii = np.linalg.norm(self.points, axis=1)
        np.testing.assert_allclose(radii[source_radii > 1 - 1e-9], 1, atol=1e-12)
        np.testing.assert_allclose(radii[source_radii < self.inner + 1e-9], 0.3, atol=1e-12)
        mu, area = abs_mu(np.column_stack([self.points, np.zeros(len(self.points))]), vt, self.faces)
        self.assertLess(mu.max(), 1)
        self.assertAlmostEqual((mu * area).sum() / area.sum(), record["map"]["mu"]["mean"], delta=1e-9)

    def test_the_terminal_says_loops_dimension_and_bracket(self):
        text = self.run_command("map", self.source, "--onto", self.target, "-o", self.path("out.obj")).stdout
        self.assertIn("loops: 0:0 1:1; differentials: dimension 1 (theory 1); bracket of K*:", text)
        self.assertIn("(estimate; proved: K = 1.73", text)

    def test_rectangle_by_marks_is_the_affine_map(self):
        n = 8
        points = np.array([(i / n, j / n) for j in range(n + 1) for i in range(n + 1)])
        faces = []
        for j in range(n):
            for i in range(n):
                a = j * (n + 1) + i
                faces += [(a, a + 1, a + n + 2), (a, a + n + 2, a + n + 1)]
        write_obj(self.path("square.obj"), points, np.array(faces))
        target = domain(self.path("rectangle.json"), {"polygon": [[0, 0], [2, 0], [2, 1], [0, 1]]})
        corners = {0: (0, 0), n: (2, 0), (n + 1) ** 2 - 1: (2, 1), n * (n + 1): (0, 1)}
        pathlib.Path(self.path("marks.txt")).write_text("".join(f"{v} {x} {y}\n" for v, (x, y) in corners.items()))
        record = self.record("map", self.path("square.obj"), "--onto", target, "--marks", self.path("marks.txt"),
                             "-o", self.path("out.obj"))
        self.assertAlmostEqual(record["map"]["K"], 2, delta=1e-6)
        self.assertEqual(record["onto"]["space"], "one_form_squares")
        _, vt, _ = read_obj(self.path("out.obj"))
        # Two corners had ears, which are split; added vertices follow.
        self.assertEqual(len(vt), len(points) + record["split"]["edges"])
        np.testing.assert_allclose(vt[: len(points)], points * [2, 1], atol=1e-6)

    def test_a_mesh_as_the_target(self):
        points, faces = ring(40, 8, 0.3)
        z = 0.2 * (points**2).sum(axis=1)
        write_obj(self.path("bowl.obj"), np.column_stack([points, z]), faces)
        record = self.record("map", self.source, "--onto", self.path("bowl.obj"), "-o", self.path("out.obj"),
                             "--places", self.path("places.txt"))
        self.assertEqual(record["map"]["flipped"], 0)
        v, vt, f = read_obj(self.path("out.obj"))
        # Vertices stand on the bowl, up to its faces being flat.
        self.assertLess(np.abs(v[:, 2] - 0.2 * (v[:, :2] ** 2).sum(axis=1)).max(), 0.01)
        rows = np.loadtxt(self.path("places.txt"))
        self.assertEqual(len(rows), len(self.points))
        bowl = np.column_stack([points, z])
        corners = rows[:, 2:5].astype(int)
        found = (bowl[corners] * rows[:, 5:8, None]).sum(axis=1)
        np.testing.assert_allclose(found, v, atol=1e-12)
        self.assertEqual(sorted(corners[7]), sorted(faces[int(rows[7, 1])]))
        measured = self.record("measure", self.source, self.path("out.obj"))
        self.assertEqual(measured["map"]["flipped"], 0)
        self.assertAlmostEqual(measured["map"]["mu"]["mean"], record["map"]["k"], delta=0.03)

    def test_waypoints_and_loops_make_the_class(self):
        points, faces = disk_with_holes(32, [((-0.35, 0.25), 0.13), ((0.35, 0.25), 0.13), ((0, -0.5), 0.15)])
        write_obj(self.path("three.obj"), points, faces)
        loops = self.record("info", self.path("three.obj"))["source"]["loops"]
        at = lambda loop: points[loops[loop]["first_vertex"]]
        left = min((1, 2, 3), key=lambda l: at(l)[0])
        right = max((1, 2, 3), key=lambda l: at(l)[0])
        below = min((1, 2, 3), key=lambda l: at(l)[1])
        self.assertEqual(len({left, right, below}), 3)
        target = domain(self.path("swapped.json"), {"circle": [0, 0, 1]},
                        [{"circle": [0.35, 0.25, 0.13]}, {"circle": [-0.35, 0.2, 0.15]}, {"circle": [0.1, -0.5, 0.15]}])
        found = []
        for sign in (1, -1):
            pathlib.Path(self.path("way.txt")).write_text(
                f"1 {left} 0 {0.25 - 0.25 * sign}\n1 {right} 0 {0.25 + 0.25 * sign}\n")
            record = self.record("map", self.path("three.obj"), "--onto", target, "--loops",
                                 f"0:0,{left}:1,{right}:2,{below}:3", "--waypoints", self.path("way.txt"),
                                 "-o", self.path("out.obj"))
            self.assertTrue(record["onto"]["led"])
            self.assertEqual(len(record["onto"]["path"]), 2)
            self.assertEqual(record["map"]["flipped"], 0)
            found.append(record["map"]["k"])
            # A start has the class of its own map, noise or not.
            v, vt, f = read_obj(self.path("out.obj"))
            turn = 7.0 * np.arange(len(vt)) ** 2
            write_obj(self.path("start.obj"), v, f, vt + 0.01 * np.column_stack([np.cos(turn), np.sin(turn)]))
            again = self.record("map", self.path("three.obj"), "--onto", target, "--loops",
                                f"0:0,{left}:1,{right}:2,{below}:3", "--start-map", self.path("start.obj"),
                                "-o", self.path("again.obj"))
            self.assertEqual(again["map"]["flipped"], 0)
            self.assertEqual(again["warnings"], [])
            self.assertAlmostEqual(again["map"]["k"], found[-1], delta=1e-4)
        self.assertGreater(abs(found[0] - found[1]), 1e-3)


class Compare(WithRing):
    def test_the_papers_scheme_beside_the_extremal_map(self):
        record = self.record("map", self.source, "--onto", self.target, "-o", self.path("out.obj"), "--compare", "t-map",
                             "--report", self.path("out.html"))
        exact = (math.log(0.3) / math.log(0.5) - 1) / (math.log(0.3) / math.log(0.5) + 1)
        (line,) = record["comparison"]
        self.assertEqual(line["method"], "t-map")
        self.assertEqual(line["map"]["flipped"], 0)
        self.assertAlmostEqual(line["map"]["mu"]["mean"], exact, delta=0.01)
        self.assertGreater(line["solve"]["iterations"], record["solve"]["iterations"])
        self.assertNotIn("k", line["map"])
        self.assertIn("t-map", pathlib.Path(self.path("out.html")).read_text())
        text = self.run_command("map", self.source, "--onto", self.target, "-o", self.path("out.obj"), "--compare",
                                "t-map").stdout
        self.assertTrue(any(row.startswith("t-map ") for row in text.splitlines()))

    def test_onto_a_mesh_with_marks(self):
        points, faces = ring(40, 8, 0.3)
        write_obj(self.path("other.obj"), points, faces)
        loops = self.record("info", self.source)["source"]["loops"], self.record("info", self.path("other.obj"))["source"]["loops"]
        pathlib.Path(self.path("marks.txt")).write_text(f"{loops[0][0]['first_vertex']} {loops[1][0]['first_vertex'] + 10}\n")
        record = self.record("map", self.source, "--onto", self.path("other.obj"), "--mark-vertices",
                             self.path("marks.txt"), "-o", self.path("out.obj"), "--compare", "t-map")
        (line,) = record["comparison"]
        # The mark holds the rotation only: k stays that of the ring.
        self.assertAlmostEqual(line["map"]["mu"]["mean"], record["map"]["k"], delta=0.02)


class Mistakes(WithRing):
    def fails(self, *arguments):
        before = sorted(p.name for p in self.folder.iterdir())
        done = self.run_command("map", self.source, "-o", self.path("out.obj"), *arguments, code=2)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), before)
        return done.stderr

    def test_options_that_do_not_go_together(self):
        self.assertIn("--certify", self.fails("--onto", self.target, "--boundary", "disk", "--certify", "1"))
        self.assertIn("--turns", self.fails("--onto", self.target, "--turns", "1=1"))
        self.assertIn("--loops belongs to --onto", self.fails("--loops", "0:0", "--boundary", "disk"))
        self.assertIn("--loops 0:x", self.fails("--onto", self.target, "--loops", "0:x"))
        self.assertIn("--places", self.fails("--onto", self.target, "--places", self.path("p.txt")))
        self.assertIn("--compare harmonic", self.fails("--onto", self.target, "--compare", "t-map,harmonic"))
        self.assertIn("--compare t-map belongs to --onto", self.fails("--boundary", "disk", "--compare", "t-map"))
        self.assertIn("--compare", self.fails("--onto", self.target, "--compare", "tmap"))
        self.assertIn("--certify", self.fails("--onto", self.target, "--certify", "1"))

    def test_domains_that_are_wrong(self):
        bad = domain(self.path("bad.json"), {"circle": [0, 0, -1]})
        self.assertIn("bad.json", self.fails("--onto", bad))
        meeting = domain(self.path("meet.json"), {"circle": [0, 0, 1]}, [{"circle": [0.9, 0, 0.3]}])
        self.assertIn("hole 0", self.fails("--onto", meeting))

    def test_numbers_of_holes_must_agree(self):
        none = domain(self.path("disk.json"), {"circle": [0, 0, 1]})
        done = self.run_command("map", self.source, "--onto", none, "-o", self.path("out.obj"), code=5)
        self.assertIn("2 boundary loops, the target 1", done.stderr)


class Distances(Command):
    def rings(self, inner):
        files = []
        for i, r in enumerate(inner):
            points, faces = ring(40, 8, r)
            write_obj(self.path(f"ring{i}.obj"), points, faces)
            files.append(self.path(f"ring{i}.obj"))
        return files

    def test_rings_lie_on_a_line(self):
        inner = [0.3, 0.33, 0.6]
        files = self.rings(inner)
        record = self.record("distance", *files, "--picture", self.path("tree.svg"))
        distances = record["distances"]
        d = np.array(distances["distance"])
        np.testing.assert_array_equal(d, d.T)
        np.testing.assert_array_equal(np.diag(d), 0)
        logs = [math.log(-math.log(r)) for r in inner]
        for i in range(3):
            for j in range(3):
                self.assertAlmostEqual(d[i, j], abs(logs[i] - logs[j]) / 2, delta=2e-3)
        self.assertTrue((np.array(distances["lower"]) <= d).all())
        self.assertTrue((np.array(distances["upper"]) >= d).all())
        self.assertEqual(distances["merges"][0]["clusters"], [0, 1])
        self.assertEqual(distances["merges"][1]["clusters"], [2, 3])
        picture = pathlib.Path(self.path("tree.svg")).read_text()
        self.assertTrue(picture.startswith("<svg") and picture.endswith("</svg>\n"))
        for i in range(3):
            self.assertIn(f">ring{i}<", picture)

    def test_two_shapes_in_words(self):
        text = self.run_command("distance", *self.rings([0.3, 0.5])).stdout
        self.assertRegex(text, r"ring0\.obj .*ring1\.obj: 0\.27\d+ \(between 0\.\d+ and 0\.\d+\), K = 1\.7\d+")

    def test_shapes_must_be_alike(self):
        points, faces = disk(6)
        write_obj(self.path("disk.obj"), points, faces)
        done = self.run_command("distance", self.path("disk.obj"), *self.rings([0.3]), code=5)
        self.assertIn("compare shapes with the same number of holes", done.stderr)


@unittest.skipUnless(MESHES.is_dir() and (MESHES / "alex_3.obj").exists(), "no folder of real scans")
class Scans(Command):
    def test_a_face_with_three_holes(self):
        target = domain(self.path("target.json"), {"circle": [0, 0, 1]},
                        [{"circle": [0.1, 0.1, 0.15]}, {"circle": [-0.5, -0.5, 0.15]}, {"circle": [-0.55, 0.3, 0.15]}])
        record = self.record("map", MESHES / "alex_3.obj", "--onto", target, "-o", self.path("out.obj"))
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertEqual(record["onto"]["dimension"], 6)
        self.assertLess(record["onto"]["K_upper"] / record["map"]["K_lower"], 1.03)

    def test_an_amoeba(self):
        target = domain(self.path("target.json"), {"circle": [0, 0, 1]}, [{"circle": [0.2, 0.1, 0.3]}])
        record = self.record("map", MESHES / "amoeba1.obj", "--onto", target, "-o", self.path("out.obj"))
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertLess(record["onto"]["K_upper"] / record["map"]["K_lower"], 1.03)


if __name__ == "__main__":
    unittest.main()
