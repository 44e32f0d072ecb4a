"""beltrami uniformize and distance of closed surfaces with handles."""

import math
import re
import unittest

import numpy as np

from support import MESHES, Command, write_obj


def torus(major, minor, n, m):
    """A torus of revolution: vertex (i, j) at u = 2πi/n, v = 2πj/m has the number i·m + j."""
    u, v = 2 * np.pi * np.arange(n)[:, None] / n, 2 * np.pi * np.arange(m)[None, :] / m
    r = major + minor * np.cos(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), np.broadcast_to(minor * np.sin(v), (n, m))], axis=2).reshape(-1, 3)
    at = lambda i, j: (i % n) * m + j % m
    faces = [t for i in range(n) for j in range(m)
             for t in ((at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1)))]
    return points, np.array(faces)


def bar(holes):
    """The boundary of a bar of cubes with square holes through it, in quads."""
    full = lambda i, j, k: 0 <= i <= 2 * holes and 0 <= j < 3 and k == 0 and not (i % 2 == 1 and j == 1)
    numbers, faces = {}, []
    for i in range(2 * holes + 1):
        for j in range(3):
            if not full(i, j, 0):
                continue
            for axis in range(3):
                for side in (0, 1):
                    beyond = [i, j, 0]
                    beyond[axis] += 2 * side - 1
                    if full(*beyond):
                        continue
                    corners = []
                    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        p = [i, j, 0]
                        p[axis] += side
                        p[(axis + 1) % 3] += a
                        p[(axis + 2) % 3] += b
                        corners.append(numbers.setdefault(tuple(p), len(numbers)))
                    faces.append(corners if side else corners[::-1])
    return np.array(list(numbers), float), faces


def corners_of_vt(path):
    """vt of every face corner, #F×3×2, and the vertices."""
    vt, faces = [], []
    with open(path) as lines:
        for line in lines:
            word, *rest = line.split() or [""]
            if word == "vt":
                vt.append([float(x) for x in rest])
            elif word == "f":
                faces.append([[int(n) - 1 for n in c.split("/")[:2]] for c in rest])
    faces = np.array(faces)
    return np.array(vt)[faces[:, :, 1]], faces[:, :, 0]


def corners_of_vt_of_any(path):
    """vt and vertices of all corners, of faces of any degree."""
    vt, corners = [], []
    with open(path) as lines:
        for line in lines:
            word, *rest = line.split() or [""]
            if word == "vt":
                vt.append([float(x) for x in rest])
            elif word == "f":
                corners += [[int(n) - 1 for n in c.split("/")[:2]] for c in rest]
    corners = np.array(corners)
    return np.array(vt)[corners[:, 1]], corners[:, 0]


