"""A handle is dragged and the extremal map follows: with the mouse in a window, or, without one, along a circle:
09_interactive_handle.png."""

import sys
import time
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import beltrami as bt


class Handle:
    def __init__(self) -> None:
        self.surface = bt.Surface(bt.disk(20))
        constraints = bt.Constraints(bt.boundary_to_disk(self.surface)).pin(0, 0)
        self.solver = bt.ExtremalSolver(self.surface, constraints)
        self.images = np.array(constraints.prescribed.images)
        self.figure, self.axes = plt.subplots(figsize=(5, 5))
        self.drawn = PolyCollection([], edgecolors="k", facecolors="w", linewidths=0.2)
        self.axes.add_collection(self.drawn)
        self.axes.set(xlim=(-1.05, 1.05), ylim=(-1.05, 1.05), aspect="equal")
        self.drag(0)

    def drag(self, place: complex) -> None:
        self.images[-1] = place
        try:
            map, k, _, _ = self.solver.update(self.images)
        except bt.BadBoundary:  # outside the disk
            return
        corners = map[self.surface.faces]
        self.drawn.set_verts(np.stack([corners.real, corners.imag], axis=-1))
        self.axes.set_title(f"k {k:.4f}")
        self.figure.canvas.draw_idle()

    def moved(self, event: "plt.MouseEvent") -> None:  # type: ignore[name-defined]
        if event.button and event.xdata is not None:
            self.drag(complex(event.xdata, event.ydata))


def main(folder: Path) -> None:
    handle = Handle()
    if plt.get_backend().lower() != "agg":
        handle.figure.canvas.mpl_connect("motion_notify_event", handle.moved)
        plt.show()
    start = time.perf_counter()
    for angle in np.linspace(0, 1.5 * np.pi, 30):
        handle.drag(0.4 * np.exp(1j * angle))
    print(f"{30 / (time.perf_counter() - start):.0f} updates a second")
    handle.figure.savefig(folder / "09_interactive_handle.png", dpi=80)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
