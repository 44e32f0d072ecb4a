"""The other rooms of the library: charts, flow, distances, grids, classes, spheres, tori, registration, files."""

from pathlib import Path

import numpy as np
import pytest

import beltrami as bt


@pytest.fixture(scope="module")
def two_holes() -> bt.Surface:
    return bt.Surface(bt.circle_domain(1, [(0.45, 0.2), (-0.4 + 0.1j, 0.25)], edge_length=0.13))


def test_flatten_and_charts(cap: bt.Surface) -> None:
    flat = bt.flatten(cap)
    assert flat.distortion.mean < 0.05 and flat.residual < 1e-8 and flat.log_scale.shape == (cap.vertex_count,)
    disk = bt.round_disk_chart(cap)
    assert np.allclose(np.abs(disk.map[cap.boundary_loops[0]]), 1) and disk.distortion.mean < 0.05
    n = len(cap.boundary_loops[0])
    polygon = bt.flatten(cap, np.full(n, (n - 2) * np.pi / n))
    assert polygon.one_to_one
    with pytest.raises(bt.BadBoundary):
        bt.flatten(cap, np.full(n, 1.0))


def test_circle_domains(two_holes: bt.Surface, ring: bt.Surface) -> None:
    found = bt.uniformization(two_holes)
    assert len(found.holes) == 2 and len(found.moduli) == 3 and abs(found.holes[0][1]) < 1e-9
    assert bt.uniformization(ring).module == pytest.approx(np.log(1 / 0.4) / 2 / np.pi, rel=1e-3)
    circles = bt.circle_domain_chart(two_holes)
    assert sorted(r for _, _, r in circles.holes) == pytest.approx([0.2, 0.25], rel=0.2)
    assert bt.domain_chart(two_holes).map.shape == (two_holes.vertex_count,)
    partner, rotation, centre, distance = bt.match_circle_domains(circles.holes, circles.holes[::-1])
    assert list(partner) == [1, 0] and distance < 1e-6 and abs(centre) < 1e-6 and abs(rotation) < 1e-6
    with pytest.raises(bt.BadOption):
        bt.circle_domain_chart(two_holes, outer_loop=7)


def test_flows(ring: bt.Surface) -> None:
    domain = bt.TargetDomain(bt.TargetCurve.circle(0, 1), [bt.TargetCurve.circle(0, 0.4)])
    flow = bt.beltrami_flow(ring, domain, np.zeros(ring.sample_count))
    assert flow.fits and flow.l2 < 0.02
    errors = bt.coefficient_error(ring, flow.map, np.zeros(ring.sample_count))
    assert errors["l2"] == pytest.approx(flow.l2)
    scheme = bt.t_map_scheme(ring, domain, max_solves=5)
    assert scheme.solves <= 5 and scheme.method == "t-map"
    with pytest.raises(bt.BadOption) as caught:
        bt.beltrami_flow(ring, domain, np.full(ring.sample_count, 1.1))
    assert len(caught.value.indices) == ring.sample_count
    with pytest.raises(bt.Cancelled):
        bt.beltrami_flow(ring, domain, np.full(ring.sample_count, 0.2), progress=lambda i, e: False)


def test_distances(ring: bt.Surface) -> None:
    rings = [ring, bt.Surface(bt.annulus(0.3, 1, 40)), bt.Surface(bt.annulus(0.2, 1, 40))]
    calls: list = []
    distance, lower, upper, unsettled = bt.distance_matrix(rings, progress=lambda done, all: calls.append((done, all)))
    assert np.array_equal(distance, distance.T) and calls[-1] == (3, 3) and len(unsettled) == 0
    assert np.all(lower <= distance) and np.all(distance <= upper)
    wanted = 0.5 * abs(np.log(np.log(0.4) / np.log(0.3)))
    assert distance[0, 1] == pytest.approx(wanted, rel=1e-2)
    one = bt.teichmueller_distance(rings[0], rings[1])
    assert one.distance == distance[0, 1] and one.settled and float(one) == one.distance
    tree = bt.cluster_by_distance(distance)
    assert tree.shape == (2, 4) and tree[-1, 3] == 3
    with pytest.raises(bt.BadOption):
        bt.cluster_by_distance([[0, 1], [2, 0]])
    with pytest.raises(bt.BadBoundary):
        bt.distance_matrix([ring, bt.Surface(bt.disk(5))])