class Tori(Command):
    def write_torus(self, name, *shape):
        write_obj(self.path(name), *torus(*shape))
        return self.path(name)

    def test_the_cut_torus_tiles_the_plane(self):
        points, faces = torus(2, 1, 48, 24)
        mesh = self.write_torus("torus.obj", 2, 1, 48, 24)
        record = self.record("uniformize", mesh, "-o", self.path("out.obj"))
        tau = complex(*record["torus"]["tau"])
        self.assertLess(abs(tau - 1j * math.sqrt(3)), 1e-2)
        self.assertLess(abs(tau - 1j * math.sqrt(3)) / math.sqrt(3), 2 * record["torus"]["tau_error"] + 1e-2)
        self.assertAlmostEqual(record["torus"]["lengths"][0], 1 / math.sqrt(tau.imag), delta=1e-12)
        self.assertAlmostEqual(record["torus"]["lengths"][1], abs(tau) / math.sqrt(tau.imag), delta=1e-12)
        self.assertEqual(record["periods"]["matrix"], [[record["torus"]["tau"]]])
        self.assertEqual(abs(round(np.linalg.det(record["periods"]["basis"]))), 1)
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertLess(record["map"]["mu"]["max"], 0.1)
        # The shortest loop goes once round the tube on its inner side or any other: 24 edges.
        loops = record["periods"]["loops"]
        self.assertEqual(len(loops), 2)
        self.assertEqual(len(loops[0]["vertices"]), 24)
        self.assertAlmostEqual(loops[0]["length"], 48 * math.sin(math.pi / 24), delta=1e-9)
        # All faces counter-clockwise, the area that of the parallelogram, and seams differ by the lattice.
        vt, vertices = corners_of_vt(self.path("out.obj"))
        np.testing.assert_array_equal(vertices, faces)
        z = vt[:, :, 0] + 1j * vt[:, :, 1]
        areas = 0.5 * np.imag(np.conj(z[:, 1] - z[:, 0]) * (z[:, 2] - z[:, 0]))
        self.assertGreater(areas.min(), 0)
        self.assertAlmostEqual(areas.sum(), tau.imag, delta=1e-10)
        place = {}
        for v, w in zip(vertices.ravel(), z.ravel()):
            beta = (w - place.setdefault(v, w)).imag / tau.imag
            alpha = (w - place[v]).real - tau.real * beta
            self.assertAlmostEqual(alpha, round(alpha), delta=1e-9)
            self.assertAlmostEqual(beta, round(beta), delta=1e-9)
        self.assertGreater(len({complex(w) for w in z.ravel()}), len(points))
        # What measure says of the texture is what was said.
        measured = self.record("measure", self.path("out.obj"))
        self.assertAlmostEqual(measured["map"]["mu"]["mean"], record["map"]["mu"]["mean"], delta=1e-9)

    def test_words_and_page(self):
        mesh = self.write_torus("torus.obj", 2, 1, 24, 12)
        text = self.run_command("uniformize", mesh, "-o", self.path("out.ply"), "--report", self.path("page.html")).stdout
        self.assertRegex(text, r"a torus: tau = -?0\.\d+\+1\.7\d+i")
        self.assertIn("loop 1: ", text)
        self.assertRegex(text, r"a = .*loop")
        self.assertIn("<html", (self.folder / "page.html").read_text())

    def test_what_a_torus_does_not_take(self):
        mesh = self.write_torus("torus.obj", 2, 1, 12, 8)
        for arguments in (("-o", self.path("out.off")), ("-o", self.path("out.obj"), "--as-positions"),
                          ("-o", self.path("out.obj"), "--method", "tutte"),
                          ("-o", self.path("out.obj"), "--outer", "0")):
            self.run_command("uniformize", mesh, *arguments, code=2)
        self.assert_nothing_left("torus.obj")

    def test_more_handles_have_a_polygon_in_the_disk(self):
        points, faces = bar(3)
        write_obj(self.path("bar.obj"), points, faces)
        arguments = ("uniformize", self.path("bar.obj"), "-o", self.path("out.obj"))
        self.assertIn("period matrix:", self.run_command(*arguments).stdout)
        record = self.record(*arguments, "--loops", self.path("loop"))
        periods = np.array(record["periods"]["matrix"])
        self.assertEqual(periods.shape, (3, 3, 2))
        np.testing.assert_allclose(periods, periods.transpose(1, 0, 2), atol=1e-12)
        self.assertGreater(np.linalg.eigvalsh(periods[:, :, 1]).min(), 0.05)
        self.assertEqual(len(record["periods"]["loops"]), 6)
        hyperbolic = record["hyperbolic"]
        self.assertAlmostEqual(hyperbolic["area"], 8 * math.pi, delta=1e-9)
        self.assertLess(hyperbolic["relation"], 1e-7)
        self.assertEqual(len(hyperbolic["generators"]), 6)
        for number, generator in enumerate(hyperbolic["generators"]):
            matrix = np.array(generator["matrix"])
            self.assertAlmostEqual(np.linalg.det(matrix), 1, delta=1e-6)
            self.assertAlmostEqual(2 * math.acosh(abs(np.trace(matrix)) / 2), generator["length"], delta=1e-9)
            path = np.loadtxt(self.path(f"loop_generator{number}.txt"), dtype=int)
            self.assertEqual(path.tolist(), generator["vertices"])
        vt, _ = corners_of_vt_of_any(self.path("out.obj"))
        self.assertLess(np.linalg.norm(vt, axis=1).max(), 1)

    def test_distances_are_least_over_all_markings(self):
        meshes = (self.write_torus("thin.obj", 2, 1, 40, 20), self.write_torus("square.obj", math.sqrt(2), 1, 36, 28),
                  self.write_torus("large.obj", 20, 10, 32, 18))
        record = self.record("distance", *meshes)["distances"]
        d = np.array(record["distance"])
        self.assertAlmostEqual(d[0, 1], 0.25 * math.log(3), delta=4e-3)
        self.assertLess(d[0, 2], 4e-3)
        self.assertTrue((np.array(record["lower"]) <= d).all() and (np.array(record["upper"]) >= d).all())
        self.assertEqual([m["shapes"] for m in record["markings"]], [[0, 1], [0, 2], [1, 2]])
        tau = [complex(*t) for t in record["tau"]]
        for m in record["markings"]:
            (a, b), (c, e) = m["marking"]
            self.assertEqual(a * e - b * c, 1)
            i, j = m["shapes"]
            image = (b + e * tau[j]) / (a + c * tau[j])
            half = math.asinh(abs(tau[i] - image) / (2 * math.sqrt(tau[i].imag * image.imag)))
            self.assertAlmostEqual(d[i, j], half, delta=1e-12)
        text = self.run_command("distance", *meshes, "--picture", self.path("tree.svg")).stdout
        self.assertEqual(len(re.findall("the nearest marking sends a to", text)), 3)
        self.assertIn("<svg", (self.folder / "tree.svg").read_text())

    def test_distances_refuse_what_does_not_belong_together(self):
        mesh = self.write_torus("torus.obj", 2, 1, 12, 8)
        points, faces = bar(2)
        write_obj(self.path("bar.obj"), points, faces)
        text = self.run_command("distance", mesh, self.path("bar.obj"), code=4).stderr
        self.assertIn("bar.obj", text)
        self.run_command("distance", mesh, mesh, "--match", "size", code=2)

    @unittest.skipUnless((MESHES / "torus.obj").exists(), "the real meshes are not here")
    def test_real_mesh(self):
        record = self.record("uniformize", MESHES / "torus.obj", "-o", self.path("out.obj"))
        tau = record["torus"]["tau"]
        self.assertAlmostEqual(tau[0], 0, delta=2e-3)
        self.assertAlmostEqual(tau[1], 3.88448, delta=2e-3)
        self.assertEqual(record["map"]["flipped"], 0)


if __name__ == "__main__":
    unittest.main()
