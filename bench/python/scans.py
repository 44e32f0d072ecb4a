"""Synthetic scans: masks with two holes for the eyes, bent and bumped in space, in any pose and with noise; none of a
person. Three families differ in where the eyes are and how large."""

import os
import sys
from pathlib import Path
from typing import List, Tuple

import numpy as np

import beltrami as bt

FAMILIES = [(0.38, 0.16), (0.46, 0.20), (0.42, 0.26)]  # x of the eyes, their radius


def mask(seed: int, edge_length: float = 0.12, holes: bool = True) -> Tuple[bt.Mesh, int]:
    """A scan and its family."""
    random = np.random.default_rng(seed)
    family = seed % len(FAMILIES)
    x_eye, radius = FAMILIES[family] * (1 + 0.03 * random.normal(size=2))
    eyes = [(x_eye + 0.15j, radius), (-x_eye + 0.15j, radius)] if holes else []
    flat = bt.circle_domain(1, eyes, edge_length=edge_length, jitter=0.2, seed=seed)
    x, y = flat.positions.T
    depth = 0.5 * (1 - x * x - 0.6 * y * y) + 0.25 * np.exp(-12 * (x * x + (y + 0.1) ** 2))  # a face and its nose
    for _ in range(4):
        a, b, phase = random.normal(size=2) * 2, random.normal() * 0.03, random.uniform(0, 2 * np.pi)
        depth += b * np.sin(a[0] * x + a[1] * y + phase)
    positions = np.column_stack([x, 1.25 * y, depth])
    positions += random.normal(scale=0.02 * edge_length, size=positions.shape)  # what a scanner adds
    rotation, _ = np.linalg.qr(random.normal(size=(3, 3)))
    rotation *= np.sign(np.linalg.det(rotation))
    return bt.Mesh(100 * positions @ rotation.T + random.normal(size=3) * 50, flat.faces), family


def write(folder: Path, count: int, **options: object) -> List[str]:
    """So many scans as files, and their names."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for seed in range(count):
        path = folder / f"scan-{seed:03}.obj"
        if not path.exists():
            bt.write_mesh(path, mask(seed, **options)[0])  # type: ignore[arg-type]
        paths.append(os.fspath(path))
    return paths


if __name__ == "__main__":
    print(*write(Path(sys.argv[1]), int(sys.argv[2])), sep="\n")
