"""Meshes of other packages and back. Each package is imported where it is asked for, and none is needed otherwise."""

from __future__ import annotations

import os
from typing import Any, Union

import numpy as np

from ._core import Mesh, PlanarMap, Surface
from .errors import BadMesh, Unreadable

PathLike = Union[str, "os.PathLike[str]"]
Meshlike = Union[Mesh, Surface]
Array = Any  # an array of NumPy


def _rows(triangles: Any, quads: Any) -> Array:
    """#F×3 triangles, or #F×4 with -1 in the fourth column of triangles, these first."""
    triangles = np.asarray(triangles, dtype=np.int64).reshape(-1, 3)
    quads = np.asarray(quads, dtype=np.int64).reshape(-1, 4)
    if not len(quads):
        return triangles
    return np.vstack([np.column_stack([triangles, np.full(len(triangles), -1)]), quads])


def _triangles(mesh: Meshlike) -> Array:
    """The faces, where all of them are triangles. Raises BadMesh naming the others."""
    faces = mesh.faces
    if faces.shape[1] == 3:
        return faces
    quads = np.flatnonzero(faces[:, 3] >= 0)
    if len(quads):
        raise BadMesh(f"the format holds triangles only, and face {quads[0]} is a quad", quads.tolist(), "faces")
    return faces[:, :3]


def _in_space(mesh: Meshlike) -> Array:
    """#V×3 positions, z = 0 in the plane."""
    positions = mesh.positions
    return positions if positions.shape[1] == 3 else np.column_stack([positions, np.zeros(len(positions))])


def from_meshio(mesh: Any) -> Mesh:
    """A meshio.Mesh: its triangles and quads (in this order), other cells left out.

    Raises BadMesh if there are neither.
    """
    triangles = [block.data for block in mesh.cells if block.type == "triangle"]
    quads = [block.data for block in mesh.cells if block.type == "quad"]
    if not triangles and not quads:
        raise BadMesh("the mesh of meshio has no triangles and no quads")
    empty = np.zeros((0, 0), dtype=np.int64)
    return Mesh(
        np.asarray(mesh.points), _rows(np.vstack(triangles) if triangles else empty, np.vstack(quads) if quads else empty)
    )


def to_meshio(mesh: Union[Meshlike, PlanarMap]) -> Any:
    """A meshio.Mesh. Of a map: its surface, with the point data "u", "v" and the cell data "abs_mu"."""
    import meshio

    surface = mesh.surface if isinstance(mesh, PlanarMap) else mesh
    faces = surface.faces
    is_quad = faces[:, 3] >= 0 if faces.shape[1] == 4 else np.zeros(len(faces), dtype=bool)
    parts = [(name, rows) for name, rows in (("triangle", ~is_quad), ("quad", is_quad)) if rows.any()]
    cells = [(name, np.asarray(faces[rows][:, : 3 if name == "triangle" else 4])) for name, rows in parts]
    if not isinstance(mesh, PlanarMap):
        return meshio.Mesh(np.array(_in_space(surface)), cells)
    values = mesh.distortion.face_abs_mu
    return meshio.Mesh(
        np.array(_in_space(surface)),
        cells,
        point_data={"u": mesh.map.real.copy(), "v": mesh.map.imag.copy()},
        cell_data={"abs_mu": [values[rows] for _, rows in parts]},
    )


def from_trimesh(mesh: Any) -> Mesh:
    """A trimesh.Trimesh, or anything with vertices (#V×3) and faces (#F×3), as meshes of Open3D's arrays have them."""
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))


