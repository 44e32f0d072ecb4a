"""What the library says: to programmers, who know no options of the command."""

import json
import pathlib
import re
import unittest

from support import Command, bump, write_obj

SOURCES = pathlib.Path(__file__).parents[2] / "src" / "beltrami"
STRING = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def sentences(text):
    """The strings of a C++ file, without comments."""
    for line in text.splitlines():
        line = line.strip()
        if line.startswith(("//", "#include")):
            continue
        yield from STRING.findall(line)


class Library(unittest.TestCase):
    def test_names_no_option_of_the_command(self):
        files = [path for suffix in ("*.cpp", "*.h") for path in SOURCES.rglob(suffix)]
        self.assertGreater(len(files), 200)
        said = [(path.name, sentence) for path in files for sentence in sentences(path.read_text())]
        self.assertGreater(len(said), 1000)
        flags = [(name, sentence) for name, sentence in said if re.search(r"(^|[^\w-])--[a-z]|`beltrami ", sentence)]
        self.assertEqual(flags, [])

    def test_flags_are_found(self):
        self.assertEqual(list(sentences('// "--a"\n    throw Error(x, "leave out --b");\n')), ["leave out --b"])


class Hints(Command):
    """The command words the next step."""

    def test_free_boundary(self):
        said = self.run_command("map", self.bump_file(8), "-o", self.path("out.obj"), code=5).stderr
        self.assertNotIn("--", said.split("hint: ")[0])
        self.assertIn("--minimize max", said.split("hint: ")[1])

    def test_corner(self):
        points, faces = bump(12)
        write_obj(self.path("bump.obj"), points, faces)
        done = self.run_command("map", self.path("bump.obj"), "-o", self.path("out.obj"), "--boundary", "rectangle:3,1",
                                "--json", self.path("out.json"))
        details = json.loads((self.folder / "out.json").read_text())["warning_details"]
        self.assertIn("corner", [row["kind"] for row in details])
        self.assertIn("hint: --speed conformal", done.stderr)


if __name__ == "__main__":
    unittest.main()
