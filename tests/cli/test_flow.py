"""beltrami flow: maps with a given Beltrami coefficient."""

import json
import math
import pathlib
import unittest

import numpy as np

from support import MESHES, Command, bump, disk, read_obj, ring, write_obj


def coefficients(points, image, faces):
    """∂̄f/∂f on every triangle of the plane, in the frame of the plane."""
    z, w = points @ [1, 1j], image @ [1, 1j]
    a, b, c = (faces[:, i] for i in range(3))
    gradient = [1j * (z[q] - z[p]) for p, q in ((b, c), (c, a), (a, b))]  # of the hat functions, by twice the area
    bar = sum(w[v] * g for v, g in zip((a, b, c), gradient))
    plain = sum(w[v] * np.conj(g) for v, g in zip((a, b, c), gradient))
    return bar / plain


def write_rows(path, values):
    pathlib.Path(path).write_text("# face re im\n" + "".join(f"{f} {m.real!r} {m.imag!r}\n"
                                                              for f, m in enumerate(map(complex, values))))
    return path


class Prescribed(Command):
    def setUp(self):
        super().setUp()
        self.points, self.faces = disk(12)
        self.source = self.path("disk.obj")
        write_obj(self.source, self.points, self.faces)
        z = self.points @ [1, 1j]
        w = z + 0.2 * np.conj(z) ** 2 + 0.1 * z**2
        self.image = np.column_stack([w.real, w.imag])
        self.mu = coefficients(self.points, self.image, self.faces)
        self.assertLess(np.abs(self.mu).max(), 0.6)
        rim = np.nonzero(np.linalg.norm(self.points, axis=1) > 1 - 1e-9)[0]
        self.pins = self.path("pins.txt")
        pathlib.Path(self.pins).write_text("".join(f"{v} {self.image[v][0]!r} {self.image[v][1]!r}\n" for v in rim))
        self.out = self.path("out.obj")

    def flow(self, mu, *arguments, **more):
        return self.record("flow", self.source, "--mu", mu, "-o", self.out, *arguments, **more)

    def test_a_map_is_found_by_its_coefficient(self):
        record = self.flow(write_rows(self.path("mu.txt"), self.mu), "--pin", self.pins)
        _, vt, _ = read_obj(self.out)
        np.testing.assert_allclose(vt, self.image, atol=1e-11)
        self.assertLess(record["flow"]["error"]["sup"], 1e-9)
        self.assertTrue(record["flow"]["fits"])
        self.assertEqual(record["solve"]["termination"], "converged")
        self.assertEqual(record["warnings"], [])
        self.assertAlmostEqual(record["map"]["mu"]["max"], np.abs(self.mu).max(), delta=1e-9)

    def test_the_frame_of_the_first_edges(self):
        edge = (self.points[self.faces[:, 1]] - self.points[self.faces[:, 0]]) @ [1, 1j]
        turned = write_rows(self.path("mu.txt"), self.mu * np.exp(-2j * np.angle(edge)))
        self.flow(turned, "--pin", self.pins, "--mu-frame", "first-edge")
        np.testing.assert_allclose(read_obj(self.out)[1], self.image, atol=1e-11)
        # The same surface in space has no other frame.
        tilt = np.array([[1, 0, 0], [0, 0.6, 0.8]])
        write_obj(self.path("tilted.obj"), self.points @ tilt, self.faces)
        self.source = self.path("tilted.obj")
        for frame in ("samples", "first-edge"):
            self.flow(turned, "--pin", self.pins, "--mu-frame", frame)
            np.testing.assert_allclose(read_obj(self.out)[1], self.image, atol=1e-11)
        text = self.run_command("flow", self.source, "--mu", turned, "-o", self.out, "--pin", self.pins, "--mu-frame",
                                "plane", code=2).stderr
        self.assertIn("plane", text)

    def test_a_map_that_was_written_comes_back(self):
        first = self.path("first.ply")
        self.record("map", self.source, "--boundary", "disk:0.5", "-o", first)
        pinned = self.record("flow", self.source, "--mu", first, "--boundary", "disk:0.5", "-o", self.out)
        self.assertLess(pinned["flow"]["error"]["sup"], 1e-9)
        self.run_command("flow", self.source, "--mu", first, "--boundary", "disk:0.5", "-o", self.path("second.ply"))
        again = self.record("flow", self.source, "--mu", self.path("second.ply"), "--boundary", "disk:0.5", "-o", self.out)
        self.assertAlmostEqual(again["map"]["mu"]["max"], pinned["map"]["mu"]["max"], delta=1e-9)

    def test_other_boundary_values_are_said_not_to_fit(self):
        record = self.flow(write_rows(self.path("mu.txt"), self.mu), "--boundary", "disk:0.5")
        self.assertFalse(record["flow"]["fits"])
        self.assertIn("not those of a map with this coefficient", record["warnings"][0])
        self.assertGreater(record["flow"]["error"]["l2"], 0.1)

    def test_free_parts_are_warned_of(self):
        lines = pathlib.Path(self.pins).read_text().splitlines()
        pathlib.Path(self.pins).write_text("\n".join(lines[::7]) + "\n")
        record = self.flow(write_rows(self.path("mu.txt"), self.mu), "--pin", self.pins)
        np.testing.assert_allclose(read_obj(self.out)[1], self.image, atol=1e-9)
        self.assertIn("boundary vertices are free", record["warnings"][0])

    def test_mistakes(self):
        good = write_rows(self.path("mu.txt"), self.mu)

        def refused(code, *arguments, says):
            text = self.run_command("flow", self.source, "-o", self.out, *arguments, code=code).stderr
            self.assertIn(says, text)

        short = write_rows(self.path("short.txt"), self.mu[:-2])
        refused(3, "--mu", short, "--pin", self.pins, says=f"no coefficient of face {len(self.mu) - 2}")
        more = write_rows(self.path("more.txt"), list(self.mu) + [0])
        refused(3, "--mu", more, "--pin", self.pins, says=f"{len(self.mu)} of a coefficient of a face is not an")
        twice = self.path("twice.txt")
        pathlib.Path(twice).write_text(pathlib.Path(good).read_text() + "3 0 0\n")
        refused(3, "--mu", twice, "--pin", self.pins, says="names face 3 twice")
        large = self.mu.copy()
        large[5] = 1
        refused(3, "--mu", write_rows(self.path("large.txt"), large), "--pin", self.pins, says="face 5 has |μ| = 1")
        refused(2, "--mu", good, "--pin", self.pins, "--mu-frame", "second-edge", says="--mu-frame")
        refused(2, "--mu", good, says="does not say where the boundary goes")
        refused(2, "--pin", self.pins, says="--mu")
        refused(2, "--mu", good, "--pin", self.pins, "--start-map", self.source, says="one linear solve")
        refused(2, "--mu", good, "--pin", self.pins, "--marks", self.pins, says="--marks belongs to --onto")
        refused(2, "--mu", good, "--pin", self.pins, "--onto", self.path("x.json"), says="the boundary slides")
        self.assertFalse(pathlib.Path(self.out).exists())

    def test_terminal_and_page(self):
        text = self.run_command("flow", self.source, "--mu", write_rows(self.path("mu.txt"), self.mu), "-o", self.out,
                                "--pin", self.pins, "--report", self.path("page.html")).stdout
        self.assertIn("coefficient: off by", text)
        self.assertIn("</html>", pathlib.Path(self.path("page.html")).read_text())