def from_vtk(polydata: Any) -> Mesh:
    """The triangles and quads of a vtkPolyData, a PyVista PolyData being one.

    Raises BadMesh naming cells that are something else.
    """
    from vtk.util.numpy_support import vtk_to_numpy

    points = vtk_to_numpy(polydata.GetPoints().GetData())
    cells = polydata.GetPolys()
    offsets = vtk_to_numpy(cells.GetOffsetsArray())
    connectivity = vtk_to_numpy(cells.GetConnectivityArray())
    degrees = np.diff(offsets)
    bad = np.flatnonzero((degrees != 3) & (degrees != 4))
    if len(bad):
        raise BadMesh(f"cell {bad[0]} is neither a triangle nor a quad", bad.tolist(), "faces")
    faces = np.full((len(degrees), 4), -1, dtype=np.int64)
    for degree in (3, 4):
        rows = np.flatnonzero(degrees == degree)
        faces[rows, :degree] = connectivity[offsets[rows][:, None] + np.arange(degree)]
    return Mesh(points, faces if (degrees == 4).any() else faces[:, :3])


def to_vtk(mesh: Union[Meshlike, PlanarMap]) -> Any:
    """A vtkPolyData (pyvista.wrap makes PyVista's of it). Of a map: its surface, with texture coordinates and the cell
    array abs_mu."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

    surface = mesh.surface if isinstance(mesh, PlanarMap) else mesh
    faces = surface.faces
    degrees = np.full(len(faces), 3) if faces.shape[1] == 3 else np.where(faces[:, 3] < 0, 3, 4)
    offsets = np.concatenate([[0], np.cumsum(degrees)]).astype(np.int64)
    connectivity = faces[np.arange(faces.shape[1])[None, :] < degrees[:, None]].astype(np.int64)
    result = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.array(_in_space(surface)), deep=True))
    result.SetPoints(points)
    cells = vtk.vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(connectivity, deep=True))
    result.SetPolys(cells)
    if isinstance(mesh, PlanarMap):
        texture = numpy_to_vtk(np.array(mesh.uv), deep=True)
        texture.SetName("uv")
        result.GetPointData().SetTCoords(texture)
        colours = numpy_to_vtk(np.array(mesh.distortion.face_abs_mu), deep=True)
        colours.SetName("abs_mu")
        result.GetCellData().SetScalars(colours)
    return result


def from_gifti(surface: Any) -> Mesh:
    """The surface of a GIFTI file (.surf.gii), or of nibabel's GiftiImage. Needs nibabel.

    Raises Unreadable for an image without points and triangles.
    """
    import nibabel

    image = nibabel.load(surface) if isinstance(surface, (str, os.PathLike)) else surface
    points = image.get_arrays_from_intent("NIFTI_INTENT_POINTSET")
    triangles = image.get_arrays_from_intent("NIFTI_INTENT_TRIANGLE")
    if not points or not triangles:
        raise Unreadable("the GIFTI image has no surface: no point set, or no triangles")
    return Mesh(points[0].data, triangles[0].data)


def to_gifti(mesh: Meshlike, path: Union[PathLike, None] = None) -> Any:
    """nibabel's GiftiImage of a mesh of triangles, written where a path is given. GIFTI holds float32."""
    import nibabel

    arrays = [
        nibabel.gifti.GiftiDataArray(np.asarray(_in_space(mesh), dtype=np.float32), intent="NIFTI_INTENT_POINTSET"),
        nibabel.gifti.GiftiDataArray(np.asarray(_triangles(mesh), dtype=np.int32), intent="NIFTI_INTENT_TRIANGLE"),
    ]
    image = nibabel.gifti.GiftiImage(darrays=arrays)
    if path is not None:
        nibabel.save(image, os.fspath(path))
    return image


def from_freesurfer(path: PathLike) -> Mesh:
    """A surface of FreeSurfer (lh.pial, rh.white, …), in its units (mm). Needs nibabel."""
    from nibabel.freesurfer import read_geometry

    positions, faces = read_geometry(os.fspath(path))[:2]
    return Mesh(np.asarray(positions, dtype=np.float64), faces)


def to_freesurfer(mesh: Meshlike, path: PathLike) -> None:
    """Writes a mesh of triangles as FreeSurfer does, in float32."""
    from nibabel.freesurfer import write_geometry

    write_geometry(os.fspath(path), np.asarray(_in_space(mesh)), np.asarray(_triangles(mesh)))
