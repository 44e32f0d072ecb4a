"""Seconds of the module beside those of the command, and what a surface that is used again saves.

    PYTHONPATH=build/python /usr/bin/python3 bench/python/timing.py build/beltrami [FACES] [REPEATS]
"""

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Callable

import numpy as np

import beltrami as bt


def seconds(action: Callable[[], object]) -> float:
    start = time.perf_counter()
    action()
    return time.perf_counter() - start


def main(command: str, faces: int, repeats: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scan.obj"
        mesh = bt.disk(bt.disk_rings_for_triangles(faces), jitter=0.2)
        x, y = mesh.positions.T
        bt.write_mesh(path, bt.Mesh(np.column_stack([x, y, 0.6 * np.exp(-4 * (x * x + y * y)) + 0.1 * np.sin(5 * x)]), mesh.faces))

        def in_python() -> None:
            surface = bt.Surface(bt.read_mesh(path))
            result = bt.extremal_map(surface, bt.boundary_to_disk(surface, 0.5))
            result.save(Path(folder) / "python.obj")

        def by_command() -> None:
            arguments = ["map", path, "-o", Path(folder) / "command.obj", "--boundary", "disk:0.5", "--quiet"]
            subprocess.run([command, *map(str, arguments)], check=True)

        times = [(seconds(in_python), seconds(by_command)) for _ in range(repeats)]
        python, own = (statistics.median(column) for column in zip(*times))
        same = (Path(folder) / "python.obj").read_bytes() == (Path(folder) / "command.obj").read_bytes()
        print(f"{mesh.face_count} faces: Python {python:.2f} s, command {own:.2f} s, {100 * (python / own - 1):+.1f} %; same file: {same}")

        reuse(*bt.read_mesh(path))


def processor_seconds(action: Callable[[], object]) -> float:
    """The least of three, of one thread: other programs do not count."""
    times = []
    for _ in range(3):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return min(times)


def reuse(V: np.ndarray, F: np.ndarray) -> None:  # type: ignore[type-arg]
    """What a surface that is used again saves: its charts."""
    bt.set_thread_count(1)

    def map_of(surface: bt.Surface) -> None:
        bt.extremal_map(surface, bt.boundary_to_disk(surface, 0.4, speed="conformal"))

    kept = bt.Surface(V, F)
    map_of(kept)
    again, anew = processor_seconds(lambda: map_of(kept)), processor_seconds(lambda: map_of(bt.Surface(V, F)))
    print(f"a map again {again:.2f} s, of a new surface {anew:.2f} s: {100 * (1 - again / anew):.0f} % saved")

    masks = []
    for edge_length in (0.03, 0.035):
        flat = bt.circle_domain(1, [(0.42, 0.2), (-0.4 + 0.1j, 0.25)], edge_length=edge_length, jitter=0.2)
        x, y = flat.positions.T
        masks.append(bt.Mesh(np.column_stack([x, y, 0.4 * x * x - 0.3 * y * y]), flat.faces))
    a, b = map(bt.Surface, masks)
    bt.teichmueller_distance(a, b)
    again = processor_seconds(lambda: bt.teichmueller_distance(a, b))
    anew = processor_seconds(lambda: bt.teichmueller_distance(bt.Surface(masks[0]), bt.Surface(masks[1])))
    print(f"a distance again {again:.2f} s, of new surfaces {anew:.2f} s: {100 * (1 - again / anew):.0f} % saved")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 100000, int(sys.argv[3]) if len(sys.argv) > 3 else 5)
