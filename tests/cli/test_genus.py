"""beltrami register and distance of surfaces with handles."""

import math
import pathlib
import unittest

import numpy as np

from support import MESHES, Command, read_obj, write_obj
from test_tori import torus

CASES = MESHES.parent / "cases"


class RegisterTori(Command):
    def tori(self):
        self.source, self.faces = torus(2, 1, 40, 20)
        self.target, _ = torus(math.sqrt(2), 1, 36, 28)
        write_obj(self.path("a.obj"), self.source, self.faces)
        write_obj(self.path("b.obj"), self.target, torus(math.sqrt(2), 1, 36, 28)[1])

    def register(self, *arguments, code=0):
        return self.record("register", self.path("a.obj"), self.path("b.obj"), "-o", self.path("out.obj"), *arguments,
                           code=code)

    def write_path(self, name, path):
        pathlib.Path(self.path(name)).write_text(" ".join(map(str, path)) + "\n")
        return self.path(name)

    def loops(self, turned):
        """The parallel and the meridian of both tori, the meridian of the target turned along the parallel."""
        parallel, meridian = [i * 28 for i in range(36)], list(range(28))
        image = parallel + [0] + meridian[1:] if turned else meridian
        return ("--loop", self.write_path("ap.txt", [i * 20 for i in range(40)]), self.write_path("bp.txt", parallel),
                "--loop", self.write_path("am.txt", range(20)), self.write_path("bm.txt", image))

    def test_nearest_points_tell_the_class(self):
        self.tori()
        record = self.register("--places", self.path("places.txt"))
        self.assertAlmostEqual(record["map"]["K"], math.sqrt(3), delta=1e-2)
        self.assertLessEqual(record["map"]["K_lower"], record["map"]["K"])
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertEqual(abs(round(np.linalg.det(record["registration"]["homology"]))), 1)
        out, _, faces = read_obj(self.path("out.obj"))
        np.testing.assert_array_equal(faces, self.faces)
        from_circle = np.hypot(np.hypot(out[:, 0], out[:, 1]) - math.sqrt(2), out[:, 2])
        np.testing.assert_allclose(from_circle, 1, atol=0.03)
        self.assertEqual(len(np.loadtxt(self.path("places.txt"))), len(self.source))

    def test_loops_twists_and_the_least_of_all(self):
        self.tori()
        natural = self.register(*self.loops(False))["map"]["K"]
        self.assertAlmostEqual(natural, math.sqrt(3), delta=1e-2)
        twisted = self.register(*self.loops(True))["map"]["K"]
        self.assertAlmostEqual(twisted, 3.776668, delta=4e-2)
        # A Dehn twist about the parallel takes the meridian to meridian ± parallel: mirror images of each other.
        for turns in (1, -1):
            by_twist = self.register("--twist", f"{turns}:{self.path('ap.txt')}")["map"]["K"]
            self.assertAlmostEqual(by_twist, twisted, delta=1e-9)
        least = self.register("--marking", "search")["map"]["K"]
        self.assertAlmostEqual(least, natural, delta=1e-9)

    def test_quads_have_the_class_of_their_triangles(self):
        self.tori()
        quads = [[i * 20 + j, (i + 1) % 40 * 20 + j, (i + 1) % 40 * 20 + (j + 1) % 20, i * 20 + (j + 1) % 20]
                 for i in range(40) for j in range(20)]
        write_obj(self.path("a.obj"), self.source, quads)
        self.assertAlmostEqual(self.register()["map"]["K"], math.sqrt(3), delta=1e-2)
        twisted = self.register("--twist", f"1:{self.write_path('ap.txt', [i * 20 for i in range(40)])}")
        self.assertAlmostEqual(twisted["map"]["K"], 3.776668, delta=4e-2)
        self.assertEqual(twisted["map"]["flipped"], 0)

    def test_distances_in_the_class_of_nearest_points(self):
        self.tori()
        meshes = (self.path("a.obj"), self.path("b.obj"))
        least = self.record("distance", *meshes)["distances"]
        closest = self.record("distance", *meshes, "--marking", "closest", "--align", "rigid")["distances"]
        self.assertAlmostEqual(least["distance"][0][1], 0.25 * math.log(3), delta=5e-3)
        self.assertAlmostEqual(closest["distance"][0][1], least["distance"][0][1], delta=1e-9)
        # Of a small copy that lies elsewhere nearest points tell no class.
        write_obj(self.path("c.obj"), 0.1 * self.source + [5, 0, 0], self.faces)
        self.assertAlmostEqual(self.record("distance", meshes[0], self.path("c.obj"))["distances"]["distance"][0][1], 0,
                               delta=1e-9)
        self.run_command("distance", meshes[0], self.path("c.obj"), "--marking", "closest", code=2)
        self.run_command("distance", *meshes, "--align", "rigid", code=2)

    def test_a_class_of_no_map_is_refused(self):
        self.tori()
        # All of a small copy is nearest to a part of the target.
        write_obj(self.path("a.obj"), 0.1 * self.source + [5, 0, 0], self.faces)
        text = self.run_command("register", self.path("a.obj"), self.path("b.obj"), "-o", self.path("out.obj"),
                                code=2).stderr
        self.assertIn("not 1", text)
        self.assertIn("alignment", text)

    def test_what_contradicts_itself_is_refused(self):
        self.tori()
        loops = self.loops(False)
        exchanged = (loops[0], loops[1], loops[5], loops[3], loops[4], loops[2])
        text = self.run_command("register", self.path("a.obj"), self.path("b.obj"), "-o", self.path("out.obj"),
                                *exchanged, code=2).stderr
        self.assertIn("determinant", text)
        for arguments in (("--twist", "ap.txt"), ("--twist", f"0:{self.path('ap.txt')}"), loops[:3]):
            self.run_command("register", self.path("a.obj"), self.path("b.obj"), "-o", self.path("out.obj"), *arguments,
                             code=2)
        self.write_path("pairs.txt", [0, 0])
        self.run_command("register", self.path("a.obj"), self.path("b.obj"), "-o", self.path("out.obj"), "--landmarks",
                         self.path("pairs.txt"), code=2)


