"""Pages and pictures of results: methods of their classes, in Python because they are about Python's world."""

from __future__ import annotations

import html
import json
import os
from pathlib import Path
from typing import Any, Callable, List, Optional, Union

import numpy as np

from . import _core
from .errors import Unwritable

PathLike = Union[str, "os.PathLike[str]"]
Map = Union[_core.PlanarMap, _core.SpaceMap]


def shown(result: Any) -> Map:
    """The map that stands for a result on a page and in a picture: itself, or the one that it is about."""
    if isinstance(result, (_core.PlanarMap, _core.SpaceMap)):
        return result
    if isinstance(result, _core.Certification):
        return result.result
    if isinstance(result, _core.ExtremalMapBetween):
        return result.plane
    if isinstance(result, _core.VerifiedBracket):
        return _core.PlanarMap(result.surface, result.map[: result.surface.vertex_count])
    if isinstance(result, _core.SurfaceGrid):
        return _core.PlanarMap(_core.Surface(result.mesh), result.parameter)
    if isinstance(result, (_core.FlatTorus, _core.HyperbolicDomain)):
        cut = _core.cut_along_seams(_core.Mesh(result.surface.positions, result.surface.faces, result.layout))
        return _core.PlanarMap(_core.Surface(cut), np.asarray(result.layout[0]))
    raise TypeError(f"nothing is drawn of a {type(result).__name__}")


def report(result: Any, path: PathLike, title: Optional[str] = None) -> None:
    """Writes the page of a result: one self-contained HTML file with the surface, its images, |μ|, convergence, bounds.

    title: of the page (None: the file's name). Raises Unwritable.
    """
    path = Path(path)
    _write(path, shown(result)._page(title if title is not None else path.stem))


def save(result: Any, path: PathLike) -> None:
    """Writes the surface that was mapped as .obj, .ply or .off: with a map to the plane as texture coordinates, at its
    places with one into space. Of a grid the grid. Raises Unwritable."""
    if isinstance(result, _core.SurfaceGrid):
        _core.write_mesh(path, result.mesh)
        return
    map = shown(result)
    if isinstance(map, _core.SpaceMap):
        _core.write_mesh(path, _core.Mesh(map.positions, map.source.faces))
    else:
        _core.write_mesh(path, map.surface, map.map)


def _polygons(points: Any, faces: Any) -> List[Any]:
    triangles = faces[:, -1] < 0 if faces.shape[1] == 4 else np.ones(len(faces), dtype=bool)
    return [points[f[:3] if t else f] for f, t in zip(faces, triangles)]


def plot(result: Any, axes: Any = None, *, edges: bool = True, colour_bar: bool = True) -> Any:
    """Draws the image of a map, its faces coloured by |μ|. Needs matplotlib.

    axes: where to draw (None: a new figure). edges: whether to draw these. Returns the axes.
    """
    from matplotlib import pyplot
    from matplotlib.collections import PolyCollection

    map = shown(result)
    in_space = isinstance(map, _core.SpaceMap) and map.positions.shape[1] == 3
    if axes is None:
        options = {"projection": "3d"} if in_space else {}
        axes = pyplot.figure(figsize=(5, 5)).add_subplot(**options)
    surface = map.source if isinstance(map, _core.SpaceMap) else map.surface
    points = map.positions if isinstance(map, _core.SpaceMap) else map.uv
    style = {
        "array": np.clip(np.nan_to_num(map.distortion.face_abs_mu, nan=1.0), 0, 1),
        "cmap": "viridis",
        "edgecolors": "black" if edges and surface.face_count < 20000 else "face",
        "linewidths": 0.1,
    }
    if in_space:
        from mpl_toolkits.mplot3d.art3d import Poly3DCollection

        drawn: Any = Poly3DCollection(_polygons(points, surface.faces), **style)
        axes.add_collection3d(drawn)
        centre, size = (points.max(axis=0) + points.min(axis=0)) / 2, np.ptp(points, axis=0).max() / 2
        axes.set(xlim=centre[0] + [-size, size], ylim=centre[1] + [-size, size], zlim=centre[2] + [-size, size])
        axes.set_box_aspect((1, 1, 1))
    else:
        drawn = PolyCollection(_polygons(points, surface.faces), **style)
        axes.add_collection(drawn)
        axes.set_aspect("equal")
        axes.autoscale_view()
    drawn.set_clim(0, max(0.05, min(1.0, float(map.distortion.p99) * 1.2)))
    axes.set_title(f"{map.method}: K_max {map.K_max:.3f}, mean |μ| {map.distortion.mean:.3f}", fontsize=9)
    if colour_bar:
        axes.figure.colorbar(drawn, ax=axes, label="|μ|", shrink=0.8)
    return axes


def _repr_html_(result: Any) -> str:
    """The page in a notebook's cell."""
    map = shown(result)
    page = html.escape(map._page(map.method), quote=True)
    return f'<iframe srcdoc="{page}" style="width: 100%; height: 720px; border: 0"></iframe>'


def _numbers(*names: str) -> Callable[[Any], str]:
    """to_json of a result that is but some numbers."""

    def to_json(result: Any) -> str:
        """The numbers as JSON."""
        values = {name: getattr(result, name) for name in names}
        return json.dumps({name: None if isinstance(v, float) and not np.isfinite(v) else v for name, v in values.items()})

    return to_json


def _write(path: Path, text: str) -> None:
    """A whole file, or none."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        temporary.write_text(text, encoding="utf-8")
        os.replace(temporary, path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise Unwritable(f"{path} could not be written: {error.strerror}") from error


SHOWN = (
    _core.PlanarMap,
    _core.SpaceMap,
    _core.Certification,
    _core.ExtremalMapBetween,
    _core.VerifiedBracket,
    _core.SurfaceGrid,
    _core.FlatTorus,
    _core.HyperbolicDomain,
)
for _class in SHOWN:
    for _name, _function in (("report", report), ("save", save), ("plot", plot), ("_repr_html_", _repr_html_)):
        setattr(_class, _name, _function)
setattr(_core.VerifiedBracket, "to_json", _numbers("K_lower", "K_upper", "reached", "reason", "refinements"))
setattr(_core.Distance, "to_json", _numbers("distance", "lower", "upper", "settled"))