class Sliding(Command):
    """The radial stretch z|z|^(a-1) of a ring, whose coefficient is (a-1)/(a+1) z/z̄."""

    def setUp(self):
        super().setUp()
        self.points, self.faces = ring(72, 20, 0.5)
        self.source, self.out = self.path("ring.obj"), self.path("out.obj")
        write_obj(self.source, self.points, self.faces)
        self.a = math.log(0.3) / math.log(0.5)
        middle = self.points[self.faces].mean(axis=1) @ [1, 1j]
        self.mu = write_rows(self.path("mu.txt"), (self.a - 1) / (self.a + 1) * middle / np.conj(middle))
        self.exact = self.points * (np.linalg.norm(self.points, axis=1) ** (self.a - 1))[:, None]
        self.target = self.domain(0.3)

    def domain(self, inner):
        path = self.path(f"target_{inner}.json")
        pathlib.Path(path).write_text(json.dumps({"outer": {"circle": [0, 0, 1]},
                                                  "holes": [{"circle": [0, 0, inner]}]}))
        return path

    def error(self):
        """Largest distance from the exact map, up to the turn that is free."""
        z, w = self.exact @ [1, 1j], read_obj(self.out)[1] @ [1, 1j]
        turn = np.vdot(w, z)
        return np.abs(w * turn / abs(turn) - z).max()

    def test_onto_a_ring(self):
        record = self.record("flow", self.source, "--mu", self.mu, "--onto", self.target, "-o", self.out)
        self.assertLess(self.error(), 1e-3)
        self.assertTrue(record["flow"]["fits"])
        self.assertEqual(record["solve"]["termination"], "converged")
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertEqual([l["curve"] for l in record["flow"]["loops"]], [0, 1])
        self.assertEqual(record["flow"]["target"], self.target)

    def test_a_ring_of_another_module_does_not_fit(self):
        record = self.record("flow", self.source, "--mu", self.mu, "--onto", self.domain(0.5), "-o", self.out)
        self.assertFalse(record["flow"]["fits"])
        self.assertIn("does not belong to a map onto this target", record["warnings"][0])

    def test_the_start_does_not_matter_but_for_steps(self):
        arguments = ("flow", self.source, "--mu", self.mu, "--onto", self.target, "-o", self.out)
        self.record(*arguments)
        first = read_obj(self.out)[1]
        # From a folded start it takes its steps, from its own end one.
        rng = np.random.default_rng(1)
        inside = np.arange(72, len(first) - 72)  # the rims are the first and the last layer
        angle = np.arctan2(first[:, 1], first[:, 0])
        slid = first @ [1, 1j] * np.exp(0.3j * np.sin(angle))
        start = np.column_stack([slid.real, slid.imag])
        start[inside] += 0.03 * rng.standard_normal((len(inside), 2))
        write_obj(self.path("start.obj"), self.points, self.faces, start)
        self.assertGreater(self.record("measure", self.path("start.obj"))["map"]["flipped"], 10)
        folded = self.record(*arguments, "--start-map", self.path("start.obj"))
        self.assertEqual(folded["map"]["flipped"], 0)
        self.assertGreater(folded["solve"]["iterations"], 2)
        self.assertLess(self.error(), 1e-3)
        end = read_obj(self.out)[1]
        write_obj(self.path("start.obj"), self.points, self.faces, end)
        again = self.record(*arguments, "--start-map", self.path("start.obj"))
        self.assertEqual(again["solve"]["iterations"], 1)
        np.testing.assert_allclose(read_obj(self.out)[1], end, atol=1e-9)

    def test_onto_a_mesh(self):
        points, faces = ring(120, 36, 0.3)
        n = (points**2).sum(axis=1)
        sphere = np.column_stack([2 * points / (1 + n)[:, None], (n - 1) / (1 + n)])
        write_obj(self.path("sphere.obj"), sphere, faces)
        record = self.record("flow", self.source, "--mu", self.mu, "--onto", self.path("sphere.obj"), "-o", self.out,
                             "--places", self.path("places.txt"))
        self.assertTrue(record["flow"]["fits"])
        v, _, _ = read_obj(self.out)
        self.assertLess(np.abs(np.linalg.norm(v, axis=1) - 1).max(), 0.01)
        self.assertEqual(len(np.loadtxt(self.path("places.txt"))), len(self.points))

    def test_marks_stay_in_their_places(self):
        marked = int(np.argmax(self.points @ [0.6, 0.8]))
        place = np.array([math.cos(0.9), math.sin(0.9)])
        pathlib.Path(self.path("marks.txt")).write_text(f"{marked} {place[0]!r} {place[1]!r}\n")
        arguments = ("flow", self.source, "--mu", self.mu, "--onto", self.target, "-o", self.out, "--marks",
                     self.path("marks.txt"))
        self.record(*arguments)
        first = read_obj(self.out)[1]
        np.testing.assert_allclose(first[marked], place, atol=1e-9)
        write_obj(self.path("start.obj"), self.points, self.faces, self.exact)
        self.record(*arguments, "--start-map", self.path("start.obj"))
        np.testing.assert_allclose(read_obj(self.out)[1], first, atol=1e-8)

    def test_a_start_whose_boundary_is_out_of_order(self):
        arguments = ("flow", self.source, "--mu", self.mu, "--onto", self.target, "-o", self.out, "--start-map",
                     self.path("start.obj"))
        write_obj(self.path("start.obj"), self.points, self.faces, self.exact)
        self.record(*arguments)
        first = read_obj(self.out)[1]
        jumbled = self.exact.copy()
        jumbled[[3, 7]] = jumbled[[7, 3]]
        write_obj(self.path("start.obj"), self.points, self.faces, jumbled)
        record = self.record(*arguments)
        self.assertEqual(record["map"]["flipped"], 0)
        np.testing.assert_allclose(read_obj(self.out)[1], first, atol=1e-4)

    def test_mistakes(self):
        base = ("flow", self.source, "--mu", self.mu, "--onto", self.target, "-o", self.out)

        def refused(code, *arguments, says):
            self.assertIn(says, self.run_command(*base, *arguments, code=code).stderr)

        refused(2, "--step", "0", says="step of the flow")
        refused(2, "--step", "1.5", says="step of the flow")
        refused(2, "--tolerance", "-1", says="--tolerance")
        refused(2, "--max-iterations", "0", says="--max-iterations")
        refused(4, "--start-map", self.source, says="no texture coordinates")
        write_obj(self.path("backwards.obj"), self.points, self.faces, self.exact * [1, -1])
        refused(5, "--start-map", self.path("backwards.obj"), says="keeps the order of the boundary vertices")
        points, faces = ring(24, 4, 0.5)
        write_obj(self.path("other.obj"), points, faces, points)
        refused(4, "--start-map", self.path("other.obj"), says="another mesh than SOURCE: it has 120 vertices")
        turned = np.roll(self.faces, 1, axis=1)
        write_obj(self.path("turned.obj"), self.points, turned, self.exact)
        refused(4, "--start-map", self.path("turned.obj"), says="face 0 has other vertices")
        refused(2, "--start-map", self.path("turned.obj"), "--loops", "0:0", says="leave one of them out")
        self.assertFalse(pathlib.Path(self.out).exists())
        limited = self.record(*base, "--max-iterations", "1")
        self.assertEqual(limited["solve"]["termination"], "iteration_limit")
        self.assertEqual(limited["solve"]["iterations"], 1)
        self.assertIn("before the map settled", limited["warnings"][0])


