"""The documentation against the project: links lead somewhere, options that pages name are the command's, every page and
example is listed."""

import json
import os
import pathlib
import re
import subprocess
import unittest

import jsonschema

from support import BELTRAMI, SCHEMA

ROOT = pathlib.Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
COMMANDS = ("info", "measure", "map", "flatten", "uniformize", "flow", "grid", "distance", "apply", "register", "transfer", "remesh", "deform", "image", "batch")
# Options of other programs in lines that do not call the command.
FOREIGN = {"--install", "--prefix", "--help", "--version", "--no-build-isolation"}
# Of Slurm, Dask and the cohorts in Python.
FOREIGN |= {"--ntasks", "--cpus-per-task", "--time", "--scheduler", "--scheduler-file", "--nthreads", "--death-timeout", "--workers"}


def anchors(path):
    """Headings as GitHub names them."""
    words = (re.sub(r"[^\w\- ]", "", line.lstrip("#").strip().lower()) for line in path.read_text().splitlines()
             if line.startswith("#"))
    return {word.replace(" ", "-") for word in words}


def options_of(text):
    return set(re.findall(r"(?<![\w-])--[a-z](?:[a-z-]*[a-z])?", text))


class Links(unittest.TestCase):
    def test_every_link_leads_somewhere(self):
        count = 0
        for page in PAGES:
            # Code is no link; in formulas "](" does not occur.
            text = re.sub(r"```.*?```|`[^`]*`", "", page.read_text(), flags=re.S)
            for target in re.findall(r"\]\(([^)\s]+)\)", text):
                if re.match(r"[a-z]+:", target):
                    continue
                place, _, anchor = target.partition("#")
                found = (page.parent / place).resolve() if place else page
                count += 1
                with self.subTest(page=page.name, link=target):
                    self.assertTrue(found.exists())
                    if anchor:
                        self.assertIn(anchor, anchors(found))
        self.assertGreater(count, 100)

    def test_every_page_and_example_is_listed(self):
        index = (ROOT / "docs" / "index.md").read_text()
        for page in (ROOT / "docs").rglob("*.md"):
            if page.name != "index.md":
                self.assertIn(f"({page.relative_to(ROOT / 'docs')})", index)
        readme = (ROOT / "README.md").read_text()
        examples = list((ROOT / "examples").glob("*.cpp"))
        self.assertTrue(examples)
        for example in examples:
            self.assertIn(f"(examples/{example.name})", readme)

    @unittest.skipUnless("BELTRAMI_JSON_RECORD" in os.environ, "BELTRAMI_JSON_RECORD names the example program")
    def test_the_record_of_the_example_obeys_the_schema(self):
        record = json.loads(subprocess.run([os.environ["BELTRAMI_JSON_RECORD"]], capture_output=True, check=True).stdout)
        jsonschema.validate(record, SCHEMA)
        self.assertEqual({"schema", "command", "source", "map", "solve", "warnings"}, set(record))

    def test_pictures_are_shown(self):
        shown = set(re.findall(r"\(gallery/([^)]+\.png)\)", "".join(p.read_text() for p in (ROOT / "docs").glob("*.md"))))
        self.assertEqual({p.name for p in (ROOT / "docs" / "gallery").glob("*.png")}, shown)
        shown = set(re.findall(r"pictures/([^)]+\.png)\)", "".join(p.read_text() for p in PAGES)))
        self.assertEqual({p.name for p in (ROOT / "docs" / "pictures").glob("*.png")}, shown)

    def test_sources_name_pages_that_exist(self):
        named = set()
        for folder in ("src", "cli", "bench", "tests", "examples"):
            for path in (ROOT / folder).rglob("*.[ch]*"):
                if path.is_file() and path.suffix in (".h", ".cpp"):
                    named |= set(re.findall(r"\bdocs/[\w/-]+\.md", path.read_text()))
        self.assertTrue(named)
        self.assertEqual([], sorted(name for name in named if not (ROOT / name).exists()))


class Options(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.known = {}
        for command in COMMANDS:
            text = subprocess.run([BELTRAMI, command, "--help"], capture_output=True, text=True, check=True).stdout
            # The names stand at the beginning of a line, before their explanation.
            cls.known[command] = {name for line in text.splitlines() if re.match(r"\s*-", line)
                                  for name in options_of(re.split(r"\s{2,}", line.strip())[0])}
        cls.all = set().union(*cls.known.values())

    def test_the_help_was_understood(self):
        self.assertLess({"--boundary", "--json", "--output", "--onto"}, self.known["map"])
        self.assertLess({"--inverse", "--quiet"}, self.known["apply"])

    def test_pages_name_options_that_exist(self):
        for page in PAGES:
            for number, line in enumerate(page.read_text().splitlines(), 1):
                # Tables: "\|" is no option; horizontal rules and Markdown comments neither.
                for option in options_of(re.sub(r"<!--.*?-->", "", line)) - FOREIGN:
                    with self.subTest(page=page.name, line=number):
                        self.assertIn(option, self.all)

    def test_calls_have_options_of_their_command(self):
        calls = 0
        for page in PAGES:
            for line in page.read_text().splitlines():
                call = re.match(r"    beltrami (\w+) ([^#]*)", line)
                if not call:
                    continue
                calls += 1
                with self.subTest(page=page.name, call=line.strip()):
                    self.assertIn(call[1], COMMANDS)
                    self.assertLessEqual(options_of(call[2]), self.known[call[1]])
        self.assertGreater(calls, 20)

    def test_what_all_commands_take(self):
        """As README.md says below the calls."""
        for command, known in self.known.items():
            with self.subTest(command=command):
                self.assertIn("--quiet", known)
                self.assertEqual(command not in ("apply", "image", "transfer", "batch"), {"--json", "--threads"} <= known)
                self.assertEqual(command not in ("info", "distance", "apply", "image", "transfer", "batch"), "--report" in known)


if __name__ == "__main__":
    unittest.main()
