"""Closed surfaces with handles: homology, flat tori, hyperbolic surfaces, maps and distances between them."""

import json

import numpy as np
import pytest

import beltrami as bt


@pytest.fixture(scope="module")
def pretzel() -> bt.Surface:
    return bt.Surface(bt.double_torus(0.2))


@pytest.fixture(scope="module")
def shape(pretzel: bt.Surface) -> bt.HyperbolicShape:
    return bt.HyperbolicShape(pretzel)


def test_forms_of_a_torus() -> None:
    torus = bt.Surface(bt.torus(2, 1, 24, 12))
    basis = bt.homology_basis(torus)
    change = bt.symplectic_basis(basis.intersections)
    assert np.array_equal(change.T @ basis.intersections @ change, [[0, 1], [-1, 0]])
    forms, energies, _ = bt.harmonic_basis(torus)
    wedge = bt.wedge_products(torus, forms)
    assert np.allclose(wedge, -wedge.T) and abs(wedge[0, 1]) == pytest.approx(1)
    disk, old = bt.cut_open(torus)
    assert bt.Surface(disk).euler_characteristic == 1 and np.array_equal(disk.positions, torus.positions[old])
    with pytest.raises(bt.BadOption):
        bt.symplectic_basis([[0, 1], [1, 0]])
    with pytest.raises(bt.BadMesh):
        bt.cut_open(bt.Surface(bt.disk(3)))


def test_markings_of_tori() -> None:
    fat, thin = (bt.Surface(bt.torus(2, r, 32, 16)) for r in (1, 0.7))
    a, b = bt.flat_torus(fat), bt.flat_torus(thin)
    paths = a.homology.loops
    assert np.array_equal(bt.marking_of_paths(a, paths, b, b.homology.loops).astype(int).shape, (2, 2))
    same = bt.marking_of_paths(a, paths, a, paths)
    assert np.array_equal(same, np.eye(2))
    assert len(bt.torus_class(a, paths[0])) == 2 and bt.flat_areas(a).sum() == pytest.approx(abs(a.tau.imag), rel=1e-6)
    assert np.array_equal(bt.nearest_marking(a.tau, a.tau), np.eye(2))
    by_points = bt.register_tori(fat, thin)
    searched = bt.register_tori(fat, thin, search=True)
    assert by_points.K == pytest.approx(searched.K) and json.loads(by_points.to_json())["registration"]
    path = [v for v in range(0, 16)]
    twisted = bt.register_tori(fat, thin, twists=[(paths[0], 1)])
    assert twisted.K > searched.K and len(path) == 16
    assert by_points.positions.shape == (fat.vertex_count, 3) and by_points.K_lower <= by_points.K <= by_points.K_upper
    with pytest.raises(bt.BadOption):
        bt.hyperbolic_distance(1j, -1j)
    with pytest.raises(bt.BadOption):
        bt.marking_of_paths(a, [paths[0], paths[0]], b, b.homology.loops)


def test_hyperbolic_metrics(pretzel: bt.Surface, shape: bt.HyperbolicShape) -> None:
    metric = bt.hyperbolic_surface(pretzel)
    assert metric.genus == 2 and metric.area == pytest.approx(4 * np.pi) and metric.residual < 1e-8
    domain = bt.hyperbolic_domain(shape)
    assert len(domain.generators) == 4 == len(domain.paths) and domain.relation < 1e-6
    for matrix in domain.generators:
        assert np.linalg.det(matrix) == pytest.approx(1)
    points, corners = domain.layout
    assert np.linalg.norm(points, axis=1).max() < 1 and len(corners) == 3 * pretzel.face_count
    assert json.loads(domain.to_json())["hyperbolic"]
    kernel = shape.differentials()
    assert len(kernel) == 3 and np.abs(kernel).max() < 0.2
    with pytest.raises(bt.BadMesh):
        bt.HyperbolicShape(bt.Surface(bt.torus(2, 1, 12, 8)))


def test_maps_of_handles(pretzel: bt.Surface, shape: bt.HyperbolicShape) -> None:
    stretched = bt.Surface(pretzel.positions * [1.2, 1, 1], pretzel.faces)
    calls: list = []
    found = bt.register_handles(shape, stretched, progress=lambda i, k: calls.append(i))
    assert calls and 1 <= found.K_homology <= found.K * 1.01 and found.no_flips
    assert found.positions.shape == (pretzel.vertex_count, 3) and len(found.places) == pretzel.vertex_count
    assert np.linalg.norm(found.positions - stretched.positions, axis=1).max() < 1
    target = bt.HyperbolicShape(stretched)
    start, mended, defect = bt.marking_by_vertices(shape, target, np.arange(pretzel.vertex_count))
    assert mended == 0 and defect < 1e-6
    again = bt.hyperbolic_map(shape, target, start)
    assert again.K == pytest.approx(found.K, rel=1e-3)
    assert bt.homology_bound(shape, target, again.homology) == pytest.approx(again.K_homology)
    back = bt.register_handles(stretched, pretzel)
    distance = bt.hyperbolic_distance_of(found, back)
    assert 0 < distance.lower <= distance.distance <= distance.upper and json.loads(distance.to_json())["settled"] in (True, False)
    matrix, lower, upper, _ = bt.handle_distances([pretzel, stretched])
    assert matrix[0, 1] == matrix[1, 0] == pytest.approx(distance.distance, rel=1e-2) and lower[0, 1] <= upper[0, 1]
    sought = bt.handle_distances([pretzel, stretched], search=True)[0]
    assert sought[0, 1] == pytest.approx(matrix[0, 1], rel=5e-2)
    inverse, _, _ = bt.inverse_marking(shape, target, found)
    assert inverse.bases.shape == (stretched.vertex_count,)
    with pytest.raises(bt.Cancelled):
        bt.hyperbolic_map(shape, target, start, progress=lambda i, k: False)
    with pytest.raises(bt.BadOption):
        bt.marking_by_vertices(shape, target, [0, 1])
    other = bt.HyperbolicShape(bt.Surface(bt.double_torus(0.25)))
    with pytest.raises(bt.BadOption):
        bt.hyperbolic_map(other, target, start)


def test_classes_by_loops_and_twists(shape: bt.HyperbolicShape) -> None:
    paths = bt.hyperbolic_domain(shape).paths
    same, mended, defect = bt.marking_by_loops(shape, shape, paths, paths)
    assert mended == 0 and defect < 1e-6
    identity = bt.hyperbolic_map(shape, shape, same)
    assert identity.K == pytest.approx(1, abs=1e-2)
    twist = bt.twisted(shape, same, bt.homology_basis(shape.surface).loops[0], 1)
    assert bt.hyperbolic_map(shape, shape, twist, max_iterations=5).K > 1.1
    assert np.array_equal(bt.nearest_vertices(shape.surface, shape.surface.positions[[3, 5]]), [3, 5])
    with pytest.raises(bt.BadOption):
        bt.twisted(shape, same, [0, 1, 0], 1)


def test_alignment() -> None:
    mesh = bt.icosahedral_sphere(3)
    potato = bt.Mesh(mesh.positions * [1, 0.7, 1.4] + 0.4 * mesh.positions**2 * [1, 1, 0.5], mesh.faces)  # no symmetries
    angle = 0.4
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    moved = bt.Mesh(potato.positions @ turn.T + 3, mesh.faces)
    assert np.allclose(bt.aligned(moved, potato), potato.positions, atol=1e-3)
    assert np.array_equal(bt.aligned(moved, potato, "none"), moved.positions)
