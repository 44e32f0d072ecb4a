"""Ctrl-C, callbacks and other threads while a solve runs, whichever solve it is."""

import signal
import threading
import time
from typing import Dict, Iterator

import numpy as np
import pytest

import beltrami as bt

from solves import Solve, harmonic_seconds, heard_after, processor_seconds, with_progress, without_progress

KINDS = list(with_progress(4))
LARGE = ["map", "turns", "onto", "register", "flow", "remesh", "deform", "mips"]  # of each kind of loop one
OTHERS = ["sphere_map", "distance", "hyperbolic"]


@pytest.fixture(scope="module")
def small() -> Dict[str, Solve]:
    return with_progress(10)


@pytest.fixture(scope="module")
def large() -> Dict[str, Solve]:
    others = without_progress(70)
    return {**with_progress(70), **{kind: others[kind] for kind in OTHERS}}


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


@pytest.fixture
def one_thread() -> Iterator[None]:
    before = bt.thread_count()
    bt.set_thread_count(1)
    yield
    bt.set_thread_count(before)


@pytest.mark.parametrize("kind", LARGE + OTHERS)
def test_ctrl_c(kind: str, large: Dict[str, Solve], one_thread: None) -> None:
    """Within the time of two harmonic maps, wherever the solve is; of the processor, which is what the solve can help."""
    harmonic, whole = harmonic_seconds(70)[-1], processor_seconds(large[kind])
    heard = [heard_after(large[kind], part * whole) for part in (0.2, 0.7)]
    assert np.isfinite(heard).any()
    assert np.nanmax(heard) < 2 * harmonic + 0.1


def test_a_signal_is_an_interrupt(large: Dict[str, Solve]) -> None:
    timer = threading.Timer(0.05, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            large["map"]()
    timer.join()


@pytest.mark.parametrize("kind", LARGE)
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
