"""A scan is read and mapped extremally to the disk, beside LSCM: 01_first_map.png, .html, .obj."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import beltrami as bt
from scan import scan


def main(folder: Path) -> None:
    bt.write_mesh(folder / "scan.obj", scan())
    surface = bt.Surface(bt.read_mesh(folder / "scan.obj"))
    result = bt.extremal_map(surface, bt.boundary_to_disk(surface, speed="conformal", amplitude=0.8))
    print(result)
    lscm = bt.lscm_baseline(surface)
    print("LSCM:", lscm.distortion)
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4))
    result.plot(left)
    lscm.plot(right)
    figure.savefig(folder / "01_first_map.png", dpi=90)
    result.report(folder / "01_first_map.html")
    result.save(folder / "01_first_map.obj")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