def test_distances_of_domains_with_holes(two_holes: bt.Surface) -> None:
    other = bt.Surface(bt.circle_domain(1, [(0.45, 0.15), (-0.4, 0.3)], edge_length=0.15))
    one = bt.teichmueller_distance(two_holes, other)
    assert 0 < one.lower <= one.distance <= one.upper
    assert bt.distance_matrix([two_holes, other])[0][0, 1] == one.distance


def test_grids(cap: bt.Surface) -> None:
    result = bt.extremal_map(cap, bt.boundary_to_rectangle(cap, 1, 1))
    domain = bt.TargetDomain(bt.TargetCurve.polygon([0, 1, 1 + 1j, 1j]))
    grid = bt.grid_on_surface(cap, result.map, bt.fitting_grid(domain, 8))
    assert grid.whole_cells == 64 and len(grid.folded) == 0 and grid.cells.shape == (grid.mesh.face_count, 2)
    assert np.allclose(grid.places.interpolate(cap.positions), grid.mesh.positions)
    mapped, carried, unit = bt.conformal_carrier(cap)
    polar = bt.grid_on_surface(mapped, carried, bt.PlaneGrid.polar(0, 0.25, 12), border="stepped")
    assert polar.mesh.face_count > 0 and unit.curve_count == 1
    places, distances = bt.nearest_places(bt.Mesh(cap.positions, cap.faces), grid.mesh.positions)
    assert distances.max() < 1e-9 and len(places) == len(distances)


def test_classes() -> None:
    ring = bt.Surface(bt.annulus(0.1, 1, 96))
    boundary = bt.boundary_to_disk(ring) + bt.hole_to_circle(ring, 1, 0, 0.1)
    start = bt.start_in_class(ring, boundary, [0, 1])
    assert bt.homotopy_class(ring, start) == {1: 1}
    z = ring.positions[:, 0] + 1j * ring.positions[:, 1]
    assert bt.homotopy_class(ring, bt.twisted_map(ring, z, [0, -1])) == {1: -1}
    assert bt.homotopy_class(ring, bt.follow(ring, boundary)) == {1: 0}


def test_spheres() -> None:
    mesh = bt.icosahedral_sphere(3)
    potato = bt.Surface(mesh.positions * [1, 0.8, 1.2], mesh.faces)
    sphere = bt.sphere_map(potato)
    assert np.allclose(np.linalg.norm(sphere.positions, axis=1), 1) and sphere.distortion.mean < 0.1
    vertices = [0, 3, 7, 9, 11]
    images = sphere.positions[vertices] + [[0.1, 0, 0]] * 5
    images /= np.linalg.norm(images, axis=1)[:, None]
    found = bt.extremal_sphere_map(potato, sphere.positions, vertices, images)
    assert np.allclose(found.positions[vertices], images) and found.K > 1 and len(found.distortion.flipped) == 0
    with pytest.raises(bt.BadBoundary):
        bt.extremal_sphere_map(potato, sphere.positions, [0, 0], images[:2])
    with pytest.raises(bt.BadMesh):
        bt.sphere_map(bt.Surface(bt.disk(4)))


def test_tori() -> None:
    fat, thin = (bt.Surface(bt.torus(2, r, 40, 20)) for r in (1, 0.7))
    flat = bt.flat_torus(fat)
    assert flat.tau.real == pytest.approx(0, abs=1e-9) and flat.lattice.shape == (fat.vertex_count, 2)
    assert np.allclose(flat.places(flat.lattice).interpolate(fat.positions), fat.positions, atol=1e-6)
    map = bt.torus_map(flat, bt.flat_torus(thin))
    distance, lower, upper, tau = bt.torus_distances([fat, thin])
    assert 0.5 * np.log(map.K) == pytest.approx(distance[0, 1]) and lower[0, 1] <= upper[0, 1] and len(tau) == 2
    basis = bt.homology_basis(fat)
    assert len(basis.loops) == 2 and list(bt.homology_class(fat, basis, basis.loops[0])) == [1, 0]
    assert bt.period_matrix(bt.Surface(bt.double_torus(0.2))).shape == (2, 2)
    forms, energies, _ = bt.harmonic_basis(fat)
    assert forms.shape == (len(fat.edges), 2) and np.allclose(energies, energies.T)


