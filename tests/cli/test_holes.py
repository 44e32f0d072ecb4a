"""beltrami info and map: loops, homotopy classes and split meshes of surfaces with holes."""

import math
import unittest

import numpy as np

from support import Command, abs_mu, disk, disk_with_holes, read_obj, ring, write_obj


def twist_k(angle, inner):
    """k of z|z|^{is}, which turns the circle |z| = inner by an angle against |z| = 1."""
    s = abs(angle) / math.log(1 / inner)
    return (s / 2) / math.sqrt(1 + s * s / 4)


class Loops(Command):
    def test_info_numbers_the_loops(self):
        points, faces = disk_with_holes(10, [((0.4, 0), 0.2), ((-0.4, 0.1), 0.15)])
        write_obj(self.path("two.obj"), points, faces)
        source = self.record("info", self.path("two.obj"))["source"]
        self.assertEqual(len(source["loops"]), 3)
        self.assertEqual([loop["length"] for loop in source["loops"]], source["boundary_loops"])
        edges = {(f[i], f[(i + 1) % 3]) for f in faces.tolist() for i in range(3)}
        after = {a: b for a, b in edges if (b, a) not in edges}
        for loop in source["loops"]:
            around = [loop["first_vertex"]]
            while after[around[-1]] != around[0]:
                around.append(after[around[-1]])
            self.assertEqual(len(around), loop["vertices"])
            self.assertEqual(min(around), loop["first_vertex"])
        self.assertEqual(source["loops"][0]["vertices"], 60)
        text = self.run_command("info", self.path("two.obj")).stdout
        for number, loop in enumerate(source["loops"]):
            self.assertRegex(text, rf"loop {number}: length [0-9.]+, {loop['vertices']} vertices, the first is {loop['first_vertex']}\n")


class Turns(Command):
    def setUp(self):
        super().setUp()
        self.inner = 0.05
        points, faces = ring(60, 28, self.inner)
        self.source = self.path("ring.obj")
        write_obj(self.source, points, faces)
        self.identity = ["map", self.source, "-o", self.path("out.obj"), "--boundary", "disk", "--hole", f"1=disk:0,0,{self.inner}"]

    def test_turns_choose_the_class(self):
        for turns in (0, 1, -1):
            record = self.record(*self.identity, "--turns", f"1={turns}")
            homotopy = record["homotopy"]
            self.assertEqual(homotopy["outer_loop"], 0)
            (hole,) = homotopy["holes"]
            self.assertEqual((hole["loop"], hole["turns"], hole["meaningful"]), (1, turns, True))
            self.assertAlmostEqual(hole["angle"], 2 * math.pi * turns, delta=0.2)
            self.assertEqual(record["map"]["flipped"], 0)
            self.assertAlmostEqual(record["map"]["k"], twist_k(2 * math.pi * turns, self.inner), delta=0.01)
        self.assertEqual(self.record(*self.identity)["homotopy"]["holes"][0]["turns"], 0)

    def test_the_class_is_told_in_words(self):
        text = self.run_command(*self.identity, "--turns", "1=1", "--report", self.path("out.html")).stdout
        self.assertIn("homotopy class: turned is loop 1 by +1 against loop 0", text)
        self.assertIn("in this homotopy class stretches less than", text)
        self.assertIn('"homotopy"', (self.folder / "out.html").read_text())
        self.assertIn("no hole is turned against loop 0", self.run_command(*self.identity).stdout)

    def test_the_angle_of_a_hole_is_the_stretch(self):
        for angle in (0.8, -2.5):
            arguments = [*self.identity[:-1], f"1=disk:0,0,{self.inner},{angle}"]
            record = self.record(*arguments)
            self.assertAlmostEqual(record["map"]["k"], twist_k(angle, self.inner), delta=0.005)

    def test_outside_in_turns_are_counted_from_the_other_loop(self):
        record = self.record("map", self.source, "-o", self.path("out.obj"), "--boundary", "disk", "--outer", 1,
                             "--hole", f"0=disk:0,0,{self.inner}", "--turns", "0=1")
        self.assertEqual(record["homotopy"]["outer_loop"], 1)
        self.assertEqual(record["homotopy"]["holes"][0]["loop"], 0)
        self.assertEqual(record["homotopy"]["holes"][0]["turns"], 1)
        self.assertAlmostEqual(record["map"]["k"], twist_k(2 * math.pi, self.inner), delta=0.01)

    def test_bad_turns(self):
        for turns in ("1", "1=", "1=x", "1=0.5", "x=1", "-1=1", "0=1", "2=1", "1=1,1=2"):
            with self.subTest(turns):
                self.assertIn("--turns", self.run_command(*self.identity, "--turns", turns, code=2).stderr)
        self.assertIn("twice", self.run_command(*self.identity, "--turns", "1=1", "--turns", "1=1", code=2).stderr)
        self.assertIn("extremal", self.run_command(*self.identity, "--turns", "1=1", "--method", "mips", code=2).stderr)
        points, faces = disk(4)
        write_obj(self.path("disk.obj"), points, faces)
        failed = self.run_command("map", self.path("disk.obj"), "-o", self.path("o.obj"), "--boundary", "disk", "--turns", "1=1", code=2)
        self.assertIn("without holes", failed.stderr)
        self.assertFalse((self.folder / "o.obj").exists())

    def test_threads_give_the_same_bytes(self):
        texts = []
        for threads in (1, 2, 5):
            self.run_command(*self.identity, "--turns", "1=1", "--threads", threads)
            texts.append((self.folder / "out.obj").read_bytes())
        self.assertEqual(texts[0], texts[1])
        self.assertEqual(texts[0], texts[2])


