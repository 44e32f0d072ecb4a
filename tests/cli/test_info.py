"""beltrami info."""

import unittest

from support import Command, disk, write_obj


class Info(Command):
    def test_counts(self):
        record = self.record("info", self.bump_file(5))
        self.assertEqual(record["source"]["faces"], 6 * 25)
        self.assertEqual(record["source"]["components"], 1)
        self.assertEqual(len(record["source"]["boundary_loops"]), 1)
        self.assertEqual(record["source"]["genus"], 0)
        self.assertIn("boundary loop", self.run_command("info", self.path("bump.obj")).stdout)

    def test_a_defective_mesh_is_described_and_the_exit_code_says_so(self):
        points, faces = disk(3)
        faces[4] = faces[4][::-1]
        write_obj(self.path("bad.obj"), points, faces)
        record = self.record("info", self.path("bad.obj"), code=4)
        self.assertTrue(record["warnings"])
        self.assertNotIn("genus", record["source"])


    def test_numbers_agree_with_their_nouns(self):
        points, faces = disk(1)
        write_obj(self.path("one.obj"), points, faces[:1])
        text = self.run_command("info", self.path("one.obj")).stdout
        for words in ("1 face ", "1 triangle,", "0 quads", "1 component,", "1 boundary loop\n"):
            self.assertIn(words, text)


if __name__ == "__main__":
    unittest.main()