def test_registration() -> None:
    mesh = bt.icosahedral_sphere(3)
    a = bt.Surface(mesh.positions * [1, 0.8, 1.2], mesh.faces)
    b = bt.Surface(mesh.positions * [1.1, 1, 0.9], mesh.faces)
    vertices = [0, 3, 7, 9, 11]
    found = bt.register_spheres(a, b, vertices, vertices)
    assert np.allclose(found.positions[vertices], b.positions[vertices])
    values = found.transfer(a.positions[:, 0])
    assert values.shape == (b.vertex_count, 1) and np.allclose(values[vertices, 0], a.positions[vertices, 0])
    there = found.forward(found.back(found.places))
    assert np.allclose(there.interpolate(b.positions), found.positions, atol=1e-8)
    first, second = bt.Surface(bt.disk(8)), bt.Surface(bt.disk(7))
    opened = bt.register_open(first, second, [0], [1])
    assert np.allclose(opened.positions[0, :2], second.positions[1])
    assert np.allclose(opened.transfer(np.ones(first.vertex_count)), 1)


def test_pictures() -> None:
    disk = bt.Surface(bt.disk(16))
    z = disk.positions[:, 0] + 1j * disk.positions[:, 1]
    picture = np.zeros((40, 40, 3), np.uint8)
    picture[:, 20:] = 255  # white on the right
    turned = bt.deformed_picture(picture, disk, 1j * z, -1 - 1j, 1 + 1j, width=60)
    assert turned.dtype == np.uint8 and turned.shape[1:] == (60, 4)
    middle = turned.shape[0] // 2
    assert turned[middle - 12, 30, 0] == 255 and turned[middle + 12, 30, 0] == 0 and turned[0, 0, 3] == 0
    domain = bt.image_domain(disk, 2 * z)
    assert abs(domain.area - 4 * np.pi) < 0.01 * 4 * np.pi
    with pytest.raises(TypeError):
        bt.deformed_picture(picture.astype(float), disk, z, -1 - 1j, 1 + 1j)  # type: ignore[arg-type]
    with pytest.raises(bt.BadOption):
        bt.deformed_picture(picture[:, :, :1], disk, z, -1 - 1j, 1 + 1j)


def test_differentials(disk: bt.Surface) -> None:
    result = bt.extremal_map(disk, bt.Constraints(bt.boundary_to_disk(disk)).pin(0, 0.2))
    bounds = bt.reich_strebel(disk, result, result.map)
    assert bounds["valid"] and 1 < bounds["lower"] <= bounds["estimate"] * (1 + 1e-9)
    places, orders, _ = bt.zeros_and_poles(disk, result)
    assert len(places) == len(orders) and -1 in orders
    with pytest.raises(bt.BadOption):
        bt.reich_strebel(disk, np.zeros(3), result.map)


def test_files(disk: bt.Surface, tmp_path: Path) -> None:
    for name in ("a.obj", "a.ply", "a.off"):
        bt.write_mesh(tmp_path / name, disk)
        again = bt.read_mesh(tmp_path / name)
        assert np.array_equal(again.positions[:, :2], disk.positions) and np.array_equal(again.faces, disk.faces)
    with pytest.raises(bt.Unreadable) as caught:
        bt.read_mesh(tmp_path / "none.obj")
    assert isinstance(caught.value, OSError)
    with pytest.raises(bt.Unwritable):
        bt.write_mesh(tmp_path / "no" / "a.obj", disk)
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(bt.BadMesh) as mesh_error:
        bt.read_mesh(tmp_path / "bad.obj")
    assert mesh_error.value.indices == [1]
    domain = bt.TargetDomain(bt.TargetCurve.circle(0, 1), [bt.TargetCurve.polygon([[0, 0], [0.3, 0], [0, 0.3]])])
    bt.write_target_domain(tmp_path / "domain.json", domain)
    again = bt.read_target_domain(tmp_path / "domain.json")
    assert bt.format_target_domain(again) == bt.format_target_domain(domain) and again.area == domain.area
    mesh, curves, _ = bt.target_mesh(domain, edge_length=0.2)
    assert set(curves) == {-1, 0, 1} and mesh.vertex_count == len(curves)