def octahedral_sphere(levels):
    """Points and triangles of the unit sphere; 0, 1 and ∞ of the stereographic coordinate are the vertices 4, 0 and 5."""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    points = [np.array(p, float) for p in points]
    for _ in range(levels):
        middle, more = {}, []

        def between(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(points)
                sum_ = points[a] + points[b]
                points.append(sum_ / np.linalg.norm(sum_))
            return middle[key]

        for a, b, c in faces:
            ab, bc, ca = between(a, b), between(b, c), between(c, a)
            more += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = more
    return np.array(points), np.array(faces)


class AlongSurface(Command):
    def setUp(self):
        super().setUp()
        self.points, self.faces = octahedral_sphere(3)
        self.source, self.out = self.path("sphere.obj"), self.path("out.ply")
        write_obj(self.source, self.points, self.faces)
        self.mu = write_rows(self.path("mu.txt"), np.full(len(self.faces), 0.3 + 0.3j))
        self.pins = self.path("pins.txt")
        pathlib.Path(self.pins).write_text("0 1 0 0\n4 0 0 1\n5 0 0 -1\n")

    def test_a_coefficient_in_the_stereographic_frame(self):
        record = self.record("flow", self.source, "--onto", "sphere", "--mu", self.mu, "--mu-frame", "stereographic",
                             "--pin", self.pins, "--scheme", "perturbation", "-o", self.out)
        flow = record["surface_flow"]
        self.assertEqual(flow["start"], "identity")
        self.assertEqual(flow["held"], 3)
        self.assertEqual(record["solve"]["termination"], "converged")
        history = flow["history"]
        self.assertEqual(len(history["squared"]), record["solve"]["iterations"])
        self.assertEqual(set(history["scheme"]), {"perturbation"})
        self.assertEqual(history["flips"][-1], 0)
        self.assertAlmostEqual(history["squared"][-1], 0.146, delta=0.002)  # beside the paper's .1145
        self.assertLess(record["map"]["mu"]["max"], 1)

    def test_a_map_comes_back_from_the_coefficient_that_was_written(self):
        z = (self.points[:, 0] + 1j * self.points[:, 1]) / np.maximum(1 + self.points[:, 2], 1e-300)
        w = (z + 0.2 * np.conj(z)) / 1.2
        images = np.column_stack([2 * w.real, 2 * w.imag, 1 - np.abs(w) ** 2]) / (1 + np.abs(w) ** 2)[:, None]
        images[5] = [0, 0, -1]
        write_obj(self.path("images.obj"), images, self.faces)
        first = self.path("first.ply")
        # All vertices but one are held, so that this map is the given one but for that vertex.
        self.record("flow", self.source, "--onto", "sphere", "--minimize-lp", "2", "--start-map", self.path("images.obj"),
                    "--max-iterations", "1", "--pin", self.all_pins(images), "-o", first)
        record = self.record("flow", self.source, "--onto", "sphere", "--mu", first, "--pin", self.pins, "-o", self.out)
        self.assertLess(record["surface_flow"]["error"]["sup"], 1e-6)
        self.assertTrue(record["surface_flow"]["fits"])

    def all_pins(self, images):
        path = self.path("all.txt")
        pathlib.Path(path).write_text("".join(f"{v} {x!r} {y!r} {z!r}\n" for v, (x, y, z) in enumerate(images.tolist()) if v != 1))
        return path

    def test_least_distortion_onto_a_mesh_with_places(self):
        points, faces = octahedral_sphere(4)
        write_obj(self.path("target.obj"), points * [1, 1, 1.5], faces)
        places = self.path("places.txt")
        record = self.record("flow", self.source, "--onto", self.path("target.obj"), "--minimize-lp", "2", "-o", self.out,
                             "--places", places)
        flow = record["surface_flow"]
        self.assertEqual(flow["start"], "conformal")
        self.assertEqual(flow["minimized"], {"p": 2, "weight": "area"})
        self.assertEqual(flow["history"]["flips"][-1], 0)
        self.assertLess(record["map"]["mu"]["mean"], 0.1)
        rows = [line.split() for line in pathlib.Path(places).read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(len(rows), len(self.points))

    def test_tori(self):
        nu, nv = 32, 16
        u, v = (2 * np.pi * a.ravel() for a in np.meshgrid(np.arange(nu) / nu, np.arange(nv) / nv, indexing="ij"))
        points = np.column_stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)])
        at = lambda i, j: (i % nu) * nv + j % nv
        faces = [f for i in range(nu) for j in range(nv)
                 for f in [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]]
        write_obj(self.path("torus.obj"), points, np.array(faces))
        by = {}
        for weight in ("area", "phi"):
            record = self.record("flow", self.path("torus.obj"), "--onto", "modified-torus:1", "--minimize-lp", "2",
                                 "--weight", weight, "-o", self.out)
            self.assertEqual(record["surface_flow"]["start"], "lattice")
            self.assertEqual(record["surface_flow"]["history"]["flips"][-1], 0)
            by[weight] = record["map"]["mu"]
        self.assertAlmostEqual(by["phi"]["mean"], 0.0929, delta=0.006)
        self.assertLess(by["phi"]["std"], 0.5 * by["area"]["std"])

    def test_a_ring_of_another_module_is_named(self):
        points, faces = ring(64, 16, 0.4)
        write_obj(self.path("ring.obj"), points, faces)
        z = points[faces].mean(axis=1) @ [1, 1j]
        mu = write_rows(self.path("ring.txt"), 0.6 * z**3)
        domain = self.path("ring.json")
        pathlib.Path(domain).write_text(json.dumps({"outer": {"circle": [0, 0, 1]}, "holes": [{"circle": [0, 0, 0.4]}]}))
        for boundary in ([], ["--boundary", "tangential"]):
            record = self.record("flow", self.path("ring.obj"), "--onto", domain, "--mu", mu, "-o", self.out, *boundary)
            said = [w for w in record["warnings"] if "module" in w]
            self.assertEqual(len(said), 1)
            self.assertIn("module 0.869", said[0])

    def test_mistakes(self):
        def refused(code, *arguments, says):
            text = self.run_command("flow", self.source, *arguments, "-o", self.out, code=code).stderr
            self.assertIn(says, text)

        sphere = ["--onto", "sphere"]
        refused(2, *sphere, says="give one of --mu and --minimize-lp")
        refused(2, *sphere, "--mu", self.mu, "--minimize-lp", "2", says="two different maps")
        refused(2, "--minimize-lp", "2", says="give --onto TARGET")
        refused(2, *sphere, "--minimize-lp", "1", says="--minimize-lp")
        refused(2, *sphere, "--mu", self.mu, "--mu-frame", "sideways", says="--mu-frame")
        refused(2, *sphere, "--minimize-lp", "2", "--weight", "phi", says="genus 1")
        refused(2, *sphere, "--minimize-lp", "2", "--boundary", "disk", says="fixed, tangential or free")
        refused(2, *sphere, "--minimize-lp", "2", "--loops", "0:0", says="--loops")
        refused(2, *sphere, "--minimize-lp", "2", "--step", "0.5", says="--step")
        refused(2, "--onto", "torus:1", "--minimize-lp", "2", says="torus:R,r")
        refused(2, "--onto", "torus:1,2", "--minimize-lp", "2", says="R > r > 0")
        refused(2, "--onto", "torus:2,1", "--minimize-lp", "2", says="--start-map")
        refused(2, *sphere, "--minimize-lp", "2", "--boundary", "tangential", "--scheme", "fast", says="--scheme")
        refused(2, *sphere, "--minimize-lp", "2", "--boundary", "tangential", says="SOURCE is closed")
        short = write_rows(self.path("short.txt"), np.zeros(5))
        refused(3, *sphere, "--mu", short, says="short.txt")
        large = write_rows(self.path("large.txt"), np.full(len(self.faces), 1.0))
        refused(3, *sphere, "--mu", large, says="large.txt")
        pathlib.Path(self.pins).write_text("0 1 0\n")
        refused(3, *sphere, "--minimize-lp", "2", "--pin", self.pins, says="pins.txt")
        pathlib.Path(self.pins).write_text("0 1 0 0\n0 1 0 0\n")
        refused(5, *sphere, "--minimize-lp", "2", "--pin", self.pins, says="held twice")
        self.assertFalse(pathlib.Path(self.out).exists())


