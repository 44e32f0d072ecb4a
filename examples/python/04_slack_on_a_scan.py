"""A noisy outline costs dilatation that slack gives back: 04_slack_on_a_scan.png."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import beltrami as bt
from scan import scan


def main(folder: Path) -> None:
    surface = bt.Surface(scan(noise=0.5))
    boundary = bt.boundary_to_disk(surface)
    figure, axes = plt.subplots(1, 2, figsize=(9, 4))
    for slack, place in zip((0, 1), axes):
        result = bt.extremal_map(surface, boundary, slack=slack)
        result.plot(place)
        place.set_title(f"slack {slack}: K {result.K:.3f}, mean |μ| {result.distortion.mean:.3f}", fontsize=9)
    figure.savefig(folder / "04_slack_on_a_scan.png", dpi=90)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
