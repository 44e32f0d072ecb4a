"""beltrami map --phi: μ and φ of the extremal map, its zeros and poles, against what the files say."""

import json
import pathlib

import jsonschema
import numpy as np

from support import Command, bump, disk, disk_with_holes, read_faces, read_obj, ring, write_obj

SCHEMA = json.loads((pathlib.Path(__file__).parents[2] / "docs" / "phi.schema.json").read_text())


def first_edge_coefficients(points, image, faces):
    """∂̄f/∂f of every triangle in the frame whose real axis is its first edge, and its area."""
    points = np.column_stack([points, np.zeros(len(points))]) if points.shape[1] == 2 else points
    f = (image @ [1, 1j])[faces]
    a, b = points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]]
    length, height = np.linalg.norm(a, axis=1), np.linalg.norm(np.cross(a, b), axis=1) / np.linalg.norm(a, axis=1)
    z1, z2 = length + 0j, np.einsum("ij,ij->i", a, b) / length + 1j * height
    # f = p z + q z̄ with f(0) = 0.
    df1, df2 = f[:, 1] - f[:, 0], f[:, 2] - f[:, 0]
    det = z1 * z2.conj() - z2 * z1.conj()
    p, q = (df1 * z2.conj() - df2 * z1.conj()) / det, (z1 * df2 - z2 * df1) / det
    return q / p, length * height / 2


def boundary_edges(faces):
    """Directed edges without a partner: their face and corner."""
    found = {(f[j], f[(j + 1) % len(f)]): (i, j) for i, f in enumerate(faces) for j in range(len(f))}
    return {e: at for e, at in found.items() if e[::-1] not in found}


def along(points, faces, values, face, direction):
    """φ(e, e)/|e|² of values in the frames of first edges, for a direction of a planar face."""
    first = (points[faces[face][1]] - points[faces[face][0]]) @ [1, 1j]
    return values[face] * (direction / first * abs(first) / abs(direction)) ** 2


