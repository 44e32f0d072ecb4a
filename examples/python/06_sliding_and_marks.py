"""The boundary slides onto a domain; marks hold places of it: 06_sliding_and_marks.png."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import beltrami as bt
from scan import scan


def main(folder: Path) -> None:
    surface = bt.Surface(scan(noise=0))
    rim = surface.boundary_loops[0]
    ellipse = bt.TargetCurve.spline([2, 1.5 + 0.7j, 1j, -1.5 + 0.7j, -2, -1.5 - 0.7j, -1j, 1.5 - 0.7j])
    domain = bt.TargetDomain(ellipse)
    marks = [(int(rim[i * len(rim) // 4]), 0, i * ellipse.length / 4) for i in range(4)]
    figure, axes = plt.subplots(1, 2, figsize=(12, 4))
    free = bt.extremal_map(surface, domain)
    free.plot(axes[0])
    axes[0].set_title(f"sliding: K {free.K:.4f}", fontsize=9)
    held = bt.extremal_map(surface, bt.Constraints(target=domain, marks=marks))
    held.plot(axes[1])
    places = held.map[[vertex for vertex, _, _ in marks]]
    axes[1].plot(places.real, places.imag, "ro")
    axes[1].set_title(f"four marks: K {held.K:.4f}", fontsize=9)
    figure.savefig(folder / "06_sliding_and_marks.png", dpi=80)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