class Braids(Command):
    def setUp(self):
        super().setUp()
        self.points, faces = disk_with_holes(20, [((-0.4, 0), 0.14), ((0.4, 0), 0.14)])
        self.source = self.path("two.obj")
        write_obj(self.source, self.points, faces)
        x = self.record("info", self.source)["source"]["loops"]
        self.left = 1 if self.points[x[1]["first_vertex"], 0] < 0 else 2
        self.right = 3 - self.left

    def exchange(self, up, *more, code=0):
        """The holes change places, the left one over the upper or lower side."""
        side = 0.45 if up else -0.45
        (self.folder / "way.txt").write_text(f"# step loop x y\n1 {self.left} 0 {side}\n1 {self.right} 0 {-side}\n")
        arguments = ["map", self.source, "-o", self.path("out.obj"), "--boundary", "disk", "--hole", f"{self.left}=disk:0.4,0,0.14",
                     "--hole", f"{self.right}=disk:-0.4,0,0.14", "--waypoints", self.path("way.txt"), *more]
        return self.record(*arguments) if code == 0 else self.run_command(*arguments, code=code)

    def test_the_side_on_which_holes_pass_is_kept(self):
        path = np.flatnonzero((np.abs(self.points[:, 1]) < 1e-9) & (self.points[:, 0] < -0.4))
        path = path[np.argsort(self.points[path, 0])]
        angles = []
        for up in (True, False):
            record = self.exchange(up)
            self.assertEqual(record["map"]["flipped"], 0)
            z = read_obj(self.path("out.obj"))[1][path] @ [1, 1j] - (-0.4)
            angles.append(np.angle(z[1:] / z[:-1]).sum())  # seen from the other hole
        # From the left of that hole to its right: above it clockwise, below it counter-clockwise.
        self.assertAlmostEqual(angles[0], -math.pi, delta=0.5)
        self.assertAlmostEqual(angles[1], math.pi, delta=0.5)

    def test_bad_waypoints(self):
        self.assertIn("--turns and --waypoints", self.exchange(True, "--turns", f"{self.left}=1", code=2).stderr)
        self.exchange(True, "--method", "mips", code=2)
        good = ["map", self.source, "-o", self.path("o.obj"), "--boundary", "disk", "--hole", f"{self.left}=disk:-0.4,0,0.14",
                "--hole", f"{self.right}=disk:0.4,0,0.14", "--waypoints", self.path("way.txt")]
        for text, code, words in (("1 1 0\n", 3, "way.txt:1"), ("x\n", 3, "way.txt:1"), ("1 0 0 0\n", 2, "loop 0"), ("1 9 0 0\n", 2, "loop 9"),
                                  ("0 1 0 0\n", 2, ""), ("1 1 5 5\n", 5, "")):
            with self.subTest(text):
                (self.folder / "way.txt").write_text(text)
                self.assertIn(words, self.run_command(*good, code=code).stderr)
        (self.folder / "way.txt").unlink()
        self.run_command(*good, code=3)
        self.assertFalse((self.folder / "o.obj").exists())

    def test_no_waypoints_are_straight_ways(self):
        (self.folder / "way.txt").write_text("# none\n")
        record = self.record("map", self.source, "-o", self.path("out.obj"), "--boundary", "disk", "--hole", f"{self.left}=disk:-0.4,0,0.14",
                             "--hole", f"{self.right}=disk:0.4,0,0.14,3.1", "--waypoints", self.path("way.txt"))
        self.assertEqual([hole["turns"] for hole in record["homotopy"]["holes"]], [0, 0])
        self.assertEqual(record["map"]["flipped"], 0)


