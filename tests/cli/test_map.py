"""beltrami map of surfaces without holes."""

import json
import math
import os
import re
import signal
import subprocess
import time
import unittest

import numpy as np

from support import BELTRAMI, Command, abs_mu, bump, disk, read_obj, write_obj


class Map(Command):
    def test_extremal_map_of_a_bump(self):
        source = self.bump_file()
        record = self.record("map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.6", "--report", self.path("out.html"),
                             "--compare", "harmonic,arap,mips,lscm,alternation,qc")
        m = record["map"]
        self.assertEqual(m["flipped"], 0)
        self.assertLessEqual(m["K_lower"], m["K"])
        self.assertLessEqual(m["K"], m["K_max"])
        self.assertEqual(record["solve"]["termination"], "converged")
        self.assertGreater(record["solve"]["seconds"]["harmonic"], 0)
        self.assertEqual([c["method"] for c in record["comparison"]], ["harmonic", "arap", "mips", "lscm", "alternation", "qc"])
        for other in record["comparison"][:3]:
            self.assertLess(m["mu"]["std"], other["map"]["mu"]["std"], other["method"])
            self.assertNotIn("k", other["map"])
        # OUT is the source with the map as vt; measure finds what the record says.
        v, vt, f = read_obj(self.path("out.obj"))
        w, _, g = read_obj(source)
        np.testing.assert_array_equal(v, w)
        np.testing.assert_array_equal(f, g)
        self.assertEqual(len(vt), len(v))
        measured = self.record("measure", self.path("out.obj"))["map"]
        for key in ("mean", "std", "p99", "max"):
            self.assertAlmostEqual(measured["mu"][key], m["mu"][key], delta=1e-12)
        expected, area = abs_mu(v, vt, f)
        self.assertAlmostEqual(m["mu"]["mean"], (area * expected).sum() / area.sum(), delta=1e-12)
        self.assertTrue((self.folder / "out.html").read_text().startswith("<!"))

    def test_boundary_values_are_where_the_option_says(self):
        source = self.bump_file(10)
        v, _, _ = read_obj(source)
        loop = list(range(len(v) - 60, len(v)))
        start = loop[7]
        self.run_command("map", source, "-o", self.path("out.obj"), "--method", "harmonic", "--boundary", "disk:0.5", "--first-vertex", start)
        _, vt, _ = read_obj(self.path("out.obj"))
        order = loop[7:] + loop[:7]
        lengths = [np.linalg.norm(v[order[(i + 1) % 60]] - v[order[i]]) for i in range(60)]
        t = 2 * np.pi * np.concatenate([[0], np.cumsum(lengths)[:-1]]) / sum(lengths)
        angle = t + 0.5 * np.sin(t)
        np.testing.assert_allclose(vt[order], np.column_stack([np.cos(angle), np.sin(angle)]), atol=1e-12)

    def test_rectangle_with_corners(self):
        source = self.bump_file(12)
        n = len(read_obj(source)[0])
        corners = [n - 72 + i for i in (0, 20, 36, 55)]
        for speed in ("arclength", "conformal"):
            self.run_command("map", source, "-o", self.path("out.obj"), "--method", "harmonic", "--boundary", "rectangle:2,1", "--corners",
                             ",".join(map(str, corners)), "--speed", speed)
            _, vt, _ = read_obj(self.path("out.obj"))
            np.testing.assert_allclose(vt[corners], [[0, 0], [2, 0], [2, 1], [0, 1]], atol=1e-12)
            np.testing.assert_allclose(vt[n - 72 : n - 52, 1], 0, atol=1e-9)
            self.assertTrue((np.diff(vt[n - 72 : n - 51, 0]) > 0).all())

    def test_polygon(self):
        source = self.bump_file(14)
        polygon = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2), (0, 2)]
        (self.folder / "l.txt").write_text("# an L\n" + "".join(f"{x} {y}\n" for x, y in polygon))
        for speed in ("arclength", "conformal"):
            m = self.record("map", source, "-o", self.path("out.obj"), "--boundary", f"polygon:{self.path('l.txt')}", "--speed", speed)["map"]
            v, vt, f = read_obj(self.path("out.obj"))
            for corner in polygon:
                self.assertLess(np.abs(vt - corner).sum(axis=1).min(), 1e-12)
            # Arc length opens the half-plane of angles at the reflex corner to three right angles, which the faces there
            # are too few to follow: one of them may be turned over. Conformal speed opens them as they are.
            flipped = np.flatnonzero(abs_mu(v, vt, f)[0] > 1)
            self.assertEqual(m["flipped"], len(flipped))
            self.assertLessEqual(len(flipped), 1 if speed == "arclength" else 0)
            for face in flipped:
                self.assertLess(np.abs(vt[f[face]] - (1, 1)).sum(axis=1).min(), 1e-12)

    def test_pins(self):
        points, faces = disk(8)
        write_obj(self.path("disk.obj"), points, faces)
        n = len(points)
        with open(self.path("pins.txt"), "w") as out:
            for v in range(n - 48, n):
                z = complex(*points[v])
                w = z + 0.25 * z.conjugate()
                out.write(f"{v} {w.real!r} {w.imag!r}  # comment\n")
        m = self.record("map", self.path("disk.obj"), "-o", self.path("out.ply"), "--pin", self.path("pins.txt"))["map"]
        self.assertAlmostEqual(m["k"], 0.25, delta=1e-6)
        (self.folder / "few.txt").write_text("200 1 0\n")
        failed = self.run_command("map", self.path("disk.obj"), "-o", self.path("no.obj"), "--pin", self.path("few.txt"), code=5)
        self.assertIn("boundary loop 0", failed.stderr)
        self.assertFalse((self.folder / "no.obj").exists())

    def test_boundary_values_without_a_map_are_refused(self):
        points, faces = disk(8)
        write_obj(self.path("disk.obj"), points, faces)
        z = points @ [1, 1j]
        t = np.angle(z)
        images = {"clockwise": z.conj(), "one point": 0 * z + (0.5 + 0.5j), "there and back": z.real + 0j,
                  "figure eight": np.sin(t) + 0.5j * np.sin(2 * t), "crossing": np.exp(1j * t) * (0.5 + np.cos(t))}
        for name, image in images.items():
            with self.subTest(name), open(self.path("pins.txt"), "w") as out:
                out.writelines(f"{v} {float(image[v].real)!r} {float(image[v].imag)!r}\n" for v in range(len(z) - 48, len(z)))
                out.flush()
                failed = self.run_command("map", self.path("disk.obj"), "-o", self.path("o.obj"), "--pin", self.path("pins.txt"), code=5)
                self.assertTrue(failed.stderr)
                self.assertFalse((self.folder / "o.obj").exists())

    def test_baselines_want_one_component_with_a_boundary(self):
        points, faces = bump(4)
        write_obj(self.path("two.obj"), np.vstack([points, points + [3, 0, 0]]), np.vstack([faces, faces + len(points)]))
        write_obj(self.path("closed.obj"), np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
                  np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
        for method in ("harmonic", "lscm", "arap", "mips", "alternation", "qc"):
            failed = self.run_command("map", self.path("two.obj"), "-o", self.path("o.obj"), "--method", method, code=4)
            self.assertIn("the mesh has 2 components", failed.stderr)
            failed = self.run_command("map", self.path("closed.obj"), "-o", self.path("o.obj"), "--method", method, code=4)
            self.assertIn("closed", failed.stderr)

    def test_seconds_leave_out_the_reading_of_files(self):
        source = self.bump_file(4)
        points = bump(4)[0]
        pins = "".join(f"{v} {float(x)!r} {float(y)!r}\n" for v, (x, y, _) in list(enumerate(points))[-24:])
        os.mkfifo(self.path("slow.txt"))
        slow = subprocess.Popen(["sh", "-c", f"sleep 1; cat > '{self.path('slow.txt')}'"], stdin=subprocess.PIPE, text=True)
        slow.stdin.write(pins)
        slow.stdin.close()
        record = self.record("map", source, "-o", self.path("out.obj"), "--pin", self.path("slow.txt"))
        slow.wait(timeout=60)
        self.assertLess(record["solve"]["seconds"]["total"], 0.5)

    def test_metric(self):
        points, faces = disk(8)
        stretched = points * [1.25, 0.75]
        write_obj(self.path("disk.obj"), points, faces, stretched)
        edges = {tuple(sorted((f[i], f[(i + 1) % 3]))) for f in faces.tolist() for i in range(3)}
        with open(self.path("metric.txt"), "w") as out:
            out.writelines(f"{a} {b} {float(np.linalg.norm(stretched[a] - stretched[b]))!r}\n" for a, b in sorted(edges))
        k = [self.record("map", self.path("disk.obj"), "-o", self.path("out.obj"), "--boundary", "disk", "--metric", metric)["map"]["k"]
             for metric in ("vt", self.path("metric.txt"))]
        self.assertAlmostEqual(k[0], k[1], delta=1e-9)
        self.assertGreater(k[0], 0.1)  # the identity of the boundary is far from conformal in that metric
        self.assertLess(self.record("map", self.path("disk.obj"), "-o", self.path("out.obj"), "--boundary", "disk")["map"]["k"], 1e-6)

    def test_a_folded_parametrisation_is_corrected_in_its_own_metric(self):
        points, faces = disk(10)
        rng, folded = np.random.default_rng(5), points.copy()
        inner = np.linalg.norm(points, axis=1) < 0.95
        folded[inner] += rng.uniform(-0.06, 0.06, (inner.sum(), 2))
        write_obj(self.path("folded.obj"), points, faces, folded)
        self.assertGreater(self.record("measure", self.path("folded.obj"))["map"]["flipped"], 20)
        record = self.record("map", self.path("folded.obj"), "-o", self.path("out.obj"), "--metric", "vt", "--boundary", "disk")
        self.assertEqual(record["map"]["flipped"], 0)
        source, corrected, triangles = read_obj(self.path("out.obj"))
        self.assertTrue((abs_mu(source, corrected, triangles)[0] < 1).all())

    def test_every_method_writes_every_format(self):
        source = self.bump_file(8)
        for method in ("extremal", "harmonic", "lscm", "arap", "mips", "alternation", "qc"):
            for extension in ("obj", "ply", "off"):
                self.run_command("map", source, "-o", self.path(f"out.{extension}"), "--method", method, "--boundary", "disk:0.3", "--quiet")
        self.run_command("map", source, "-o", self.path("positions.obj"), "--boundary", "disk:0.3", "--as-positions")
        v, _, _ = read_obj(self.path("positions.obj"))
        self.assertTrue((v[:, 2] == 0).all())
        self.assertAlmostEqual(np.linalg.norm(v, axis=1).max(), 1, delta=1e-12)

    def test_free_boundaries(self):
        source = self.bump_file(8)
        for method in ("lscm", "arap", "mips"):
            self.assertEqual(self.record("map", source, "-o", self.path("out.obj"), "--method", method)["map"]["flipped"], 0)

    def test_threads_give_the_same_bytes(self):
        source = self.bump_file(20)
        texts = []
        for threads in (1, 2, 5):
            self.run_command("map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.8", "--threads", threads)
            texts.append((self.folder / "out.obj").read_bytes())
        self.assertEqual(texts[0], texts[1])
        self.assertEqual(texts[0], texts[2])

    def test_silent_in_a_pipe_and_quiet_on_request(self):
        source = self.bump_file()
        map_it = ["map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.6"]
        done = self.run_command(*map_it)
        self.assertEqual(done.stderr, "")
        self.assertIn("extremal", done.stdout)
        self.assertEqual(self.run_command(*map_it, "--quiet").stdout, "")
        self.assertEqual(self.run_command(*map_it, "--quiet").stderr, "")

    def test_what_the_lower_bound_says(self):
        source = self.bump_file()
        map_it = ["map", source, "-o", self.path("out.obj"), "--boundary", "disk:0.6"]
        said = re.search(r"no map with these boundary values stretches less than K = (\S+) \((.*)\)\nthis one: about (\S+), at most (\S+) on 99 %",
                         self.run_command(*map_it, "--json", self.path("out.json")).stdout)
        m = json.loads((self.folder / "out.json").read_text())["map"]
        self.assertLessEqual(float(said[1]), m["K_lower"])
        self.assertGreater(float(said[1]), m["K_lower"] - 1.001e-3)
        # Of a surface the bound of φ is an estimate, and what is proved is said beside it.
        self.assertFalse(any(b["rigorous"] for b in m["bounds"] if b["kind"] == "reich_strebel"))
        self.assertLess(m["K_lower_proved"], m["K_lower"])
        self.assertEqual(said[2], "estimate; proved: K = %.3f" % (math.floor(1e3 * m["K_lower_proved"]) / 1e3))
        stretch = lambda mu: (1 + mu) / (1 - mu)
        self.assertAlmostEqual(float(said[3]), stretch(m["mu"]["mean"]), delta=5.001e-4)
        self.assertGreaterEqual(float(said[4]), stretch(m["mu"]["p99"]) - 1e-12)
        self.assertNotIn("no map", self.run_command(*map_it, "--json", "-").stdout)
        self.assertNotIn("no map", self.run_command(*map_it, "--method", "harmonic").stdout)

    def test_ctrl_c_leaves_nothing(self):
        points, faces = bump(230)
        write_obj(self.path("large.obj"), points, faces)
        codes = []
        for seconds in (0.1, 0.5, 1.2):
            for before in (None, "as it was\n"):
                out = self.folder / "out.obj"
                out.unlink(missing_ok=True)
                if before:
                    out.write_text(before)
                child = subprocess.Popen([BELTRAMI, "map", self.path("large.obj"), "-o", out, "--boundary", "disk:0.5", "--json",
                                          self.path("out.json")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(seconds)
                child.send_signal(signal.SIGINT)
                codes.append(child.wait(timeout=60))
                if codes[-1] != 130:
                    (self.folder / "out.json").unlink(missing_ok=True)
                elif before:
                    self.assertEqual(out.read_text(), before)
                    self.assert_nothing_left("large.obj", "out.obj")
                else:
                    self.assert_nothing_left("large.obj")
        self.assertIn(130, codes[::2])
        self.assertIn(130, codes[1::2])


if __name__ == "__main__":
    unittest.main()
