"""beltrami apply: maps and their inverses at any points."""

import unittest

import numpy as np

from support import Command, read_obj, ring, write_obj


class Apply(Command):
    def map_of_the_bump(self):
        self.run_command("map", self.bump_file(8), "-o", self.path("map.obj"), "--boundary", "disk", "--quiet")
        return self.path("map.obj")

    def write(self, name, lines):
        (self.folder / name).write_text("".join(line + "\n" for line in lines))
        return self.path(name)

    def apply(self, map_file, points, out, *options):
        self.run_command("apply", map_file, points, "-o", self.path(out), "--quiet", *options)
        return [line.split() for line in (self.folder / out).read_text().splitlines()]

    def test_vertices_and_centroids_go_where_vt_says(self):
        name = self.map_of_the_bump()
        v, vt, faces = read_obj(name)
        points = self.write("points.txt", ["# vertices"] + ["%r %r %r" % tuple(map(float, p)) for p in v])
        out = np.array(self.apply(name, points, "out.txt"), float)
        self.assertLess(np.abs(out - vt).max(), 1e-14)
        points = self.write("points.txt", [f"{f} {1/3!r} {1/3!r} {1/3!r}" for f in range(len(faces))])
        out = np.array(self.apply(name, points, "out.txt"), float)
        self.assertLess(np.abs(out - vt[faces].mean(axis=1)).max(), 1e-14)

    def test_there_and_back(self):
        name = self.map_of_the_bump()
        v, vt, faces = read_obj(name)
        random = np.random.default_rng(1)
        r, t = np.sqrt(random.random(400)) * 0.97, 2 * np.pi * random.random(400)
        w = np.column_stack([r * np.cos(t), r * np.sin(t)])
        self.write("w.txt", ["%r %r" % tuple(map(float, p)) for p in w])
        places = self.apply(name, self.path("w.txt"), "places.txt", "--inverse")
        self.assertTrue(all(len(row) == 4 for row in places))
        back = np.array(self.apply(name, self.path("places.txt"), "back.txt"), float)
        self.assertLess(np.abs(back - w).max(), 1e-12)
        # Places by position: the same points of the surface, and from there the same images.
        positions = np.array(self.apply(name, self.path("w.txt"), "xyz.txt", "--inverse", "--positions"), float)
        f, b = np.array([int(row[0]) for row in places]), np.array([row[1:] for row in places], float)
        self.assertLess(np.abs(np.einsum("ij,ijk->ik", b, v[faces[f]]) - positions).max(), 1e-14)
        self.assertLess(np.abs(np.array(self.apply(name, self.path("xyz.txt"), "out.txt"), float) - w).max(), 1e-12)

    def test_quads_have_four_weights(self):
        n = 6
        x = np.linspace(0, 1, n + 1)
        points = np.array([(a, b) for b in x for a in x])
        quads = [(j * (n + 1) + i, j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i)
                 for j in range(n) for i in range(n)]
        u, v = points.T
        vt = np.column_stack([u + 0.2 * v * v, v + 0.1 * np.sin(3 * u)])
        write_obj(self.path("quads.obj"), points, quads, vt)
        w = np.column_stack([0.3 + 0.4 * u, 0.3 + 0.4 * v])
        self.write("w.txt", ["%r %r" % tuple(map(float, p)) for p in w])
        places = self.apply(self.path("quads.obj"), self.path("w.txt"), "places.txt", "--inverse")
        self.assertTrue(all(len(row) == 5 for row in places))
        back = np.array(self.apply(self.path("quads.obj"), self.path("places.txt"), "back.txt"), float)
        self.assertLess(np.abs(back - w).max(), 1e-12)
        self.write("bad.txt", ["0 0.25 0.25 0.25 0.25"])
        text = self.run_command("apply", self.path("quads.obj"), self.path("bad.txt"), "-o", self.path("o"), code=3).stderr
        self.assertIn("one of the four weights must be 0", text)

    def test_points_of_a_hole_have_no_place(self):
        points, faces = ring(24, 6)
        write_obj(self.path("ring.obj"), points, faces, points)
        self.write("w.txt", ["0.5 0", "0.1 0", "# in the hole, and outside", "3 4"])
        done = self.run_command("apply", self.path("ring.obj"), self.path("w.txt"), "-o", self.path("out.txt"), "--inverse",
                                code=5)
        self.assertIn("w.txt:2: the point lies outside the image of the map, one of 2 that do", done.stderr)
        self.assert_nothing_left("ring.obj", "w.txt")

    def test_points_beside_the_surface_take_the_nearest_place(self):
        points, faces = ring(24, 6)
        write_obj(self.path("ring.obj"), points, faces, points)
        self.write("p.txt", ["0.5 0.1 7", "0 0 0"])
        done = self.run_command("apply", self.path("ring.obj"), self.path("p.txt"), "-o", self.path("out.txt"))
        self.assertIn("2 points, the farthest 7 away from the surface", done.stdout)
        out = np.loadtxt(self.path("out.txt"))
        self.assertLess(np.abs(out[0] - (0.5, 0.1)).max(), 1e-14)
        self.assertAlmostEqual(np.hypot(*out[1]), 0.3 * np.cos(np.pi / 24), 10)

    def test_mistakes_are_named(self):
        points, faces = ring(24, 6)
        write_obj(self.path("ring.obj"), points, faces, points)
        write_obj(self.path("plain.obj"), points, faces)
        for line, part in (("1 0.5 0.5 0.5", "sum up to 1.5"), ("1 1.5 -0.5 0", "negative"), ("999 1 0 0", "is not a face"),
                           ("1.5 1 0 0", "is not a face"), ("1 0.5 0.5 0 0", "has 3 corners, 4 weights"), ("1 2", "3 to 5 numbers"),
                           ("nan 0 0", "not finite"), ("a b c", "a number of a point")):
            self.write("p.txt", ["0 0 0", line])
            done = self.run_command("apply", self.path("ring.obj"), self.path("p.txt"), "-o", self.path("out.txt"), code=3)
            self.assertIn("p.txt:2", done.stderr)
            self.assertIn(part, done.stderr)
        self.write("p.txt", ["0.5 0 0"])
        self.run_command("apply", self.path("plain.obj"), self.path("p.txt"), "-o", self.path("out.txt"), code=4)
        self.run_command("apply", self.path("ring.obj"), self.path("p.txt"), "-o", self.path("out.txt"), "--positions", code=2)
        self.run_command("apply", self.path("ring.obj"), self.path("p.txt"), "-o", self.path("p.txt"), code=2)
        self.assert_nothing_left("ring.obj", "plain.obj", "p.txt")

    def test_folds_are_said(self):
        points, faces = ring(24, 6)
        image = points.copy()
        image[60] += 0.4
        write_obj(self.path("folded.obj"), points, faces, image)
        self.write("w.txt", ["0.5 0"])
        done = self.run_command("apply", self.path("folded.obj"), self.path("w.txt"), "-o", self.path("out.txt"), "--inverse")
        self.assertIn("flipped", done.stderr)


if __name__ == "__main__":
    unittest.main()