class Splits(Command):
    def test_added_vertices_follow_the_old_ones(self):
        points, faces = ring(24, 1, 0.6)  # every inner edge joins the two circles
        source = self.path("ring.obj")
        write_obj(source, points, faces, points)
        record = self.record("map", source, "-o", self.path("out.obj"), "--boundary", "disk", "--hole", "1=disk:0.1,0,0.5,0.3", "--report",
                             self.path("out.html"), "--compare", "harmonic,mips")
        split = record["split"]
        self.assertEqual(split["edges"], 48)
        self.assertEqual([row[0] for row in split["added"]], list(range(48, 96)))
        v, vt, f = read_obj(self.path("out.obj"))
        self.assertEqual(len(v), 96)
        self.assertEqual(len(vt), 96)
        np.testing.assert_array_equal(v[:48, :2], points)
        for row in split["added"]:
            np.testing.assert_allclose(v[row[0]], v[row[1:]].mean(axis=0), atol=1e-15)
        self.assertEqual(record["source"]["faces"], len(faces))
        self.assertGreater(len(f), len(faces))
        mu, area = abs_mu(v, vt, f)
        self.assertAlmostEqual(record["map"]["mu"]["mean"], (area * mu).sum() / area.sum(), delta=1e-12)
        self.assertAlmostEqual(self.record("measure", self.path("out.obj"))["map"]["mu"]["max"], record["map"]["mu"]["max"], delta=1e-12)
        self.assertEqual([other["method"] for other in record["comparison"]], ["harmonic", "mips"])
        self.assertTrue(any("were split" in warning for warning in record["warnings"]))

    def test_nothing_is_split_without_need(self):
        points, faces = ring()
        write_obj(self.path("ring.obj"), points, faces)
        record = self.record("map", self.path("ring.obj"), "-o", self.path("out.obj"), "--boundary", "disk", "--hole", "1=disk:0,0,0.3")
        self.assertNotIn("split", record)
        self.assertEqual(len(read_obj(self.path("out.obj"))[0]), len(points))


class Comparison(Command):
    def test_with_holes(self):
        points, faces = ring()
        write_obj(self.path("ring.obj"), points, faces)
        record = self.record("map", self.path("ring.obj"), "-o", self.path("out.obj"), "--boundary", "disk", "--hole", "1=disk:0,0,0.4,0.5",
                             "--compare", "harmonic,lscm,arap,mips,alternation,qc")
        self.assertEqual([other["method"] for other in record["comparison"]], ["harmonic", "lscm", "arap", "mips", "alternation", "qc"])
        for other in record["comparison"]:
            if other["method"] != "lscm":
                self.assertLess(record["map"]["mu"]["std"], other["map"]["mu"]["std"] + 1e-3, other["method"])

    def test_corners_are_recorded(self):
        # A circle by arc length to a square: at its corners the angle halves.
        points, faces = disk(16)
        write_obj(self.path("disk.obj"), points, faces)
        record = self.record("map", self.path("disk.obj"), "-o", self.path("out.obj"), "--boundary", "rectangle:1,1")
        self.assertEqual(record["corners"]["count"], 4)
        sharpest = record["corners"]["sharpest"]
        self.assertAlmostEqual(sharpest["source_angle"], math.pi, delta=0.05)
        self.assertAlmostEqual(sharpest["image_angle"], math.pi / 2, delta=0.05)
        self.assertAlmostEqual(sharpest["K"], 2, delta=0.1)
        image = read_obj(self.path("out.obj"))[1][sharpest["vertex"]]
        self.assertTrue(all(min(abs(c), abs(c - 1)) < 1e-12 for c in image))
        smooth = self.record("map", self.path("disk.obj"), "-o", self.path("out.obj"), "--boundary", "disk:0.3")
        self.assertEqual(smooth["corners"], {"count": 0})


if __name__ == "__main__":
    unittest.main()
