"""A ring in three homotopy classes: 03_holes_and_classes.png."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import beltrami as bt


def main(folder: Path) -> None:
    surface = bt.Surface(bt.annulus(0.2, 1, 96))
    boundary = bt.boundary_to_disk(surface) + bt.hole_to_circle(surface, 1, 0.2, 0.25)
    figure, axes = plt.subplots(1, 3, figsize=(13, 4))
    for turns, place in zip((-1, 0, 1), axes):
        result = bt.extremal_map(surface, bt.Constraints(boundary, turns=[0, turns]))
        result.plot(place)
        place.set_title(f"{result.turns[1]} turns: K {result.K:.3f}", fontsize=9)
    figure.savefig(folder / "03_holes_and_classes.png", dpi=80)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
