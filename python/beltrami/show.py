"""Pages and pictures of maps: methods of PlanarMap, in Python because they are about Python's world."""

from __future__ import annotations

import html
import os
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from . import _core

PathLike = Union[str, "os.PathLike[str]"]


def report(map: _core.PlanarMap, path: PathLike, title: Optional[str] = None) -> None:
    """Writes the page of a map: one self-contained HTML file with the surface, its images, |μ|, convergence, bounds."""
    path = Path(path)
    _write(path, map._page(title if title is not None else path.stem))


def save(map: _core.PlanarMap, path: PathLike) -> None:
    """Writes the surface that was mapped as .obj, .ply or .off, with the map as texture coordinates."""
    _core.write_mesh(path, map.surface, map.map)


def plot(map: _core.PlanarMap, axes: Any = None, *, edges: bool = True, colour_bar: bool = True) -> Any:
    """Draws the image of a map, its faces coloured by |μ|. Needs matplotlib.

    axes: where to draw (None: a new figure). edges: whether to draw these. Returns the axes.
    """
    from matplotlib import pyplot
    from matplotlib.collections import PolyCollection

    if axes is None:
        _, axes = pyplot.subplots(figsize=(5, 5))
    faces = map.surface.faces
    triangles = faces[:, -1] < 0 if faces.shape[1] == 4 else np.ones(len(faces), dtype=bool)
    polygons = [map.uv[f[:3] if t else f] for f, t in zip(faces, triangles)]
    drawn = PolyCollection(
        polygons,
        array=np.clip(np.nan_to_num(map.distortion.face_abs_mu, nan=1.0), 0, 1),
        cmap="viridis",
        edgecolors="black" if edges and len(faces) < 20000 else "face",
        linewidths=0.1,
    )
    drawn.set_clim(0, max(0.05, min(1.0, float(map.distortion.p99) * 1.2)))
    axes.add_collection(drawn)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_title(f"{map.method}: K_max {map.K_max:.3f}, mean |μ| {map.distortion.mean:.3f}", fontsize=9)
    if colour_bar:
        axes.figure.colorbar(drawn, ax=axes, label="|μ|", shrink=0.8)
    return axes


def _repr_html_(map: _core.PlanarMap) -> str:
    """The page in a notebook's cell."""
    page = html.escape(map._page(map.method), quote=True)
    return f'<iframe srcdoc="{page}" style="width: 100%; height: 720px; border: 0"></iframe>'


def _write(path: Path, text: str) -> None:
    """A whole file, or none."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        temporary.write_text(text, encoding="utf-8")
        os.replace(temporary, path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        from .errors import Unwritable

        raise Unwritable(f"{path} could not be written: {error.strerror}") from error


for _name, _function in (("report", report), ("save", save), ("plot", plot), ("_repr_html_", _repr_html_)):
    setattr(_core.PlanarMap, _name, _function)
