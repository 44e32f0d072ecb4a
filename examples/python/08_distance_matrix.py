"""Teichmüller distances of some shapes, and their clusters: 08_distance_matrix.png."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
from scipy.cluster.hierarchy import dendrogram

import beltrami as bt


def main(folder: Path) -> None:
    shapes = {}
    for size in (0.15, 0.17, 0.3, 0.32):
        for place in (0.4, 0.5):
            mesh = bt.circle_domain(1, [(place, size), (-0.45, 0.2)], edge_length=0.12)
            shapes[f"r {size}, x {place}"] = bt.Surface(mesh)
    distance, lower, upper, _ = bt.distance_matrix(list(shapes.values()), names=list(shapes))
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.5))
    left.imshow(distance, cmap="magma")
    left.set_title("½ log K*", fontsize=9)
    dendrogram(bt.cluster_by_distance(distance), labels=list(shapes), ax=right, orientation="left")
    figure.tight_layout()
    figure.savefig(folder / "08_distance_matrix.png", dpi=80)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
