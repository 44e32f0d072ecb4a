"""What ./run demo does and promises. BELTRAMI names the binary, BELTRAMI_OPEN_SCAN the example program that opens a closed
scan by a plane, BELTRAMI_BUNNY the closed bunny."""

import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import jsonschema
import numpy as np

from support import SCHEMA, read_obj

BUNNY = pathlib.Path(os.environ["BELTRAMI_BUNNY"])


@unittest.skipUnless(BUNNY.exists(), f"no {BUNNY}: ./run demo fetches it")
class Demo(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.scan, cls.out = cls.folder / "scan.obj", cls.folder / "bunny.obj"
        subprocess.run([os.environ["BELTRAMI_OPEN_SCAN"], BUNNY, "0.8", cls.scan], check=True, stdout=subprocess.DEVNULL)
        done = subprocess.run([os.environ["BELTRAMI"], "map", cls.scan, "-o", cls.out, "--boundary", "disk:0.9", "--compare",
                               "harmonic,arap,mips,lscm", "--json", cls.folder / "bunny.json", "--report", cls.folder / "bunny.html"],
                              check=True, capture_output=True, text=True)
        cls.printed = done.stdout
        cls.record = json.loads((cls.folder / "bunny.json").read_text())

    def test_the_map_is_extremal_and_proves_it(self):
        jsonschema.validate(self.record, SCHEMA)
        m = self.record["map"]
        self.assertEqual(m["flipped"], 0)
        self.assertEqual(self.record["solve"]["termination"], "converged")
        self.assertLessEqual(m["K_lower"], m["K"])
        self.assertLessEqual(m["K"], m["K_max"])
        self.assertLessEqual((m["K"] - m["K_lower"]) / m["K"], 0.01)
        self.assertLess(abs(m["k"] - 0.157), 0.003)

    def test_it_beats_the_other_methods(self):
        mu = self.record["map"]["mu"]
        others = {other["method"]: other["map"] for other in self.record["comparison"]}
        self.assertEqual(set(others), {"harmonic", "arap", "mips", "lscm"})
        for method in ("harmonic", "arap", "mips"):
            self.assertLessEqual(mu["std"], 0.6 * others[method]["mu"]["std"], method)
            self.assertLess(mu["p99"], others[method]["mu"]["p99"], method)

    def test_the_mesh_is_the_scan_with_the_map_as_texture(self):
        v, vt, f = read_obj(self.out)
        w, _, g = read_obj(self.scan)
        np.testing.assert_array_equal(v, w)
        np.testing.assert_array_equal(f, g)
        self.assertEqual(len(vt), len(v))
        self.assertAlmostEqual(np.linalg.norm(vt, axis=1).max(), 1, delta=1e-12)

    def test_the_table_and_the_files_are_printed(self):
        for word in ("extremal", "harmonic", "arap", "mips", "lscm", "K_lower", "iterations", "seconds", "no map with these boundary values",
                     "bunny.obj", "bunny.json", "bunny.html"):
            self.assertIn(word, self.printed)

    def test_the_page_fetches_nothing(self):
        page = (self.folder / "bunny.html").read_text()
        self.assertTrue(page.startswith("<!"))
        page = re.sub(r"http://www\.w3\.org/(1999/xhtml|2000/svg)\b", "", page)  # names of XML namespaces
        self.assertIsNone(re.search(r"https?:|(src|href)\s*=\s*[\"']?//|@import", page))


if __name__ == "__main__":
    unittest.main()
