"""The command as its users meet it: meshes, files and a base class for the tests. BELTRAMI names the binary; real scans
come from BELTRAMI_TEST_MESHES."""

import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import jsonschema
import numpy as np

BELTRAMI = os.environ["BELTRAMI"]
MESHES = pathlib.Path(os.environ.get("BELTRAMI_TEST_MESHES", ""))
SCHEMA = json.loads((pathlib.Path(__file__).parents[2] / "docs" / "record.schema.json").read_text())


def disk(rings):
    """Points (n×2) and triangles of the unit disk in concentric rings."""
    points, first = [(0.0, 0.0)], [0]
    for r in range(1, rings + 1):
        first.append(len(points))
        points += [(r / rings * math.cos(t), r / rings * math.sin(t)) for t in (2 * math.pi * j / (6 * r) for j in range(6 * r))]
    at = lambda r, j: 0 if r == 0 else first[r] + j % (6 * r)
    faces = []
    for r in range(1, rings + 1):
        for s in range(6):
            for j in range(r):
                a, b = s * r + j, s * (r - 1) + j
                faces.append((at(r - 1, b), at(r, a), at(r, a + 1)))
                if j < r - 1:
                    faces.append((at(r - 1, b), at(r, a + 1), at(r - 1, b + 1)))
    return np.array(points), np.array(faces)


def moebius(n):
    """A Möbius strip of n quads, each of two triangles, cut into a rectangle by vt: #V×3, triangles, vt, triangles of vt."""
    points, vt, faces, corners = [], [], [], []
    for i in range(n + 1):
        t = 2 * math.pi * i / n
        for side in (-0.3, 0.3):
            r = 1 + side * math.cos(t / 2)
            if i < n:
                points.append((r * math.cos(t), r * math.sin(t), side * math.sin(t / 2)))
            vt.append((t, side))
    for i in range(n):
        a, b, c, d = 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1
        corners += [(a, b, c), (a, c, d)]
        glued = [a, b, c, d] if i < n - 1 else [a, 1, 0, d]
        faces += [(glued[0], glued[1], glued[2]), (glued[0], glued[2], glued[3])]
    return np.array(points), np.array(faces), np.array(vt), np.array(corners)


def bump(rings):
    points, faces = disk(rings)
    z = 0.5 * np.exp(-4 * ((points[:, 0] - 0.2) ** 2 + points[:, 1] ** 2))
    return np.column_stack([points, z]), faces


def ring(around=48, layers=16, inner=0.3):
    """Points and triangles of inner ≤ |z| ≤ 1 in geometric layers; the outer circle is the last."""
    r = inner ** (1 - np.arange(layers + 1) / layers)
    t = 2 * np.pi * (np.arange(around)[None, :] + 0.5 * (np.arange(layers + 1)[:, None] % 2)) / around
    points = np.column_stack([(r[:, None] * np.cos(t)).ravel(), (r[:, None] * np.sin(t)).ravel()])
    faces = []
    for l in range(layers):
        for i in range(around):
            a, b = l * around + i, l * around + (i + 1) % around
            c, d = a + around, b + around
            faces += [(a, c, b), (b, c, d)] if l % 2 == 0 else [(a, c, d), (a, d, b)]
    faces = np.array(faces)
    p, q, w = (points[faces[:, i]] for i in range(3))
    assert (np.cross(q - p, w - p) > 0).all()
    return points, faces


def disk_with_holes(rings, holes):
    """The disk in rings without the faces that come nearer than r to c, for each hole (c, r)."""
    points, faces = disk(rings)
    keep = np.ones(len(faces), bool)
    for centre, radius in holes:
        keep &= (np.linalg.norm(points - centre, axis=1)[faces] > radius).all(axis=1)
    faces = faces[keep]
    used = np.unique(faces)
    return points[used], np.searchsorted(used, faces)


def write_obj(path, points, faces, vt=None):
    points = np.column_stack([points, np.zeros(len(points))]) if points.shape[1] == 2 else points
    with open(path, "w") as out:
        out.writelines("v %r %r %r\n" % tuple(map(float, p)) for p in points)
        if vt is not None:
            out.writelines("vt %r %r\n" % tuple(map(float, p)) for p in vt)
        for f in faces:
            out.write("f " + " ".join(f"{i + 1}/{i + 1}" if vt is not None else str(i + 1) for i in f) + "\n")


def read_faces(path):
    """v, vt and faces of any degree, with the material in use at each."""
    v, vt, faces, materials, material = [], [], [], [], None
    for line in pathlib.Path(path).read_text().splitlines():
        word, *rest = line.split()
        if word == "v":
            v.append([float(x) for x in rest])
        elif word == "vt":
            vt.append([float(x) for x in rest])
        elif word == "usemtl":
            material = rest[0]
        elif word == "f":
            faces.append([int(c.split("/")[0]) - 1 for c in rest])
            materials.append(material)
    return np.array(v), np.array(vt), faces, materials


def read_obj(path):
    v, vt, faces, _ = read_faces(path)
    return v, vt, np.array(faces)


def abs_mu(source, image, faces):
    """|μ| per face from the singular values of the Jacobian; > 1 where the determinant is negative."""
    e1, e2 = source[faces[:, 1]] - source[faces[:, 0]], source[faces[:, 2]] - source[faces[:, 0]]
    length = np.linalg.norm(e1, axis=1)
    x = np.einsum("ij,ij->i", e1, e2) / length
    y = np.linalg.norm(np.cross(e1, e2), axis=1) / length
    S = np.zeros((len(faces), 2, 2))
    S[:, 0, 0], S[:, 0, 1], S[:, 1, 1] = length, x, y
    I = np.stack([image[faces[:, 1]] - image[faces[:, 0]], image[faces[:, 2]] - image[faces[:, 0]]], axis=2)
    J = I @ np.linalg.inv(S)
    sigma = np.linalg.svd(J, compute_uv=False)
    k = (sigma[:, 0] - sigma[:, 1]) / (sigma[:, 0] + sigma[:, 1])
    flipped = np.linalg.det(J) < 0
    return np.where(flipped, 1 / np.where(k == 0, 1, k), k), y * length / 2


class Command(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def path(self, name):
        return str(self.folder / name)

    def run_command(self, *arguments, code=0):
        done = subprocess.run([BELTRAMI, *map(str, arguments)], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def record(self, *arguments, code=0):
        record = json.loads(self.run_command(*arguments, "--json", "-", code=code).stdout)
        jsonschema.validate(record, SCHEMA)
        return record

    def bump_file(self, rings=16):
        points, faces = bump(rings)
        write_obj(self.path("bump.obj"), points, faces)
        return self.path("bump.obj")

    def assert_nothing_left(self, *expected):
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), sorted(expected))
