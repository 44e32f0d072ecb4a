"""What the command refuses, and how."""

import json
import os
import subprocess
import unittest

from support import Command, bump, disk, read_obj, write_obj


class Mistakes(Command):
    def test_unknown_flags_are_refused_with_a_suggestion(self):
        failed = self.run_command("map", "x.obj", "-o", "y.obj", "--boundry", "disk", code=2)
        self.assertIn("--boundary", failed.stderr)
        self.assertIn("measure", self.run_command("mesure", "x.obj", code=2).stderr)
        self.run_command("info", "x.obj", "--sped", "1", code=2)
        self.run_command(code=2)

    def test_help_has_examples_and_exit_codes(self):
        for arguments in (["--help"], ["map", "--help"]):
            text = self.run_command(*arguments).stdout
            self.assertIn("Exit codes", text)
        self.assertIn("beltrami map", self.run_command("--help").stdout)

    def test_files_that_cannot_be(self):
        self.assertIn("missing.obj", self.run_command("info", self.path("missing.obj"), code=3).stderr)
        (self.folder / "bad.obj").write_text("v 0 0 0\nv 1 0 0\nf 1 2 7\n")
        self.assertIn("bad.obj:3", self.run_command("info", self.path("bad.obj"), code=3).stderr)
        source = self.bump_file(4)
        before = sorted(p.name for p in self.folder.iterdir())
        self.run_command("map", source, "-o", self.path("no/such/folder.obj"), "--boundary", "disk", code=7)
        for name in ("out.xyz", "out", "out.stl"):
            self.assertIn(".ply", self.run_command("map", source, "-o", self.path(name), "--boundary", "disk", code=2).stderr)
            self.run_command("flatten", source, "-o", self.path(name), code=2)
        self.assert_nothing_left(*before)

    def test_no_output_is_written_where_another_cannot_be(self):
        source = self.bump_file(4)
        write_obj(self.path("vt.obj"), *bump(4), bump(4)[0][:, :2])
        before = sorted(p.name for p in self.folder.iterdir())
        out, nowhere = self.path("o.obj"), self.path("no/such/folder.x")
        for option in ("--json", "--report"):
            self.run_command("map", source, "-o", out, "--boundary", "disk", option, nowhere, code=7)
            self.run_command("flatten", source, "-o", out, option, nowhere, code=7)
        self.run_command("map", source, "-o", out, "--boundary", "disk", "--json", self.folder, code=7)
        self.run_command("measure", self.path("vt.obj"), "--json", self.path("o.json"), "--report", nowhere, code=7)
        self.run_command("info", source, "--json", nowhere, code=7)
        # Before anything is computed: even where the mesh has no map.
        self.run_command("map", source, "-o", out, "--json", nowhere, code=7)
        self.assert_nothing_left(*before)

    def test_outputs_that_are_one_file_or_an_input(self):
        source = self.bump_file(4)
        n = len(bump(4)[0])
        (self.folder / "l.txt").write_text("0 0\n2 0\n0 2\n")
        (self.folder / "pins.txt").write_text(f"{n - 1} 1 0\n")
        (self.folder / "metric.txt").write_text("0 1 1\n")
        os.link(source, self.path("link.obj"))
        os.symlink(source, self.path("soft.obj"))
        write_obj(self.path("vt.obj"), *bump(4), bump(4)[0][:, :2])
        before = {p.name: p.read_bytes() for p in self.folder.iterdir()}
        out, new = self.path("o.obj"), self.path("new")
        by_another_name = f"{self.folder}/../{self.folder.name}/new"
        disk, files = ["--boundary", "disk"], lambda name: [self.path(name)]
        for arguments in (
            ["map", source, "-o", out, *disk, "--json", new, "--report", new],
            ["map", source, "-o", out, *disk, "--json", new, "--report", by_another_name],
            ["map", source, "-o", out, *disk, "--json", out],
            ["map", source, "-o", out, *disk, "--report", out],
            ["map", source, "-o", out, *disk, "--json", source],
            ["map", source, "-o", out, *disk, "--report", source],
            ["map", source, "-o", out, *disk, "--json", *files("link.obj")],
            ["map", source, "-o", out, *disk, "--json", *files("soft.obj")],
            ["map", source, "-o", out, "--boundary", "polygon:" + self.path("l.txt"), "--json", *files("l.txt")],
            ["map", source, "-o", out, *disk, "--pin", *files("pins.txt"), "--report", *files("pins.txt")],
            ["map", source, "-o", out, *disk, "--metric", *files("metric.txt"), "--json", *files("metric.txt")],
            ["flatten", source, "-o", out, "--json", out],
            ["flatten", source, "-o", out, "--json", source],
            ["measure", *files("vt.obj"), "--json", *files("vt.obj")],
            ["measure", source, *files("vt.obj"), "--report", *files("vt.obj")],
            ["info", source, "--json", source],
        ):
            with self.subTest(arguments):
                self.run_command(*arguments, code=2)
                self.assertEqual({p.name: p.read_bytes() for p in self.folder.iterdir()}, before)
        # Devices can be shared, pipes take what they are given, and OUT may replace SOURCE.
        self.run_command("map", source, "-o", source, *disk, "--json", "/dev/null", "--report", "/dev/null")
        self.assertEqual(len(read_obj(source)[1]), n)
        os.mkfifo(self.path("pipe"))
        reader = subprocess.Popen(["cat", self.path("pipe")], stdout=subprocess.PIPE, text=True)
        self.run_command("info", source, "--json", self.path("pipe"))
        self.assertEqual(json.loads(reader.communicate(timeout=60)[0])["command"], "info")
        done = self.run_command("info", source, "--json", "/dev/stdout", "--quiet")
        self.assertEqual(json.loads(done.stdout)["command"], "info")

    def test_bad_values(self):
        source = self.bump_file(4)
        out = ["-o", self.path("o.obj")]
        for arguments in (["--boundary", "disc"], ["--boundary", "disk:x"], ["--boundary", "disk:1.5"], ["--boundary", "rectangle:1"],
                          ["--boundary", "rectangle:1,-1"], ["--boundary", "disk", "--corners", "1,2,3,4"], ["--method", "best"],
                          ["--boundary", "disk", "--threads", "0"], ["--first-vertex", "3"]):
            self.run_command("map", source, *out, *arguments, code=2)
        (self.folder / "bow.txt").write_text("0 0\n1 1\n1 0\n0 1\n")
        (self.folder / "clockwise.txt").write_text("0 0\n0 1\n1 0\n")
        for arguments in ([], ["--boundary", "disk", "--first-vertex", "0"], ["--boundary", "rectangle:1,1", "--corners", "60,50,40,37"],
                          ["--boundary", f"polygon:{self.path('bow.txt')}"], ["--boundary", f"polygon:{self.path('clockwise.txt')}"]):
            self.run_command("map", source, *out, *arguments, code=5)
        self.assertFalse((self.folder / "o.obj").exists())

    def test_holes_must_be_prescribed(self):
        points, faces = disk(6)
        write_obj(self.path("annulus.obj"), points, faces[faces.min(axis=1) > 0])
        failed = self.run_command("map", self.path("annulus.obj"), "-o", self.path("o.obj"), "--boundary", "disk", code=5)
        self.assertIn("boundary loop 1", failed.stderr)
        self.assertIn("--hole", failed.stderr)


if __name__ == "__main__":
    unittest.main()