class WithCurves(Command):
    """Curves that go to curves, and starts that need no --start-map."""

    def setUp(self):
        super().setUp()
        self.points, self.faces = octahedral_sphere(4)
        x, y, z = self.points.T
        self.bumpy = self.points * (1 + 0.2 * np.sin(3 * x + y) + 0.1 * z)[:, None]
        self.source, self.out = self.path("bumpy.obj"), self.path("out.obj")
        write_obj(self.source, self.bumpy, self.faces)

    def near(self, *direction):
        return int((self.points @ (np.array(direction) / np.linalg.norm(direction))).argmax())

    def curves(self, *blocks):
        text = ""
        for mode, here, there in blocks:
            text += f"curve {mode}\n" + "".join(f"{v}\n" for v in here) + "onto\n"
            text += "".join((f"{v}" if np.ndim(v) == 0 else " ".join(map(repr, map(float, v)))) + "\n" for v in there)
        pathlib.Path(self.path("curves.txt")).write_text(text)
        return self.path("curves.txt")

    def flow(self, *arguments):
        return self.record("flow", *arguments, "-o", self.out)

    def test_to_arcs_of_great_circles(self):
        arcs = (("slide", [self.near(1, 0, .4), self.near(.5, .8, .5), self.near(-.3, 1, .2)],
                 [(1, 0, .3), (.6, .8, .3), (-.3, 1, .3)]),
                ("fixed", [self.near(1, .2, -.6), self.near(-.4, .9, -.6)], [(1, .1, -.5), (-.2, 1, -.5)]),
                ("slide", [self.near(-1, -.4, .5), self.near(-.4, -1, -.2)], [(-1, -.3, .4), (-.3, -1, -.3)]))
        means = []
        for count in (1, 2, 3):
            curves = self.curves(*arcs[:count])
            record = self.flow(self.source, "--onto", "sphere", "--minimize-lp", "2", "--curves", curves)
            flow = record["surface_flow"]
            self.assertEqual(flow["start"], "cut along curves")
            self.assertFalse(any("the start" in warning for warning in record["warnings"]))
            self.assertEqual(flow["history"]["flips"][-1], 0)
            self.assertEqual(record["map"]["flipped"], 0)
            means.append(record["map"]["mu"]["mean"])
            out = read_obj(self.out)[0]
            for mode, here, there in arcs[:count]:
                ends = [np.array(there[i]) / np.linalg.norm(there[i]) for i in (0, -1)]
                for v, end in zip((here[0], here[-1]), ends):
                    np.testing.assert_allclose(out[v], end, atol=1e-9)
        self.assertLess(means[0], means[2])

    def test_onto_a_mesh_in_space(self):
        write_obj(self.path("target.obj"), self.bumpy[:, [1, 2, 0]] * [1, 1.2, 1], self.faces)
        here, there = [self.near(1, .1, 0), self.near(.1, 1, .3)], [self.near(.2, .9, .4), self.near(-.9, .3, .2)]
        for boundary in ([], ["--scheme", "barrier"]):
            record = self.flow(self.source, "--onto", self.path("target.obj"), "--minimize-lp", "2", "--curves",
                               self.curves(("slide", here, there)), "--places", self.path("places.txt"), *boundary)
            self.assertEqual(record["map"]["flipped"], 0)
        target = self.bumpy[:, [1, 2, 0]] * [1, 1.2, 1]
        out = read_obj(self.out)[0]
        np.testing.assert_allclose(out[here], target[there], atol=1e-6)
        self.assertEqual(len(np.loadtxt(self.path("places.txt"))), len(self.points))

    def test_a_coefficient_with_a_curve_that_its_map_has(self):
        # The map of a coefficient, found again with one of its curves held.
        z = (self.points[:, 0] + 1j * self.points[:, 1]) / np.maximum(1 + self.points[:, 2], 1e-300)
        w = (z + 0.2 * np.conj(z)) / 1.2
        images = np.column_stack([2 * w.real, 2 * w.imag, 1 - np.abs(w) ** 2]) / (1 + np.abs(w) ** 2)[:, None]
        images[5] = [0, 0, -1]
        write_obj(self.path("round.obj"), self.points, self.faces)
        mu = write_rows(self.path("mu.txt"), np.full(len(self.faces), 0.2))
        # The real axis goes to itself.
        axis = [self.near(1, 0, 1), self.near(1, 0, .3), self.near(1, 0, -.3)]
        record = self.flow(self.path("round.obj"), "--onto", "sphere", "--mu", mu, "--mu-frame", "stereographic",
                           "--curves", self.curves(("fixed", axis, images[axis])))
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertLess(record["surface_flow"]["error"]["l2"], 0.05)
        np.testing.assert_allclose(read_obj(self.out)[0][axis], images[axis], atol=1e-9)

    @unittest.skipUnless((MESHES / "hippocampus.obj").exists(), "no scans in BELTRAMI_TEST_MESHES")
    def test_a_scan_onto_another_one_along_curves(self):
        # Faces of the hand whose corners come to lie around the hippocampus cut through it.
        pairs = [("slide", [a, b], [c, d])
                 for a, b, c, d in ((315, 5862, 742, 691), (2755, 5206, 3696, 3896), (6691, 6400, 3990, 243))]
        for count, most in ((2, 0.08), (3, 0.11)):
            record = self.flow(MESHES / "hand_closed.obj", "--onto", MESHES / "hippocampus.obj", "--minimize-lp", "2", "--curves",
                               self.curves(*pairs[:count]))
            self.assertEqual(record["map"]["flipped"], 0)
            self.assertEqual(record["solve"]["termination"], "converged")
            self.assertLess(record["map"]["mu"]["mean"], most)
            self.assertEqual(record["warnings"], [])

    def test_open_surfaces_need_no_start(self):
        points, faces = bump(8)
        write_obj(self.path("a.obj"), points, faces)
        other, more = bump(10)
        other[:, 0] *= 1.5
        write_obj(self.path("b.obj"), other, more)
        for boundary in ("fixed", "tangential", "free"):
            record = self.flow(self.path("a.obj"), "--onto", self.path("b.obj"), "--minimize-lp", "4", "--boundary", boundary)
            self.assertEqual(record["map"]["flipped"], 0)
            self.assertEqual(record["surface_flow"]["start"], "conformal")
        points, faces = ring(48, 8, 0.5)
        height = 0.3 * np.sin(2 * points[:, 0])
        write_obj(self.path("ring.obj"), np.column_stack([points, height]), faces)
        points, faces = ring(60, 12, 0.4)
        write_obj(self.path("other.obj"), np.column_stack([points, 0.2 * points[:, 1] ** 2]), faces)
        domain = self.path("ring.json")
        pathlib.Path(domain).write_text(json.dumps({"outer": {"circle": [0, 0, 1]}, "holes": [{"circle": [0, 0, 0.3]}]}))
        for onto, boundary in ((self.path("other.obj"), "tangential"), (self.path("other.obj"), "fixed"),
                               ("plane", "free"), ("cylinder:1,1", "tangential"), (domain, "tangential")):
            record = self.flow(self.path("ring.obj"), "--onto", onto, "--minimize-lp", "2", "--boundary", boundary)
            self.assertEqual(record["map"]["flipped"], 0, (onto, boundary))
        record = self.flow(self.source, "--onto", "ellipsoid:1,1.5,0.8", "--minimize-lp", "2")
        self.assertEqual(record["map"]["flipped"], 0)

    def test_curves_inside_open_surfaces(self):
        points, faces = bump(10)
        write_obj(self.path("a.obj"), points, faces)
        at = lambda x, y: int(np.hypot(points[:, 0] - x, points[:, 1] - y).argmin())
        here, there = [at(-.5, 0), at(.5, 0)], [at(-.4, .2), at(.5, -.1)]
        for onto, to in ((self.path("a.obj"), there), ("plane", [(-.4, .2, 0), (.5, -.1, 0)])):
            record = self.flow(self.path("a.obj"), "--onto", onto, "--minimize-lp", "2", "--curves",
                               self.curves(("slide", here, to)), *(["--boundary", "free"] if onto == "plane" else []))
            self.assertEqual(record["map"]["flipped"], 0)

    def test_weights_by_phi(self):
        write_obj(self.path("round.obj"), self.points, self.faces)
        pins = self.path("pins.txt")
        places = [(1, 0, 0), (-1, .2, 0), (0, 1, .3), (0, -1, 0), (0, 0, 1)]
        pathlib.Path(pins).write_text("".join(f"{v} {x} {y} {z}\n" for v, (x, y, z) in enumerate(places)))
        by = {}
        for weight in ("area", "phi"):
            record = self.flow(self.path("round.obj"), "--onto", "sphere", "--minimize-lp", "2", "--pin", pins, "--weight",
                               weight)
            by[weight] = record["map"]["mu"]
        self.assertLess(by["phi"]["std"], 0.8 * by["area"]["std"])
        # Of a planar domain from the file of another map.
        points, faces = disk(10)
        write_obj(self.path("disk.obj"), points, faces)
        self.run_command("map", self.path("disk.obj"), "--boundary", "rectangle:2,1", "-o", self.path("map.obj"), "--phi",
                         self.path("phi.json"))
        vt = read_obj(self.path("map.obj"))[1]
        write_obj(self.path("start.obj"), vt, faces)
        for weight in ("area", self.path("phi.json")):
            record = self.flow(self.path("disk.obj"), "--onto", "plane", "--minimize-lp", "2", "--boundary", "fixed",
                               "--start-map", self.path("start.obj"), "--weight", weight)
            by[weight] = record["map"]["mu"]
        self.assertLess(by[self.path("phi.json")]["std"], 0.8 * by["area"]["std"])

    def test_mistakes(self):
        def refused(code, *arguments, says, onto="sphere"):
            text = self.run_command("flow", self.source, "--onto", onto, "--minimize-lp", "2", *arguments, "-o", self.out,
                                    code=code).stderr
            self.assertIn(says, text)
            self.assertFalse(pathlib.Path(self.out).exists())

        a, b, c, d = self.near(1, 0, .1), self.near(0, 1, 0), self.near(.7, .7, .5), self.near(.7, .7, -.5)
        ends = [(1, 0, 0), (0, 1, 0)]
        high, low = (.63, .63, .45), (.63, .63, -.45)
        refused(5, "--curves", self.curves(("slide", [a, b], ends), ("slide", [c, d], [low, high])),
                says="curve 2")  # they cross
        refused(5, "--curves", self.curves(("slide", [a, b], ends), ("slide", [c, self.near(0, 0, 1)],
                                                                     [low, high])),
                says="curve 2")
        refused(5, "--curves", self.curves(("slide", [a, b], [(1, 0, 0), (-1, 0, 0)])), says="opposite")
        refused(5, "--curves", self.curves(("slide", [a, b], [(1, 0, 0), (0, 2, 0)])), says="leaves TARGET")
        refused(5, "--curves", self.curves(("slide", [a, b], [(1, 0, 0)])), says="partner")
        refused(5, "--curves", self.curves(("slide", [a, b, c, a], [(1, 0, 0), (0, 1, 0), (0, 0, 1), (.5, .5, .5)])),
                says="closed")
        refused(5, "--curves", self.curves(("slide", [a, 10**6], ends)), says="does not exist")
        refused(3, "--curves", self.curves(("slide", [a, b], [4, 5])), says="no vertices")
        refused(3, "--curves", self.curves(("slide", [a, b], [(1, 0, float("nan")), (0, 1, 0)])), says="not finite")
        for text in ("", "# nothing\n"):
            pathlib.Path(self.path("empty.txt")).write_text(text)
            refused(3, "--curves", self.path("empty.txt"), says="no curve")
        refused(3, "--curves", self.path("absent.txt"), says="absent.txt")
        good = self.curves(("slide", [a, b], ends))
        pathlib.Path(self.path("pins.txt")).write_text(f"{a} 1 0 0\n")
        refused(5, "--curves", good, "--pin", self.path("pins.txt"), says="held twice")
        refused(2, "--weight", "phi", says="--weight phi")
        refused(3, "--weight", self.path("absent.json"), says="absent.json")
        text = self.run_command("flow", self.source, "--curves", good, "--minimize-lp", "2", "-o", self.out, code=2).stderr
        self.assertIn("--onto TARGET", text)


if __name__ == "__main__":
    unittest.main()