class Phi(Command):
    def map(self, *arguments):
        """The record, and the file of --phi."""
        self.out, file = self.path("out.obj"), self.path("phi.json")
        record = self.record("map", *arguments, "-o", self.out, "--phi", file)
        read = json.loads(pathlib.Path(file).read_text(), parse_constant=lambda name: self.fail(name))
        jsonschema.validate(read, SCHEMA)
        for point in read["zeros_and_poles"]:
            self.assertAlmostEqual(sum(point["weights"]), 1, delta=1e-12)
        for key in ("mu", "phi"):
            self.assertEqual(len(read[key]), len(read["sample_faces"]))
            read[key] = np.array(read[key]) @ [1, 1j]
        return record, read

    def write(self, name, data):
        pathlib.Path(self.path(name)).write_text(data if isinstance(data, str) else json.dumps(data))
        return self.path(name)

    def doubled(self, read):
        """Twice the orders inside and those on the boundary."""
        return sum(p["order"] * (1 if p["on_boundary"] else 2) for p in read["zeros_and_poles"])

    def test_mu_is_that_of_the_faces_and_phi_belongs_to_it(self):
        record, read = self.map(self.bump_file(), "--boundary", "disk:0.6")
        v, vt, faces = read_obj(self.out)
        self.assertEqual((read["vertices"], read["faces"]), (len(v), len(faces)))
        self.assertEqual(read["sample_faces"], list(range(len(faces))))
        mu, area = first_edge_coefficients(v, vt, faces)
        np.testing.assert_allclose(read["mu"], mu, atol=1e-12)
        size = np.abs(read["phi"])
        self.assertAlmostEqual((area * size).sum() / area.sum(), 1, delta=1e-12)
        # μ = k conj(φ)/|φ| up to the noise of single faces, which has no mean.
        self.assertLess(abs((area * mu * read["phi"]).sum() / (area * size).sum() / record["map"]["k"] - 1), 0.02)

    def test_on_a_ring_phi_is_that_of_radii(self):
        points, faces = ring(inner=0.4)
        write_obj(self.path("ring.obj"), points, faces)
        target = self.write("t.json", {"outer": {"circle": [0, 0, 1]}, "holes": [{"circle": [0, 0, 0.2]}]})
        _, read = self.map(self.path("ring.obj"), "--onto", target)
        # φ = c/z² with c > 0 where radii are stretched: at the middles of the faces.
        z = points[faces].mean(axis=1) @ [1, 1j]
        first = (points[faces[:, 1]] - points[faces[:, 0]]) @ [1, 1j]
        in_plane = read["phi"] * (np.abs(first) / first) ** 2
        c = in_plane * z**2
        self.assertLess(np.abs(c / c.real.mean() - 1).max(), 1e-6)
        self.assertGreater(c.real.mean(), 0)
        self.assertEqual(read["zeros_and_poles"], [])
        self.assertFalse(read["tabulated"])

    def test_zeros_add_up_where_the_boundary_slides(self):
        points, faces = disk_with_holes(20, [((-0.4, 0), 0.2), ((0.4, 0.1), 0.18)])
        write_obj(self.path("two.obj"), points, faces)
        target = self.write("t.json", {"outer": {"circle": [0, 0, 1]},
                                       "holes": [{"circle": [-0.4, 0.1, 0.25]}, {"circle": [0.4, 0, 0.2]}]})
        _, read = self.map(self.path("two.obj"), "--onto", target)
        self.assertEqual(self.doubled(read), 4)  # −4χ
        self.assertTrue(all(p["order"] > 0 for p in read["zeros_and_poles"]))
        # φ is real along what slides, up to the size of a face.
        edges = boundary_edges(faces)
        imaginary = [abs(np.sin(np.angle(along(points, faces, read["phi"], f, (points[b] - points[a]) @ [1, 1j]))))
                     for (a, b), (f, _) in edges.items()]
        self.assertLess(np.mean(imaginary), 0.2)

    def test_marks_are_poles(self):
        points, faces = disk(16)
        write_obj(self.path("disk.obj"), points, faces)
        rim = np.arange(len(points) - 96, len(points))
        marks = {int(rim[i]): to for i, to in ((0, 0.1), (20, 1.1), (50, 3.2), (70, 4.9))}
        text = "".join(f"{v} {np.cos(t)!r} {np.sin(t)!r}\n" for v, t in marks.items())
        target = self.write("t.json", {"outer": {"circle": [0, 0, 1]}})
        _, read = self.map(self.path("disk.obj"), "--onto", target, "--marks", self.write("m.txt", text))
        self.assertEqual(self.doubled(read), -4)
        poles = [p for p in read["zeros_and_poles"] if p["order"] < 0]
        self.assertEqual({int(faces[p["face"]][np.argmax(p["weights"])]) for p in poles}, set(marks))
        for pole in poles:
            self.assertTrue(pole["on_boundary"])
            self.assertGreater(max(pole["weights"]), 1 - 1e-6)

    def test_a_pin_is_a_pole_on_the_mesh_that_was_mapped(self):
        points, faces = disk(12)
        write_obj(self.path("disk.obj"), points, faces)
        rim = np.nonzero(np.linalg.norm(points, axis=1) > 1 - 1e-9)[0]
        pin = int(faces[np.isin(faces, rim).sum(axis=1) == 2][0][~np.isin(faces[np.isin(faces, rim).sum(axis=1) == 2][0], rim)][0])
        image = points[pin] * 0.9
        text = "".join(f"{v} {points[v][0]!r} {points[v][1]!r}\n" for v in rim) + f"{pin} {image[0]!r} {image[1]!r}\n"
        record, read = self.map(self.path("disk.obj"), "--pin", self.write("pins.txt", text))
        self.assertGreater(record["split"]["edges"], 0)
        v, vt, faces = read_obj(self.out)
        self.assertEqual(read["faces"], len(faces))
        mu, _ = first_edge_coefficients(v, vt, faces)
        np.testing.assert_allclose(read["mu"], mu, atol=1e-10)
        poles = [p for p in read["zeros_and_poles"] if p["order"] < 0]
        self.assertEqual([int(faces[p["face"]][np.argmax(p["weights"])]) for p in poles], [pin])
        self.assertGreater(max(poles[0]["weights"]), 1 - 1e-6)

    def test_quads_have_four_samples(self):
        n = 10
        points = np.array([(i / n + 0.02 * np.sin(7 * j), j / n, 0) for j in range(n + 1) for i in range(n + 1)])
        quads = [(j * (n + 1) + i, j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i)
                 for j in range(n) for i in range(n)]
        write_obj(self.path("quads.obj"), points, quads)
        _, read = self.map(self.path("quads.obj"), "--boundary", "disk:0.3")
        v, vt, faces, _ = read_faces(self.out)
        self.assertEqual(read["sample_faces"], [f for f in range(len(faces)) for _ in range(4)])
        near = (1 - 1 / np.sqrt(3)) / 2
        places = [(near, near), (1 - near, near), (1 - near, 1 - near), (near, 1 - near)]
        for f in range(0, len(faces), 7):
            z, w = v[faces[f]] @ [1, 1j, 0], vt[faces[f]] @ [1, 1j]
            z = z / ((z[1] - z[0]) / abs(z[1] - z[0]))
            for q, (s, t) in enumerate(places):
                ds, dt = np.array([t - 1, 1 - t, t, -t]), np.array([s - 1, -s, s, 1 - s])
                zs, zt, ws, wt = z @ ds, z @ dt, w @ ds, w @ dt
                det = zs * zt.conjugate() - zt * zs.conjugate()
                mu = (zs * wt - zt * ws) / (ws * zt.conjugate() - wt * zs.conjugate())
                self.assertNotEqual(det, 0)
                self.assertAlmostEqual(abs(read["mu"][4 * f + q] - mu), 0, delta=1e-11)
        for point in read["zeros_and_poles"]:
            self.assertEqual(len(point["weights"]), 4)
            self.assertIn(0, point["weights"])

    def test_turning_and_scaling_the_source_changes_nothing(self):
        points, faces = bump(14)
        source, moved = self.path("a.obj"), self.path("b.obj")
        turn = np.array([[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
        write_obj(source, points, faces)
        write_obj(moved, 1000 * points @ turn + 7, faces)
        _, a = self.map(source, "--boundary", "disk:0.6")
        _, b = self.map(moved, "--boundary", "disk:0.6")
        np.testing.assert_allclose(a["phi"], b["phi"], atol=1e-5)
        np.testing.assert_allclose(a["mu"], b["mu"], atol=1e-6)
        self.assertEqual([p["order"] for p in a["zeros_and_poles"]], [p["order"] for p in b["zeros_and_poles"]])

    def test_a_conformal_map_has_none(self):
        points, faces = disk(10)
        write_obj(self.path("disk.obj"), points, faces)
        _, read = self.map(self.path("disk.obj"), "--onto", self.write("t.json", {"outer": {"circle": [0, 0, 2]}}))
        self.assertTrue((read["phi"] == 0).all())
        self.assertEqual(read["zeros_and_poles"], [])

    def test_conditions_that_mix(self):
        points, faces = ring(inner=0.5)
        write_obj(self.path("ring.obj"), points, faces)
        target = self.write("t.json", {"outer": {"circle": [0, 0, 1]}, "holes": [{"circle": [0, 0, 0.25]}]})
        _, read = self.map(self.path("ring.obj"), "--onto", target, "--boundary", "disk:0.3")
        for (a, b), (f, _) in boundary_edges(faces).items():
            if np.linalg.norm(points[a]) < 0.6:
                value = along(points, faces, read["phi"], f, (points[b] - points[a]) @ [1, 1j])
                self.assertLess(abs(np.sin(np.angle(value))), 0.3)

    def test_mu_of_a_ply_comes_back(self):
        for name, (points, faces) in {"space": bump(12), "plane": ring()}.items():
            source, out, again = self.path(name + ".obj"), self.path(name + ".ply"), self.path("again.obj")
            write_obj(source, points, faces)
            hole = [] if name == "space" else ["--hole", "1=disk:0,0,0.4"]
            self.run_command("map", source, "-o", out, "--boundary", "disk:0.3", *hole)
            self.run_command("map", source, "-o", self.path("map.obj"), "--boundary", "disk:0.3", *hole)
            self.run_command("flow", source, "--mu", out, "-o", again, "--boundary", "disk:0.3", *hole)
            np.testing.assert_allclose(read_obj(again)[1], read_obj(self.path("map.obj"))[1], atol=1e-9)

    def test_what_has_no_phi_is_refused(self):
        source = self.bump_file(6)
        arguments = ("map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.6", "--phi", self.path("phi.json"))
        for more, says in (("--each-component",), "--each-component"), (("--minimize", "max"), "no φ"), (("--method", "tutte"), "no φ"):
            self.assertIn(says, self.run_command(*arguments, *more, code=2).stderr)
        pins = self.write("pins.txt", "100 0 0\n110 1 0\n")
        text = self.run_command("map", source, "-o", self.path("out.obj"), "--pin", pins, "--phi", self.path("phi.json"), code=5).stderr
        self.assertIn("no φ", text)
        self.assert_nothing_left("bump.obj", "pins.txt")

    def test_files_that_cannot_be_written(self):
        source = self.bump_file(6)
        base = ("map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.6", "--phi")
        self.assertIn("/nowhere/phi.json", self.run_command(*base, "/nowhere/phi.json", code=7).stderr)
        self.assertIn("would overwrite SOURCE", self.run_command(*base, source, code=2).stderr)
        self.assertIn("are the same file", self.run_command(*base, self.path("out.obj"), code=2).stderr)
        self.assert_nothing_left("bump.obj")
        # What is there stays until the new file is whole.
        pathlib.Path(self.path("phi.json")).write_text("old")
        self.run_command("map", source, "-o", self.path("out.obj"), "--boundary", "polygon:/nowhere", "--phi",
                         self.path("phi.json"), code=3)
        self.assertEqual(pathlib.Path(self.path("phi.json")).read_text(), "old")
        self.assertIn("phi.json", self.run_command(*base, self.path("phi.json")).stdout)
        self.assert_nothing_left("bump.obj", "out.obj", "phi.json")
