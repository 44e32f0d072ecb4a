"""Meshes of meshio, trimesh and nibabel in, maps out: 10_interchange.png, .vtu, .surf.gii."""

import sys
from pathlib import Path
from types import SimpleNamespace

import matplotlib.pyplot as plt
import meshio
import numpy as np

import beltrami as bt
from scan import scan


def main(folder: Path) -> None:
    mesh = scan(16)
    bt.to_gifti(mesh, folder / "10_interchange.surf.gii")
    positions, faces = np.array(mesh.positions), np.array(mesh.faces)
    sources = {
        "meshio": bt.from_meshio(meshio.Mesh(positions, [("triangle", faces)])),
        "trimesh": bt.from_trimesh(SimpleNamespace(vertices=positions, faces=faces)),  # trimesh.Trimesh does as well
        "GIFTI": bt.from_gifti(folder / "10_interchange.surf.gii"),
    }
    figure, axes = plt.subplots(1, 3, figsize=(13, 4))
    for (name, source), place in zip(sources.items(), axes):
        surface = bt.Surface(source)
        result = bt.extremal_map(surface, bt.boundary_to_disk(surface))
        result.plot(place)
        place.set_title(f"{name}: K {result.K:.6f}", fontsize=9)
        meshio.write(folder / "10_interchange.vtu", bt.to_meshio(result))
    figure.savefig(folder / "10_interchange.png", dpi=70)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
