"""A structured quad grid on a surface, by the inverse of a map: 07_grid.png, .obj."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import beltrami as bt
from scan import scan


def main(folder: Path) -> None:
    surface = bt.Surface(scan(noise=0))
    result = bt.extremal_map(surface, bt.boundary_to_rectangle(surface, 1, 1))
    square = bt.TargetDomain(bt.TargetCurve.polygon([0, 1, 1 + 1j, 1j]))
    grid = bt.grid_on_surface(surface, result.map, bt.fitting_grid(square, 20))
    print(grid)
    positions, faces = grid.mesh
    figure = plt.figure(figsize=(6, 5))
    axes = figure.add_subplot(projection="3d")
    axes.add_collection3d(Poly3DCollection([positions[face[face >= 0]] for face in faces], facecolor="w", edgecolor="k", linewidths=0.5))
    axes.auto_scale_xyz(*positions.T)
    axes.set_box_aspect(positions.max(0) - positions.min(0))
    figure.savefig(folder / "07_grid.png", dpi=90)
    bt.write_mesh(folder / "07_grid.obj", grid.mesh)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
