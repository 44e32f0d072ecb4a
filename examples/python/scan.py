"""A synthetic scan for the examples: a bumpy cap whose outline is noisy, as scanners leave it."""

import numpy as np

import beltrami as bt


def scan(rings: int = 24, noise: float = 0.3, seed: int = 1) -> bt.Mesh:
    mesh = bt.disk(rings, jitter=0.25, seed=seed)
    x, y = mesh.positions.T
    height = 0.8 * np.exp(-3 * (x * x + y * y)) + 0.15 * np.sin(4 * x) * np.cos(3 * y)
    positions = np.column_stack([x, 1.2 * y, height])
    rim = bt.Surface(mesh).boundary_loops[0]
    positions[rim] += np.random.default_rng(seed).normal(scale=noise / rings, size=(len(rim), 3))
    return bt.Mesh(positions, mesh.faces)
