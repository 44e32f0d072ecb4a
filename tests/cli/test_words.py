"""What the library says: to programmers, who know no options of the command."""

import json
import pathlib
import re
import unittest

import jsonschema

from support import SCHEMA, Command, disk, write_obj

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
        # A circle to a square by arc length: the corners alone force K = 2.
        points, faces = disk(16)
        write_obj(self.path("disk.obj"), points, faces)
        done = self.run_command("map", self.path("disk.obj"), "-o", self.path("out.obj"), "--boundary", "rectangle:1,1",
                                "--json", self.path("out.json"))
        record = json.loads((self.folder / "out.json").read_text())
        jsonschema.validate(record, SCHEMA)
        self.assertEqual(len(record["warning_details"]), len(record["warnings"]))
        corner = [row for row in record["warning_details"] if row["kind"] == "corner"]
        self.assertEqual(len(corner), 1)
        self.assertEqual((corner[0]["of"], corner[0]["count"]), ("vertices", 1))
        self.assertEqual(corner[0]["indices"], [record["corners"]["sharpest"]["vertex"]])
        self.assertIn("hint: --speed conformal", done.stderr)
        self.assertNotIn("--", done.stderr.split("hint: ")[0])


if __name__ == "__main__":
    unittest.main()
