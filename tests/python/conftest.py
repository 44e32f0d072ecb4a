import os
from pathlib import Path

import numpy as np
import pytest

import beltrami as bt


@pytest.fixture
def disk() -> bt.Surface:
    """600 triangles in the plane."""
    return bt.Surface(bt.disk(10))


@pytest.fixture
def cap() -> bt.Surface:
    """A disk in space."""
    mesh = bt.disk(10)
    x, y = mesh.positions.T
    return bt.Surface(np.column_stack([x, y, 0.7 * x * x - 0.3 * y * y + 0.2 * x * y]), mesh.faces)


@pytest.fixture
def ring() -> bt.Surface:
    return bt.Surface(bt.annulus(0.4, 1.0, 48))


def program(name: str) -> str:
    """A program that the environment names, or the test is skipped."""
    path = os.environ.get(name, "")
    if not path or not Path(path).exists():
        pytest.skip(f"{name} names no program")
    return path


@pytest.fixture
def command() -> str:
    return program("BELTRAMI")
