"""How long computations of all kinds go on after Ctrl-C, in harmonic maps of a surface as large as theirs: seconds of the
processor, which other programs do not lengthen.

    PYTHONPATH=build/python:tests/python /usr/bin/python3 bench/python/interruptions.py [SIZE] [MOMENTS] [KIND …]
"""

import sys

import numpy as np

import beltrami as bt
import solves


def main(size: int, moments: int, kinds: list) -> None:
    bt.set_thread_count(1)
    harmonic = solves.harmonic_seconds(size)[0]
    print(f"{solves.bent(size).face_count} faces, harmonic map {harmonic:.3f} s")
    parts = np.linspace(0.05, 0.95, moments)
    for name, solve in {**solves.with_progress(size), **solves.without_progress(size)}.items():
        if kinds and name not in kinds:
            continue
        whole = min(solves.processor_seconds(solve) for _ in range(2))
        heard = [solves.heard_after(solve, part * whole) for part in parts]
        stopped = np.isfinite(heard)
        worst = int(np.argmax(np.where(stopped, heard, -np.inf)))
        print(
            f"{name}: {whole / harmonic:.1f} harmonic maps, stopped {stopped.sum()} of {moments} times, after at most "
            f"{heard[worst] / harmonic:.2f}, at {parts[worst]:.2f} of it",
            flush=True,
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 70, int(sys.argv[2]) if len(sys.argv) > 2 else 10, sys.argv[3:])
