"""Meshes of other packages: there and back."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import beltrami as bt

MIXED = bt.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 0.1]], [[1, 4, 2], [0, 1, 2, 3]])


def test_meshio(cap: bt.Surface, tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    again = bt.from_meshio(bt.to_meshio(MIXED))
    assert np.array_equal(again.positions, MIXED.positions) and np.array_equal(again.faces, MIXED.faces)
    result = bt.extremal_map(cap, bt.boundary_to_disk(cap))
    meshio.write(tmp_path / "map.vtu", bt.to_meshio(result))
    read = meshio.read(tmp_path / "map.vtu")
    assert np.array_equal(read.point_data["u"] + 1j * read.point_data["v"], result.map)
    assert np.allclose(read.cell_data["abs_mu"][0], result.distortion.face_abs_mu)
    assert np.array_equal(bt.from_meshio(read).faces, cap.faces)
    with pytest.raises(bt.BadMesh):
        bt.from_meshio(meshio.Mesh([[0, 0, 0], [1, 0, 0]], [("line", [[0, 1]])]))


def test_trimesh_and_whatever_has_vertices_and_faces(cap: bt.Surface) -> None:
    mesh = SimpleNamespace(vertices=np.array(cap.positions), faces=np.array(cap.faces))
    again = bt.from_trimesh(mesh)
    assert np.array_equal(again.positions, cap.positions) and np.array_equal(again.faces, cap.faces)


def test_vtk(cap: bt.Surface) -> None:
    pytest.importorskip("vtk")
    again = bt.from_vtk(bt.to_vtk(MIXED))
    assert np.array_equal(again.positions, MIXED.positions) and np.array_equal(again.faces, MIXED.faces)
    result = bt.extremal_map(cap, bt.boundary_to_disk(cap))
    polydata = bt.to_vtk(result)
    from vtk.util.numpy_support import vtk_to_numpy

    assert np.array_equal(vtk_to_numpy(polydata.GetPointData().GetTCoords()), result.uv)
    assert np.array_equal(bt.from_vtk(polydata).faces, cap.faces)


def test_gifti_and_freesurfer(cap: bt.Surface, tmp_path: Path) -> None:
    pytest.importorskip("nibabel")
    bt.to_gifti(cap, tmp_path / "cap.surf.gii")
    for again in (bt.from_gifti(tmp_path / "cap.surf.gii"), bt.from_gifti(bt.to_gifti(cap))):
        assert np.array_equal(again.positions, cap.positions.astype(np.float32)) and np.array_equal(again.faces, cap.faces)
    bt.to_freesurfer(cap, tmp_path / "lh.cap")
    again = bt.from_freesurfer(tmp_path / "lh.cap")
    assert np.allclose(again.positions, cap.positions, atol=1e-6) and np.array_equal(again.faces, cap.faces)
    assert bt.Surface(again).genus == 0
    with pytest.raises(bt.BadMesh) as caught:
        bt.to_gifti(MIXED)
    assert caught.value.indices == [1]
