"""Extremal quasiconformal (Teichmüller) maps of meshes.

    import beltrami as bt
    surface = bt.Surface(V, F)
    result = bt.extremal_map(surface, bt.boundary_to_disk(surface))
    print(result.K, result.K_lower_proved)

Names are those of the library in C++, and docs/python.md is the guide.
"""

from __future__ import annotations

from . import errors
from ._core import *  # noqa: F403
from ._core import __version__ as __version__
from .converters import (
    from_gifti,
    from_freesurfer,
    from_meshio,
    from_trimesh,
    from_vtk,
    to_gifti,
    to_freesurfer,
    to_meshio,
    to_vtk,
)
from .errors import BadBoundary, BadMesh, BadOption, Cancelled, Error, NotSolved, Unreadable, Unwritable
from .show import plot, report, save

__all__ = [name for name in dir() if not name.startswith("_") and name not in ("annotations", "converters", "show")]
