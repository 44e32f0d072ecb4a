#!/usr/bin/env python3
"""Draws the compass rose that the pictures of the report page have as texture: rose.py OUT.png"""

import math
import sys

from PIL import Image, ImageDraw

SIZE, CELL = 1024, 64
INK, PAPER, SHADE = (40, 40, 40), (244, 239, 226), (226, 214, 188)
COLOURS = [(176, 58, 46), (31, 97, 141), (20, 120, 90), (185, 119, 14)]

image = Image.new("RGB", (SIZE, SIZE), PAPER)
draw = ImageDraw.Draw(image)
for i in range(SIZE // CELL):
    for j in range(SIZE // CELL):
        if (i + j) % 2:
            draw.rectangle([CELL * i, CELL * j, CELL * i + CELL - 1, CELL * j + CELL - 1], fill=SHADE)
middle = SIZE // 2
at = lambda radius, angle: (middle + radius * math.cos(angle), middle + radius * math.sin(angle))
for ring, colour in enumerate(COLOURS):
    for quarter in range(4):
        angle = math.pi / 2 * quarter + math.pi / 8 * ring
        draw.polygon([at(470 - 70 * ring, angle), at(90, angle + 0.4), (middle, middle), at(90, angle - 0.4)], fill=colour, outline=INK)
for radius in (480, 400, 250):
    draw.ellipse([middle - radius, middle - radius, middle + radius, middle + radius], outline=INK, width=4)
image.save(sys.argv[1])
