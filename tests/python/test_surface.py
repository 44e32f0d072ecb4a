"""Arrays into surfaces and out of them."""

import gc
import pickle

import numpy as np
import pytest

import beltrami as bt

V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]], dtype=float)
F = np.array([[0, 1, 2], [0, 2, 3]])


def test_surface_says_what_it_is() -> None:
    surface = bt.Surface(V, F)
    assert repr(surface) == "<beltrami.Surface: 4 vertices, 2 faces, genus 0, 1 boundary loop>"
    assert surface.vertex_count == 4 and surface.face_count == 2 and surface.sample_count == 2
    assert np.array_equal(surface.boundary_loops[0], [0, 1, 2, 3])
    assert surface.edges.shape == (5, 2) and surface.euler_characteristic == 1 and not surface.in_plane
    assert np.isclose(surface.weights.sum(), surface.area)


@pytest.mark.parametrize("kind", [np.float32, np.float64, np.float16, ">f8", np.longdouble])
@pytest.mark.parametrize("whole", [np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint64, ">i4"])
def test_numbers_of_all_kinds(kind: str, whole: str) -> None:
    surface = bt.Surface(V.astype(kind), F.astype(whole))
    assert np.allclose(surface.positions, V, atol=1e-3)
    assert np.array_equal(surface.faces, F)


def test_layouts() -> None:
    padded = np.zeros((4, 6))
    padded[:, ::2] = V
    readonly = V.copy()
    readonly.setflags(write=False)
    misaligned = np.frombuffer(b"x" + V.tobytes(), dtype=np.uint8)[1:].view(np.float64).reshape(4, 3)
    for positions in (padded[:, ::2], np.asfortranarray(V), readonly, misaligned, V[::-1][::-1], V.tolist()):
        assert np.array_equal(bt.Surface(positions, F).positions, V)
    for faces in (F.tolist(), np.asfortranarray(F), [tuple(f) for f in F]):
        assert np.array_equal(bt.Surface(V, faces).faces, F)


def test_fields_are_views_and_keep_their_owner() -> None:
    surface = bt.Surface(V, F)
    positions = surface.positions
    assert not positions.flags.writeable and not positions.flags.owndata
    assert np.shares_memory(positions, surface.positions)
    del surface
    gc.collect()
    assert np.array_equal(positions, V)


def test_the_surface_has_a_copy_of_its_own() -> None:
    mine = V.copy()
    surface = bt.Surface(mine, F)
    mine[:] = np.nan
    assert np.array_equal(surface.positions, V)


def test_quads_and_triangles() -> None:
    mixed = bt.Mesh([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0.5]], [[0, 1, 2, 3], [1, 4, 2]])
    assert np.array_equal(mixed.faces, [[0, 1, 2, 3], [1, 4, 2, -1]])
    surface = bt.Surface(mixed)
    assert surface.sample_count == 5
    assert np.array_equal(bt.Surface(mixed.positions, mixed.faces).faces, mixed.faces)


def test_a_metric_of_its_own() -> None:
    mesh = bt.Mesh(V[:, :2], F)
    edges = bt.Surface(mesh).edges
    lengths = [2 * np.linalg.norm(mesh.positions[a] - mesh.positions[b]) for a, b in edges]
    surface = bt.Surface(mesh, metric=bt.corners_from_lengths(mesh, edges, lengths))
    assert np.isclose(surface.area, 4)
    with pytest.raises(bt.BadOption):
        bt.Surface(mesh, metric=np.zeros((5, 2)))


def test_errors_name_places() -> None:
    with pytest.raises(bt.BadMesh) as caught:
        bt.Surface(V, [[0, 1, 2], [0, 2, 9]])
    assert caught.value.indices == [1] and caught.value.where == "faces"
    bad = V.copy()
    bad[2, 1] = np.inf
    with pytest.raises(bt.BadMesh) as caught:
        bt.Surface(bad, F)
    assert caught.value.indices == [2] and isinstance(caught.value, ValueError)
    with pytest.raises(bt.BadMesh) as caught:
        bt.Surface(V, [[0, 1, 2], [0, 3, 2], [0, 2, 1]])
    assert caught.value.indices
    copied = pickle.loads(pickle.dumps(caught.value))
    assert type(copied) is bt.BadMesh and copied.indices == caught.value.indices and str(copied) == str(caught.value)


def test_operators_are_scipys(disk: bt.Surface) -> None:
    z = disk.positions[:, 0] + 1j * disk.positions[:, 1]
    assert np.allclose(disk.d_z() @ z, 1) and np.allclose(disk.d_zbar() @ z, 0)
    assert np.allclose(disk.d_zbar() @ z.conj(), 1)


def test_edits() -> None:
    sphere = bt.icosahedral_sphere(2)
    cut, vertices, faces = bt.cut_by_plane(sphere, (0, 0, 0.1), (0, 0, 1))
    assert np.isclose(cut.positions[:, 2].min(), 0.1) and len(faces) == cut.face_count
    old = vertices >= 0
    assert np.array_equal(cut.positions[old], sphere.positions[vertices[old]])
    finer, parents, _ = bt.midpoint_subdivide(cut)
    assert finer.face_count == 4 * cut.face_count
    means = bt.with_parents_means(cut.positions[:, 0], parents)
    assert np.allclose(means.real, finer.positions[:, 0])
    soup = bt.Mesh(sphere.positions[sphere.faces].reshape(-1, 3), np.arange(3 * sphere.face_count).reshape(-1, 3))
    welded, new = bt.weld(soup)
    assert welded.vertex_count == sphere.vertex_count and len(new) == soup.vertex_count
    assert len(bt.component_faces(soup)) == sphere.face_count
    part, _, kept = bt.keep_faces(sphere, [0, 5])
    assert part.face_count == 2 and list(kept) == [0, 5]
    with pytest.raises(bt.BadOption):
        bt.keep_faces(sphere, [5, 0])
    ring = bt.Surface(bt.annulus(0.4, 1, 24))
    assert len(bt.fill_holes(ring).boundary_loops) == 1


def test_generators() -> None:
    assert bt.rectangle(2, 1, 4, 2, cells="quads").faces.shape == (8, 4)
    assert bt.Surface(bt.torus(2, 1, 12, 8)).genus == 1
    assert bt.Surface(bt.double_torus(0.25)).genus == 2
    assert bt.Surface(bt.cylinder(1, 2, 12, 4)).euler_characteristic == 0
    assert bt.octahedral_sphere(1).face_count == 32
    assert bt.disk_rings_for_triangles(600) == 10
    holed = bt.Surface(bt.circle_domain(1, [(0.3 + 0.1j, 0.2), (-0.4j, 0.15)], edge_length=0.15))
    assert len(holed.boundary_loops) == 3
    assert bt.quality(bt.polygon_domain([[0, 0], [2, 0], [2, 1], [0, 1]], edge_length=0.2)).min_angle > 0.4
    with pytest.raises(bt.BadOption):
        bt.rectangle(1, 1, 2, 2, cells="hexagons")
    with pytest.raises(TypeError, match="edge_size"):
        bt.circle_domain(1, edge_size=3)
