"""beltrami flatten."""

import unittest

import numpy as np

from support import Command, read_obj


class Flatten(Command):
    def test_flatten(self):
        source = self.bump_file(14)
        for arguments in ([], ["--disk"]):
            record = self.record("flatten", source, "-o", self.path("flat.obj"), *arguments)
            self.assertLess(record["map"]["mu"]["mean"], 0.05)
            self.assertEqual(record["map"]["flipped"], 0)
        _, vt, _ = read_obj(self.path("flat.obj"))
        np.testing.assert_allclose(np.linalg.norm(vt[-84:], axis=1), 1, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
