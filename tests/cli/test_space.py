"""beltrami map --method lsqc: least-squares quasiconformal maps of surfaces into space."""

import pathlib
import unittest

import numpy as np

from support import Command, bump, disk, read_obj, write_obj


class InSpace(Command):
    def setUp(self):
        super().setUp()
        self.points, self.faces = disk(8)
        self.points = np.column_stack([self.points, np.zeros(len(self.points))])
        write_obj(self.path("a.obj"), self.points, self.faces)
        self.border = range(len(self.points) - 48, len(self.points))

    def places(self, image, vertices):
        pathlib.Path(self.path("places.txt")).write_text(
            "".join(f"{v} " + " ".join(map(repr, image[v].tolist())) + "\n" for v in vertices))
        return self.path("places.txt")

    def map(self, *arguments):
        return self.record("map", self.path("a.obj"), "--method", "lsqc", "-o", self.path("out.obj"), *arguments)

    def test_affine_maps_come_out(self):
        mu = 0.4 * np.exp(0.7j)
        z = self.points[:, 0] + 1j * self.points[:, 1]
        w = z + mu * z.conj()
        # The image in a plane of its own.
        image = np.column_stack([w.real, 0.6 * w.imag, 0.8 * w.imag])
        flat = np.column_stack([w.real, w.imag, 0 * w.real])
        pathlib.Path(self.path("mu.txt")).write_text(
            "".join(f"{f} {mu.real!r} {mu.imag!r}\n" for f in range(len(self.faces))))
        record = self.map("--in-space", self.places(flat, self.border), "--mu", self.path("mu.txt"))
        out, _, faces = read_obj(self.path("out.obj"))
        np.testing.assert_array_equal(faces, self.faces)
        np.testing.assert_allclose(out, flat, atol=1e-12)
        self.assertAlmostEqual(record["map"]["mu"]["mean"], 0.4, places=12)
        self.assertLess(record["map"]["mu"]["std"], 1e-12)
        # Turned in space it is no longer what the source's normals say, but the border is met.
        self.map("--in-space", self.places(image, self.border), "--mu", self.path("mu.txt"))
        out, _, _ = read_obj(self.path("out.obj"))
        np.testing.assert_allclose(out[self.border], image[self.border], atol=1e-12)

    def test_constraints_and_refusals(self):
        points, faces = bump(8)
        write_obj(self.path("a.obj"), points, faces)
        places = self.places(points, self.border)
        plain = self.map("--in-space", places, "--preserve", "normals", "--reference", "equilateral")
        even = self.map("--in-space", places, "--preserve", "normals", "--reference", "equilateral", "--uniform")
        self.assertLess(even["map"]["mu"]["std"], plain["map"]["mu"]["std"])
        arguments = ("map", self.path("a.obj"), "-o", self.path("b.obj"), "--method", "lsqc")
        self.assertIn("collapsing", self.run_command(*arguments, code=5).stderr)
        self.assertIn("--boundary", self.run_command(*arguments, "--boundary", "disk", code=2).stderr)
        self.assertIn("--in-space", self.run_command("map", self.path("a.obj"), "-o", self.path("b.obj"), "--boundary", "disk",
                                                     "--in-space", places, code=2).stderr)


if __name__ == "__main__":
    unittest.main()
