"""Places, circles, curves, layouts, files in memory: small things that solvers stand on."""

from pathlib import Path

import numpy as np
import pytest

import beltrami as bt


def test_places_are_located(disk: bt.Surface, cap: bt.Surface) -> None:
    locator = bt.PlanarLocator(disk)
    middles = disk.positions[disk.faces].mean(axis=1)
    found = locator.locate(middles)
    assert np.array_equal(found.face, np.arange(disk.face_count)) and locator.locate([5.0]).face[0] == -1
    assert np.allclose(bt.positions_on(disk, found), middles)
    assert np.allclose(bt.corner_weights(disk, found), 1 / 3)
    edge = locator.nearest([5.0, 5j])
    assert np.allclose(bt.positions_on(disk, edge), [[1, 0], [0, 1]], atol=1e-2) and locator.diameter > 2
    with pytest.raises(bt.BadMesh):
        bt.PlanarLocator(cap)
    with pytest.raises(bt.BadOption):
        locator.locate([np.nan])


def test_curves_run_along_edges(cap: bt.Surface) -> None:
    rim = cap.boundary_loops[0]
    mesh, places, faces, curves = bt.mesh_with_curves(cap, [([int(rim[0]), int(rim[len(rim) // 2])], False)])
    vertices, lengths, length = curves[0]
    assert vertices[0] == rim[0] and vertices[-1] == rim[len(rim) // 2] and lengths[-1] == pytest.approx(length)
    assert mesh.vertex_count == cap.vertex_count + len(places) and len(faces) == mesh.face_count
    straight = np.linalg.norm(np.diff(mesh.positions[vertices], axis=0), axis=1).sum()
    assert straight == pytest.approx(length) and bt.Surface(mesh).area == pytest.approx(cap.area)
    with pytest.raises(bt.BadBoundary):
        bt.mesh_with_curves(cap, [([3], False)])
    with pytest.raises(TypeError):
        bt.mesh_with_curves(cap, [3])


def test_moebius_maps() -> None:
    move = bt.DiskMoebius(0.3, 0.2 + 0.1j)
    assert np.allclose(move([0.2 + 0.1j]), 0) and np.allclose(np.abs(move(np.exp([1j, 2j]))), 1)
    places = np.array([0.1, -0.3j, 0.4 + 0.2j])
    found = bt.best_move(places, move(places))
    assert found.centre == pytest.approx(move.centre) and found.rotation == pytest.approx(move.rotation)
    assert bt.best_rotation(places, np.exp(0.5j) * places).rotation == pytest.approx(0.5)
    centre, radius = bt.hyperbolic_circle((0.0, 0.5))
    assert centre == 0 and radius == pytest.approx(2 * np.arctanh(0.5))
    _, at, r = bt.centring((0.3, 0.2)).hole((0.3, 0.2))
    assert abs(at) < 1e-12 and r < 0.3
    assert bt.hyperbolic_gap(0, 0.5) == pytest.approx(np.sinh(np.arctanh(0.5)) ** 2)
    points = bt.DiskMoebius(0, 0.4)(np.exp(2j * np.pi * np.arange(7) / 7))
    assert abs(bt.centre_in_disk(points).mean()) < 1e-9
    with pytest.raises(bt.BadOption):
        bt.DiskMoebius(0, 1.0)
    with pytest.raises(bt.BadOption):
        bt.best_move([2.0], [0.0])


def test_boundaries_that_correspond(cap: bt.Surface, disk: bt.Surface) -> None:
    a, b = cap.boundary_loops[0], disk.boundary_loops[0]
    partner, (places,) = bt.boundary_correspondence(cap, disk, [(a[0], b[5]), (a[20], b[25])])
    assert list(partner) == [0] and len(places) == len(a)
    assert np.allclose(bt.positions_on(disk, places)[0], disk.positions[b[5]])
    with pytest.raises(bt.BadBoundary):
        bt.boundary_correspondence(cap, disk, [(0, b[5])])


def test_corners_are_reached(cap: bt.Surface) -> None:
    square = bt.TargetDomain(bt.TargetCurve.polygon([0, 1, 1 + 1j, 1j]))
    result = bt.extremal_map(cap, square)
    map, reached = bt.reach_corners(result.surface, square, result.loops, result.map)
    assert reached == 4
    assert all(np.abs(map - corner).min() < 1e-12 for corner in (0, 1, 1 + 1j, 1j))
    assert bt.PlanarMap(result.surface, map).one_to_one
    with pytest.raises(bt.BadOption):
        bt.reach_corners(result.surface, square, [(0, 7, result.loops[0][2])], result.map)
    vertex, curve, s = bt.nearest_mark(square, 3, 0.5 - 0.1j)
    assert (vertex, curve) == (3, 0) and s == pytest.approx(0.5)
    assert bt.distance_from(square, (3, 0, 0.5), 0.5 - 0.1j) == pytest.approx(0.1 / 4)


def test_planar_meshes() -> None:
    square = bt.rectangle(2, 1, 2, 1)
    under = bt.Mesh(square.positions, square.faces[:, ::-1])
    assert bt.seen_from_below(under) and not bt.seen_from_below(square)
    assert np.array_equal(bt.planar_coordinates(under).conj(), bt.planar_coordinates(square))
    assert np.allclose(bt.fitted_to_unit_square(square.positions + 5).max(axis=0), [1, 0.5])
    assert np.allclose(bt.face_vector_area(square, 0), [0, 0, 0.5])
    assert bt.corner_positions(square).shape == (3 * square.face_count, 2)
    measured = bt.distortion_to(square, bt.Mesh(square.positions * [2, 1], square.faces))
    assert np.allclose(measured.face_abs_mu, 1 / 3)
    mean, deviation, p99, largest = bt.mu_statistics([0.1, 0.3], [1, 1])
    assert (mean, largest) == pytest.approx((0.2, 0.3)) and deviation == pytest.approx(0.1) and p99 == pytest.approx(0.3)
    with pytest.raises(bt.BadMesh):
        bt.distortion_to(square, under)
    with pytest.raises(bt.BadMesh):
        bt.planar_coordinates(bt.icosahedral_sphere(0))
    with pytest.raises(bt.BadOption):
        bt.face_vector_area(square, 99)


def test_frames(disk: bt.Surface) -> None:
    z = disk.positions[:, 0] + 1j * disk.positions[:, 1]
    edges = z[disk.faces[:, 1]] - z[disk.faces[:, 0]]
    assert np.allclose(bt.first_edge_directions(disk), edges / np.abs(edges))
    sphere = bt.Surface(bt.icosahedral_sphere(2))
    assert np.abs(bt.stereographic_derivatives(sphere)).min() > 0
    assert np.allclose(np.abs(bt.mu_at_samples(sphere, np.full(sphere.face_count, 0.3), "stereographic")), 0.3)
    with pytest.raises(bt.BadOption):
        bt.stereographic_derivatives(disk)


def test_layouts_of_disks(cap: bt.Surface, disk: bt.Surface, ring: bt.Surface) -> None:
    flat, fold_free, unfolded = bt.fold_free_flattening(cap)
    assert fold_free and len(unfolded) == 0 and flat.one_to_one
    chart = bt.plane_chart(disk)
    assert np.allclose(np.abs(chart.map).max(), 1, atol=0.05) and chart.distortion.max < 1e-12
    bt.require_disk(cap), bt.require_open_component(ring), bt.require_genus_zero(ring), bt.require_triangles(ring)
    bt.require_sphere(bt.Surface(bt.icosahedral_sphere(1)))
    for refuses, surface in ((bt.require_disk, ring), (bt.require_sphere, ring), (bt.plane_chart, cap)):
        with pytest.raises(bt.BadMesh):
            refuses(surface)


def test_ways_around_holes() -> None:
    ring = bt.Surface(bt.annulus(0.1, 1, 96))
    boundary = bt.boundary_to_disk(ring) + bt.hole_to_circle(ring, 1, 0, 0.1)
    path = bt.loop_paths(ring)[1]
    assert path[0] in ring.boundary_loops[0] and path[-1] in ring.boundary_loops[1]
    centre, inner, outer = bt.hole_ring(ring, 1)
    assert abs(centre) < 1e-6 and 0.09 < inner < outer <= 1
    map = bt.logarithmic_map(ring, boundary, 1)
    assert bt.homotopy_class(ring, map) == {1: 1}
    steps = bt.continuation_steps(ring, boundary, substeps=4)
    assert len(steps) == 4 and np.array_equal(steps[-1].images, boundary.images)
    assert bt.smallest_angle(1, 1j) == pytest.approx(np.pi / 2)
    with pytest.raises(bt.BadMesh):
        bt.logarithmic_map(bt.Surface(bt.disk(4)), boundary)


def test_transfer() -> None:
    mesh = bt.icosahedral_sphere(3)
    a = bt.Surface(bt.Mesh(mesh.positions * [1, 0.8, 1.2], mesh.faces, texture=(mesh.positions[:, :2], mesh.faces.ravel())))
    b = bt.Surface(mesh.positions * [1.1, 1, 0.9], mesh.faces)
    found = bt.register_spheres(a, b, [0, 3, 7, 9, 11], [0, 3, 7, 9, 11])
    map = found.correspondence
    assert np.array_equal(bt.transferred_vertex_values(map, a.positions), found.transfer(a.positions))
    ones = bt.transferred_face_values(map, np.ones(a.face_count))
    assert ones.shape == (b.face_count, 1) and np.allclose(ones, 1)
    points, corners = bt.transferred_texture(map)
    assert points.shape[1] == 2 and len(corners) == 3 * b.face_count
    with pytest.raises(bt.BadMesh):
        bt.transferred_texture(map, to_source=True)
    corners, some = bt.places_of_vertices(a), [0, 40, 80]
    ends = bt.Places(corners.face[some], corners.vertices[some], corners.barycentric[some])
    line, given = bt.transferred_polyline(map, ends)
    assert len(given) == 3 and given[0] == 0 and given[-1] == len(line) - 1
    assert np.allclose(line.interpolate(b.positions)[given], found.positions[[0, 40, 80]], atol=1e-9)
    again = bt.SurfaceCorrespondence(a, b, bt.sphere_map(b).positions, found.places)
    places = bt.places_of_vertices(a)
    assert np.allclose(again.forward(places).interpolate(b.positions), found.positions, atol=1e-9)
    with pytest.raises(bt.BadOption):
        bt.SurfaceCorrespondence(a, b, a.positions[:3], found.places)


def test_least_lp_registrations(cap: bt.Surface, disk: bt.Surface) -> None:
    found = bt.register_least_lp(cap, disk, [0], [0], p=4)
    assert np.allclose(found.positions[0, :2], disk.positions[0]) and found.K is None
    mesh = bt.icosahedral_sphere(3)
    a, b = (bt.Surface(mesh.positions * scale, mesh.faces) for scale in ([1, 0.8, 1.2], [1.1, 1, 0.9]))
    curve = [0, 1]
    closed = bt.register_least_lp(a, b, curves=[(curve, curve)], max_iterations=20)
    assert closed.no_flips and closed.positions.shape == (a.vertex_count, 3) and closed.correspondence is not None
    with pytest.raises(TypeError):
        bt.register_least_lp(a, b, curves=[3])


def test_rings(ring: bt.Surface) -> None:
    assert bt.ring_module(ring) == pytest.approx(np.log(1 / 0.4), rel=1e-2)
    with pytest.raises(bt.BadMesh):
        bt.ring_module(bt.Surface(bt.disk(4)))


def test_files_in_memory(disk: bt.Surface, tmp_path: Path) -> None:
    for kind in ("obj", "ply", "off"):
        path = tmp_path / f"disk.{kind}"
        bt.write_mesh(path, disk)
        mesh = getattr(bt, f"read_{kind}")(path.read_bytes())
        assert np.array_equal(mesh.faces, disk.faces)
    with pytest.raises(bt.Unreadable, match="my file"):
        bt.read_stl(b"nothing", "my file")


def test_meshes_and_surfaces_are_taken_alike(disk: bt.Surface) -> None:
    assert bt.quality(disk).min_angle == bt.quality(bt.Mesh(disk)).min_angle
    assert bt.angle_statistics(disk).smallest == pytest.approx(np.degrees(bt.quality(disk).min_angle))