def outside_the_hole(n, m):
    """Flags of the faces of a torus that are not in a rectangle of its parameters."""
    cell = np.arange(2 * n * m) // 2
    return (cell // m >= n // 6) | (cell % m >= m // 4)


def torus_with_a_hole(n, m, stretch=1.0):
    """A torus of revolution less a rectangle of its parameters: a sixth of the one by a quarter of the other."""
    points, faces = torus(2, 1, n, m)
    faces = faces[outside_the_hole(n, m)]
    used, faces = np.unique(faces, return_inverse=True)
    return points[used] * [1, stretch, 1], faces.reshape(-1, 3)


class RegisterOpenSurfacesWithHandles(Command):
    def setUp(self):
        super().setUp()
        # What is left has the same outline on all meshes.
        for name, mesh in (("a", torus_with_a_hole(48, 24)), ("b", torus_with_a_hole(60, 36, 1.3)),
                           ("c", torus_with_a_hole(60, 36))):
            write_obj(self.path(f"{name}.obj"), *mesh)

    def register(self, target, *arguments, code=0):
        return self.record("register", self.path("a.obj"), self.path(target), "-o", self.path("out.ply"), *arguments,
                           code=code)

    def test_boundaries_slide(self):
        record = self.register("b.obj", "--places", self.path("places.txt"))
        registration = record["registration"]
        self.assertEqual(record["solve"]["termination"], "converged")
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertEqual(registration["dimension"], 3)
        self.assertEqual(abs(round(np.linalg.det(registration["homology"]))), 1)
        self.assertGreater(record["map"]["k"], 0.03)
        self.assertAlmostEqual(registration["inverse_k"], record["map"]["k"], delta=4e-3)
        self.assertLess(registration["eigenvalues"][0], 0.05)
        self.assertAlmostEqual(registration["eigenvalues"][1], 0.5, delta=0.05)

    def test_distances_agree_with_the_maps(self):
        record = self.record("distance", *(self.path(f"{name}.obj") for name in "abc"))["distances"]
        d = np.array(record["distance"])
        self.assertLess(d[0, 2], 0.02)
        self.assertAlmostEqual(d[0, 1], d[1, 2], delta=0.02)
        self.assertEqual(record["merges"][0]["clusters"], [0, 2])

    def test_edges_across_a_ragged_outline_are_split(self):
        points, faces = torus(2, 1, 48, 24)
        cell = np.arange(len(faces)) // 2
        teeth = (cell // 24 == 8) & np.isin(cell % 24, (1, 4))
        used, faces = np.unique(faces[outside_the_hole(48, 24) & ~teeth], return_inverse=True)
        points, ragged = points[used], faces.reshape(-1, 3)
        write_obj(self.path("ragged.obj"), points, ragged)
        record = self.record("uniformize", self.path("ragged.obj"), "-o", self.path("cut.obj"))
        self.assertEqual(record["map"]["flipped"], 0)
        self.assertGreater(record["split"]["edges"], 0)
        self.assertIn("edges_split", [warning["kind"] for warning in record["warning_details"]])
        for generator in record["hyperbolic"]["generators"]:
            self.assertLess(max(generator["vertices"]), len(points))

    def test_uniformize_and_twist(self):
        record = self.record("uniformize", self.path("a.obj"), "-o", self.path("cut.obj"), "--loops", self.path("loop"))
        metric = record["hyperbolic"]
        self.assertAlmostEqual(metric["area"], 2 * math.pi, delta=1e-8)
        self.assertEqual(len(metric["generators"]), 2)
        self.assertEqual(len(metric["boundary"]), 1)
        # Loops around the handle, without periods.
        self.assertEqual(set(record["periods"]), {"loops"})
        self.assertEqual(len(record["periods"]["loops"]), 2)
        # The commutator of the generators runs around the boundary, a closed geodesic.
        a, b = (np.array(generator["matrix"]) for generator in metric["generators"])
        commutator = a @ b @ np.linalg.inv(a) @ np.linalg.inv(b)
        self.assertAlmostEqual(2 * math.acosh(abs(np.trace(commutator)) / 2), metric["boundary"][0], delta=1e-6)
        plain = self.register("c.obj")["map"]["k"]
        # A meridian on the far side; numbers are those of the file, which has lost the vertices in the hole.
        left = np.unique(torus(2, 1, 48, 24)[1][outside_the_hole(48, 24)])
        meridian = np.searchsorted(left, 24 * 24 + np.arange(24))
        pathlib.Path(self.path("meridian.txt")).write_text(" ".join(map(str, meridian)))
        twisted = self.register("c.obj", "--twist", f"1:{self.path('meridian.txt')}")
        self.assertLess(plain, 0.02)
        self.assertGreater(twisted["map"]["k"], 0.1)
        self.assertEqual(twisted["map"]["flipped"], 0)

    def test_what_does_not_fit_is_refused(self):
        pathlib.Path(self.path("l.txt")).write_text("0 1 2\n")
        for arguments, words, code in ((("--marking", "search"), "boundary", 4), (("--outer", "1"), "--outer", 2),
                                       (("--loop", self.path("l.txt"), self.path("l.txt")), "boundary", 2)):
            text = self.run_command("register", self.path("a.obj"), self.path("b.obj"), "-o", self.path("out.ply"),
                                    *arguments, code=code).stderr
            self.assertIn(words, text)
        points, faces = torus(2, 1, 24, 12)
        write_obj(self.path("closed.obj"), points, faces)
        self.run_command("register", self.path("a.obj"), self.path("closed.obj"), "-o", self.path("out.ply"), code=4)
        self.run_command("register", self.path("closed.obj"), self.path("a.obj"), "-o", self.path("out.ply"), code=4)
        self.run_command("distance", self.path("a.obj"), self.path("closed.obj"), code=4)
        self.run_command("distance", self.path("a.obj"), self.path("b.obj"), "--marking", "search", code=4)


@unittest.skipUnless((CASES / "double_torus_a.obj").exists(), "the double tori are not here")
class RegisterDoubleTori(Command):
    def register(self, target, *arguments, source="double_torus_a.obj"):
        return self.record("register", CASES / source, CASES / target, "-o", self.path("out.ply"), *arguments)

    def test_deformed_double_tori(self):
        for target, k, arguments in (("double_torus_13.obj", 0.0979, ()), ("double_torus_055.obj", 0.1937, ()),
                                     ("double_torus_22.obj", 0.2945,
                                      ("--start-map", CASES / "double_torus_a_near_22.obj"))):
            record = self.register(target, *arguments)
            registration = record["registration"]
            self.assertAlmostEqual(record["map"]["k"], k, delta=7e-4)
            self.assertAlmostEqual(registration["inverse_k"], record["map"]["k"], delta=3e-4)
            self.assertEqual(record["solve"]["termination"], "converged")
            self.assertEqual(record["map"]["flipped"], 0)
            self.assertEqual(registration["flipped_in_space"], 0)
            self.assertEqual(registration["dimension"], 3)
            self.assertLess(registration["eigenvalues"][0], 0.01)
            self.assertAlmostEqual(registration["eigenvalues"][1], 0.5, delta=0.02)
            self.assertLess(registration["homology_bound"], record["map"]["K"])

    def test_points_that_contradict_each_other_are_refused(self):
        text = self.run_command("register", CASES / "double_torus_a.obj", CASES / "double_torus_22.obj", "-o",
                                self.path("out.ply"), code=2).stderr
        self.assertIn("defect", text)
        self.assert_nothing_left()

    def test_search_finds_the_class(self):
        record = self.register("double_torus_13.obj", "--marking", "search")
        self.assertAlmostEqual(record["map"]["k"], 0.0979, delta=2e-3)
        search = record["registration"]["search"]
        energies = [reached["energy"] for reached in search["reached"]]
        self.assertEqual(energies, sorted(energies))
        self.assertTrue(any("no optimum over all classes is proved" in warning for warning in record["warnings"]))

    def test_distances_in_classes_that_are_sought(self):
        meshes = [CASES / f"double_torus_{name}.obj" for name in ("a", "22")]
        record = self.record("distance", *meshes, "--marking", "search")
        self.assertAlmostEqual(math.tanh(record["distances"]["distance"][0][1]), 0.2945, delta=2e-3)
        self.assertTrue(any("no optimum over all of them is proved" in warning for warning in record["warnings"]))
        self.run_command("distance", *meshes, "--marking", "search", "--align", "rigid", code=2)

    def test_twist_about_a_short_loop(self):
        self.record("uniformize", CASES / "double_torus_a.obj", "-o", self.path("cut.obj"), "--loops", self.path("loop"))
        plus = self.register("double_torus_13.obj", "--twist", f"1:{self.path('loop0.txt')}")
        minus = self.register("double_torus_13.obj", "--twist", f"-1:{self.path('loop0.txt')}")
        self.assertAlmostEqual(plus["map"]["k"], minus["map"]["k"], delta=2e-3)
        self.assertGreater(plus["map"]["k"], 0.15)

    def test_distances_cluster(self):
        meshes = [CASES / f"double_torus_{name}.obj" for name in ("a", "13", "055")]
        record = self.record("distance", *meshes)["distances"]
        d = np.array(record["distance"])
        self.assertAlmostEqual(math.tanh(d[0, 1]), 0.0979, delta=7e-4)
        self.assertAlmostEqual(math.tanh(d[0, 2]), 0.1937, delta=7e-4)
        self.assertEqual(record["merges"][0]["clusters"], [0, 1])


if __name__ == "__main__":
    unittest.main()
