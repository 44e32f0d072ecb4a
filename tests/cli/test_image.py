"""beltrami image: pictures deformed by maps."""

import pathlib
import struct
import unittest
import zlib

import numpy as np

from support import Command, disk, write_obj


def write_png(path, pixels):
    """An array rows × columns × 3 or 4 of bytes."""
    rows, columns, channels = pixels.shape
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    lines = b"".join(b"\0" + row.tobytes() for row in pixels.astype(np.uint8))
    pathlib.Path(path).write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 6 if channels == 4 else 2, 0, 0, 0)) +
        chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def read_png(path):
    """RGBA of an 8 bit PNG without interlacing."""
    data, at, body = pathlib.Path(path).read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            columns, rows, depth, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT":
            body += data[at + 8:at + 8 + size]
        at += size + 12
    assert (depth, colour) == (8, 6)
    raw = np.frombuffer(zlib.decompress(body), np.uint8).reshape(rows, 1 + 4 * columns)
    out = np.zeros((rows, 4 * columns), np.uint8)
    for r in range(rows):
        kind, line = raw[r, 0], raw[r, 1:].astype(int)
        up = out[r - 1].astype(int) if r else np.zeros(4 * columns, int)
        for c in range(4 * columns):
            left, upper_left = (int(out[r, c - 4]), int(up[c - 4])) if c >= 4 else (0, 0)
            p = left + int(up[c]) - upper_left
            paeth = min((abs(p - left), 0, left), (abs(p - int(up[c])), 1, int(up[c])), (abs(p - upper_left), 2, upper_left))[2]
            out[r, c] = (int(line[c]) + (0, left, int(up[c]), (left + int(up[c])) // 2, paeth)[kind]) % 256
    return out.reshape(rows, columns, 4)


class Images(Command):
    def setUp(self):
        super().setUp()
        self.points, self.faces = disk(12)
        # Black and white halves.
        picture = np.zeros((60, 60, 3), int)
        picture[:, 30:] = 255
        write_png(self.path("halves.png"), picture)

    def test_a_quarter_turn(self):
        turned = np.column_stack([-self.points[:, 1], self.points[:, 0]])
        write_obj(self.path("map.obj"), self.points, self.faces, turned)
        self.run_command("image", self.path("map.obj"), self.path("halves.png"), "-o", self.path("out.png"), "--width", 80)
        out = read_png(self.path("out.png"))
        self.assertEqual(out.shape, (80, 80, 4))
        self.assertEqual(out[0, 0, 3], 0)
        np.testing.assert_array_equal(out[5:36, 40], [[255, 255, 255, 255]] * 31)
        np.testing.assert_array_equal(out[44:75, 40], [[0, 0, 0, 255]] * 31)

    def test_place_and_the_same_bytes_on_any_number_of_threads(self):
        write_obj(self.path("map.obj"), self.points, self.faces, 2 * self.points)
        for threads in (1, 3):
            self.run_command("image", self.path("map.obj"), self.path("halves.png"), "-o", self.path(f"{threads}.png"), "--width", 50,
                             "--place", "0,-1,1,1", "--between", "linear", "--threads", threads)
        self.assertEqual(pathlib.Path(self.path("1.png")).read_bytes(), pathlib.Path(self.path("3.png")).read_bytes())
        out = read_png(self.path("1.png"))
        self.assertEqual(out[25, 20, 3], 0)  # outside the picture
        self.assertEqual(tuple(out[25, 32]), (0, 0, 0, 255))
        self.assertEqual(tuple(out[25, 45]), (255, 255, 255, 255))

    def test_mistakes(self):
        write_obj(self.path("map.obj"), self.points, self.faces, self.points)
        out = ("-o", self.path("out.png"))
        self.assertIn("no PNG", self.run_command("image", self.path("map.obj"), self.path("map.obj"), *out, code=3).stderr)
        self.assertIn("--place", self.run_command("image", self.path("map.obj"), self.path("halves.png"), *out, "--place", "1,2", code=2).stderr)
        write_obj(self.path("plain.obj"), self.points, self.faces)
        self.assertIn("texture", self.run_command("image", self.path("plain.obj"), self.path("halves.png"), *out, code=4).stderr)
        bent = np.column_stack([self.points, self.points[:, 0] ** 2])
        write_obj(self.path("bent.obj"), bent, self.faces, self.points)
        self.assertIn("plane", self.run_command("image", self.path("bent.obj"), self.path("halves.png"), *out, code=4).stderr)
        self.assertFalse(pathlib.Path(self.path("out.png")).exists())
        text = self.run_command("image", self.path("map.obj"), self.path("halves.png"), "-o", self.path("out.jpg"), code=2).stderr
        self.assertIn(".png", text)
        self.assertFalse(pathlib.Path(self.path("out.jpg")).exists())


if __name__ == "__main__":
    unittest.main()
