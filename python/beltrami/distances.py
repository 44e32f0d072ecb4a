"""What a matrix of distances says: clusters, places in the plane, pictures."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, List, Optional, Tuple, Union

import numpy as np

from .checkpoint import write

PathLike = Union[str, "os.PathLike[str]"]
Array = Any  # an array of NumPy


@dataclass
class Distances:
    """Teichmüller's distances ½ log K* of a cohort, with their brackets."""

    names: List[str]
    distance: Array
    lower: Array
    upper: Array
    unsettled: List[Tuple[int, int]] = field(default_factory=list)

    def tree(self) -> Array:
        """Hierarchical clustering by mean distances (average linkage), as scipy.cluster.hierarchy has it."""
        from scipy.cluster.hierarchy import linkage
        from scipy.spatial.distance import squareform

        return linkage(squareform(self.distance, checks=False), "average")

    def clusters(self, count: int) -> Array:
        """n numbers from 1: the clusters when the tree is cut into so many."""
        from scipy.cluster.hierarchy import fcluster

        return fcluster(self.tree(), count, "maxclust")

    def mds(self, dimensions: int = 2) -> Tuple[Array, Array]:
        """Classical multidimensional scaling (Torgerson 1952): n×dimensions places, and all eigenvalues, largest first;
        negative ones tell how far the distances are from those of any Euclidean space. The sign of an axis is chosen
        so that its largest coordinate is positive."""
        n = len(self.names)
        centre = np.eye(n) - 1.0 / n
        values, vectors = np.linalg.eigh(-0.5 * centre @ self.distance**2 @ centre)
        values, vectors = values[::-1], vectors[:, ::-1]
        places = vectors[:, :dimensions] * np.sqrt(np.maximum(values[:dimensions], 0))
        for axis in places.T:
            axis *= np.sign(axis[np.argmax(np.abs(axis))]) or 1
        return places, values

    def plot(self, path: Optional[PathLike] = None, clusters: int = 3) -> Any:
        """The places of mds() coloured by cluster, beside the tree. Returns the figure. Needs matplotlib."""
        from matplotlib import pyplot
        from scipy.cluster.hierarchy import dendrogram

        figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, max(4.5, 0.13 * len(self.names))))
        places, values = self.mds()
        left.scatter(*places.T, c=self.clusters(min(clusters, len(self.names))), cmap="tab10")
        if len(self.names) <= 60:
            for name, place in zip(self.names, places):
                left.annotate(name, place, fontsize=6, xytext=(3, 3), textcoords="offset points")
        explained = values[:2].sum() / np.abs(values).sum() if np.abs(values).sum() > 0 else 1.0
        left.set(aspect="equal", title=f"classical MDS, {100 * explained:.0f} % of the eigenvalues")
        dendrogram(self.tree(), labels=self.names, orientation="left", ax=right, leaf_font_size=6)
        right.set_title("average linkage of ½ log K*")
        figure.tight_layout()
        if path is not None:
            figure.savefig(os.fspath(path), dpi=110)
        return figure

    def save(self, folder: PathLike) -> None:
        """distances.csv, and distances.json with the brackets."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        rows = [",".join(["", *self.names])]
        rows += [",".join([name, *map(repr, row)]) for name, row in zip(self.names, self.distance.tolist())]
        write(folder / "distances.csv", ("\n".join(rows) + "\n").encode())
        record = {
            "names": self.names,
            "distance": self.distance.tolist(),
            "lower": self.lower.tolist(),
            "upper": self.upper.tolist(),
            "unsettled": [list(pair) for pair in self.unsettled],
        }
        write(folder / "distances.json", json.dumps(record).encode())
