"""Ctrl-C, callbacks and other threads while a solve runs, whichever solve it is."""

import signal
import threading
import time
from typing import Any, Callable, Dict

import numpy as np
import pytest

import beltrami as bt

Solve = Callable[..., Any]


def bent(rings: int) -> bt.Surface:
    mesh = bt.disk(rings, jitter=0.3)
    x, y = mesh.positions.T
    return bt.Surface(np.column_stack([x, y, 0.5 * x * x - 0.3 * x * y]), mesh.faces)


def solves(size: int) -> Dict[str, Solve]:
    """Solves of all kinds, of surfaces with about 6 size² faces, each taking progress=."""
    disk = bent(size)
    boundary = bt.boundary_to_disk(disk, 0.9)
    domain = bt.TargetDomain(bt.TargetCurve.polygon([0, 2, 2 + 1j, 1j]))
    corners = [int(v) for v in disk.boundary_loops[0][:: len(disk.boundary_loops[0]) // 5][:5]]
    marked = bt.Constraints(target=domain, marks=[(v, 0, s) for v, s in zip(corners, (0.0, 1.5, 2.5, 3.5, 5.0))])
    level = max(2, round(np.log2(6 * size * size / 20) / 2))
    ball = bt.icosahedral_sphere(level)
    potato = bt.Surface(ball.positions * [1, 0.8, 1.2], ball.faces)
    pear = bt.Surface(ball.positions * [1.2, 1, 0.8], ball.faces)
    landmarks = list(range(0, 12, 2))
    random = np.random.default_rng(0)
    rough = bt.Surface(bt.Mesh(potato.positions * [1, 1, 2] + random.normal(scale=0.1 / size, size=ball.positions.shape), ball.faces))
    rim = disk.boundary_loops[0]
    handles = [0, *map(int, rim[:: max(1, len(rim) // 12)])]
    places = disk.positions[handles].copy()
    places[0] += [0, 0, 0.3]
    sphere = bt.sphere_map(potato)
    return {
        "map": lambda **given: bt.extremal_map(disk, boundary, **given),
        "onto": lambda **given: bt.extremal_map(disk, marked, **given),
        "register": lambda **given: bt.register_spheres(potato, pear, landmarks, landmarks, **given),
        "flow": lambda **given: bt.surface_flow(potato, bt.SphereTarget(), 0.3 + 0 * sphere.mu, start=sphere.positions, **given),
        "remesh": lambda **given: bt.remesh(rough, **given),
        "deform": lambda **given: bt.DeformSolver(disk, handles, **given).solve(places),
        "mips": lambda **given: bt.mips_baseline(disk, boundary, **given),
    }


KINDS = ["map", "onto", "register", "flow", "remesh", "deform", "mips"]


@pytest.fixture(scope="module")
def small() -> Dict[str, Solve]:
    return solves(10)


@pytest.fixture(scope="module")
def large() -> Dict[str, Solve]:
    return solves(70)


@pytest.fixture(scope="module")
def harmonic() -> float:
    """Seconds of a harmonic map of such a surface."""
    surface = bent(70)
    boundary = bt.boundary_to_disk(surface)
    times = []
    for _ in range(3):
        start = time.perf_counter()
        bt.harmonic_baseline(bt.Surface(surface.positions, surface.faces), boundary)
        times.append(time.perf_counter() - start)
    return sorted(times)[1]


@pytest.mark.parametrize("kind", KINDS)
def test_progress(kind: str, small: Dict[str, Solve]) -> None:
    calls: list = []
    small[kind](progress=lambda i, value: calls.append((i, value)))
    assert calls and all(isinstance(i, int) and isinstance(value, float) for i, value in calls)
    with pytest.raises(bt.Cancelled):
        small[kind](progress=lambda i, value: False)
    with pytest.raises(ZeroDivisionError):
        small[kind](progress=lambda i, value: 1 / 0)
    with pytest.raises(TypeError):
        small[kind](progress="often")


@pytest.mark.parametrize("kind", KINDS)
def test_ctrl_c(kind: str, large: Dict[str, Solve], harmonic: float) -> None:
    """Within the time of two harmonic maps, wherever the solve is."""
    start = time.perf_counter()
    large[kind]()
    whole = time.perf_counter() - start
    for part in (0.1, 0.5, 0.8):
        sent: list = []

        def interrupt() -> None:
            sent.append(time.perf_counter())
            signal.raise_signal(signal.SIGINT)

        timer = threading.Timer(part * whole, interrupt)
        timer.start()
        try:
            with pytest.raises(KeyboardInterrupt):
                for _ in range(20):
                    large[kind]()
            assert time.perf_counter() - sent[0] < 2 * harmonic + 0.1, (kind, part)
        finally:
            timer.join()


@pytest.mark.parametrize("kind", KINDS)
def test_other_threads_go_on(kind: str, large: Dict[str, Solve]) -> None:
    """The interpreter's lock is not held: a thread that counts is not held up for long."""
    gaps: list = []
    ended = threading.Event()

    def count() -> None:
        last = time.perf_counter()
        while not ended.wait(0.002):
            now = time.perf_counter()
            gaps.append(now - last)
            last = now

    thread = threading.Thread(target=count)
    thread.start()
    start = time.perf_counter()
    large[kind]()
    whole = time.perf_counter() - start
    ended.set()
    thread.join()
    assert len(gaps) > 3 and max(gaps) < max(0.5 * whole, 0.1)
