"""Boundary values: disk, rectangle, polygon, and corners that force a dilatation: 02_boundary_data.png."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import beltrami as bt
from scan import scan


def main(folder: Path) -> None:
    surface = bt.Surface(scan(noise=0))
    house = [0, 1, 1 + 0.7j, 0.5 + 1.2j, 0.7j]
    conditions = {
        "disk": bt.boundary_to_disk(surface, 0.6),
        "rectangle": bt.boundary_to_rectangle(surface, 1.5, 1),
        "polygon": bt.boundary_to_polygon(surface, house),
        "polygon, conformal speed": bt.boundary_to_polygon(surface, house, speed="conformal"),
    }
    figure, axes = plt.subplots(2, 2, figsize=(9, 8))
    for (name, boundary), place in zip(conditions.items(), axes.flat):
        bt.require_feasible(surface, boundary)
        result = bt.extremal_map(surface, boundary)
        result.plot(place)
        place.set_title(f"{name}: K {result.K:.3f}, proved above {result.K_lower_proved:.3f}", fontsize=9)
        for corner in bt.find_corners(surface, boundary)[:1]:
            print(f"{name}: vertex {corner.vertex} alone forces K ≥ {corner.corner_bound:.3f}")
    figure.savefig(folder / "02_boundary_data.png", dpi=80)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
