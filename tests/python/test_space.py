"""Maps into space: along targets, remeshed, deformed, least-squares ones; what these results share."""

import json
from pathlib import Path
from typing import Any, Tuple

import numpy as np
import pytest

import beltrami as bt


@pytest.fixture
def potato() -> bt.Surface:
    mesh = bt.icosahedral_sphere(3)
    return bt.Surface(mesh.positions * [1, 0.8, 1.2], mesh.faces)


def test_the_identity_of_a_sphere_has_its_coefficient(potato: bt.Surface) -> None:
    sphere = bt.sphere_map(potato)
    held = [0, 40, 90]
    flow = bt.surface_flow(potato, bt.SphereTarget(), sphere.mu, bt.TargetConstraints(held), sphere.positions)
    assert flow.fits and flow.l2 < 1e-6 and flow.no_flips
    assert np.allclose(flow.positions, sphere.positions, atol=1e-6)
    assert np.allclose(np.linalg.norm(flow.positions, axis=1), 1) and np.allclose(flow.target_map.normals, flow.positions)
    with pytest.raises(bt.BadOption) as caught:
        bt.surface_flow(potato, bt.SphereTarget(), np.full(potato.sample_count, 2.0))
    assert caught.value.indices
    with pytest.raises(bt.Cancelled):
        bt.surface_flow(potato, bt.SphereTarget(), 0.3 + sphere.mu * 0, start=sphere.positions, progress=lambda i, e: False)
    with pytest.raises(bt.BadOption):
        bt.surface_flow(potato, bt.SphereTarget(), sphere.mu, start=bt.target_map(bt.Surface(bt.icosahedral_sphere(1)), bt.SphereTarget()))


def test_flat_areas_make_the_least_map_of_a_torus_extremal() -> None:
    """Wong & Zhao 2014, section 5.4: with |φ| as weights p = 2 is the extremal map, whose |μ| is constant."""
    source = bt.Surface(bt.torus(2, 1, 40, 20))
    target = bt.torus_target(2, 0.7)
    flat = bt.flat_torus(source)
    constraints = bt.TargetConstraints([0])
    around = bt.Surface(bt.torus(2, 0.7, 40, 20))
    start = bt.target_map(source, target, constraints, around.positions)
    found = bt.least_lp_map(source, target, 2, bt.flat_areas(flat), constraints, start)
    K = bt.torus_map(flat, bt.flat_torus(around)).K
    assert (1 + found.distortion.mean) / (1 - found.distortion.mean) == pytest.approx(K, rel=0.02)
    assert found.distortion.standard_deviation < 0.02 and len(found.energies) == found.iterations
    assert found.target_map.uv.shape == (source.vertex_count, 2)
    with pytest.raises(bt.BadOption):
        bt.least_lp_map(source, target, 1.5, start=around.positions)


def test_targets_of_ones_own() -> None:
    """A unit sphere as a function and as a surface with parameters, in Python."""
    points = np.array([[1.2, 0, 0], [0, 0.5, 0], [0.3, 0.4, -0.6]])
    wanted = points / np.linalg.norm(points, axis=1)[:, None]

    def value(p: Tuple[float, float, float]) -> Any:
        x = np.array(p)
        return x @ x - 1, 2 * x

    implicit = bt.ImplicitTarget(value)
    found = implicit.nearest(points)
    assert np.allclose(found.positions, wanted) and np.allclose(found.normals, wanted)

    def place(u: float, v: float) -> Any:
        c, s, C, S = np.cos(u), np.sin(u), np.cos(v), np.sin(v)
        return (c * C, s * C, S), (-s * C, c * C, 0), (-c * S, -s * S, C)

    belt = bt.ParametricTarget(place, (0, 2 * np.pi, True), (-1.2, 1.2, False))
    assert np.allclose(belt.nearest(points).positions, wanted, atol=1e-6)
    assert np.allclose(bt.nearest_points(bt.ellipsoid_target((1, 1, 1)), points).positions, wanted)
    with pytest.raises(ZeroDivisionError):
        bt.ImplicitTarget(lambda p: 1 / 0).nearest(points)
    with pytest.raises(TypeError, match="gradient"):
        bt.ImplicitTarget(lambda p: 1).nearest(points)
    with pytest.raises(bt.BadOption):
        bt.ParametricTarget(place, (0, 0, True), (0, 1, False))
    with pytest.raises(bt.BadOption):
        bt.torus_target(1, 2)


def test_curves_bound_targets(cap: bt.Surface) -> None:
    target = bt.MeshTarget(cap)
    (border,) = target.boundary
    constraints = bt.slide_boundary(bt.TargetConstraints(), cap, target)
    assert sorted(constraints.sliding) == sorted(cap.boundary_loops[0])
    moved = bt.target_map(cap, target, constraints)
    assert np.allclose(moved.positions, cap.positions, atol=1e-9) and len(moved.parameters) == len(constraints.sliding)
    again = target.at(moved.places)
    assert np.allclose(again.positions, cap.positions, atol=1e-9)
    s = border.nearest(cap.positions[cap.boundary_loops[0]])
    assert np.allclose(border.point(s), cap.positions[cap.boundary_loops[0]], atol=1e-9) and border.closed
    cylinder = bt.cylinder_target(1, 2)
    lower, upper = cylinder.boundary
    assert lower.length == pytest.approx(2 * np.pi) == upper.length
    circle = bt.LevelCircle(2, 1)
    assert np.allclose(circle.point([0, np.pi]), [[2, 0, 1], [0, 2, 1]]) and np.allclose(circle.tangent([0]), [[0, 1, 0]])
    corner = bt.PolylineCurve([[0, 0, 0], [1, 0, 0], [1, 1, 0]], closed=False)
    assert corner.length == 2 and corner.nearest([[1, 0.5, 3]])[0] == 1.5
    with pytest.raises(bt.BadOption):
        bt.PolylineCurve([[0, 0, 0], [0, 0, 0]], closed=False)
    with pytest.raises(bt.BadBoundary):
        bt.slide_boundary(bt.TargetConstraints(), cap, bt.SphereTarget())
    assert bt.DomainTarget(bt.TargetDomain(bt.TargetCurve.circle(0, 1))).boundary[0].length == pytest.approx(2 * np.pi)


def test_remeshing_makes_faces_better(potato: bt.Surface) -> None:
    random = np.random.default_rng(1)
    sheared = bt.Surface(bt.Mesh(potato.positions * [1, 1, 1.5] + random.normal(scale=0.02, size=potato.positions.shape), potato.faces))
    calls: list = []
    found = bt.remesh(sheared, power=2, progress=lambda i, value: calls.append(i))
    before = bt.measure(bt.Surface(sheared.positions, sheared.faces), sheared.positions)
    assert before.mean < 1e-12  # of its own metric
    reference = bt.regular_shapes(sheared)
    old = bt.Surface(sheared.mesh, metric=reference)
    assert found.distortion.mean < bt.measure(old, sheared.positions).mean and len(found.unresolved) == 0
    assert bt.angle_statistics(found.mesh).median_deviation < bt.angle_statistics(sheared).median_deviation
    assert len(calls) > 1 and found.distance <= 0.003 * 1.4 and found.steps > 0
    largest, mean = bt.surface_distance(sheared, found.mesh)
    assert 0 < mean < largest < 0.05
    assert np.allclose(found.places.interpolate(sheared.positions), found.positions, atol=1e-9)
    assert np.allclose(bt.carried_values(sheared, sheared.positions, found.places), found.positions, atol=1e-9)
    assert bt.surface_area(found.mesh) == pytest.approx(sheared.area, rel=0.05) and len(bt.opposed_faces(found.mesh, sheared)) == 0
    record = json.loads(found.to_json())
    assert record["command"] == "remesh" and record["remesh"]
    with pytest.raises(bt.Cancelled):
        bt.remesh(sheared, progress=lambda i, value: False)
    with pytest.raises(bt.BadOption):
        bt.remesh(sheared, np.zeros((3, 2)))


def test_shapes_features_and_seams(cap: bt.Surface) -> None:
    assert bt.valence_floor(6) == pytest.approx(0, abs=1e-12) and bt.valence_floor(5) > 0
    angles = np.tile([np.pi / 2, np.pi / 4, np.pi / 4], cap.face_count)
    shapes = bt.shapes_from_angles(cap, angles).reshape(-1, 3, 2)
    a, b = shapes[:, 1] - shapes[:, 0], shapes[:, 2] - shapes[:, 0]
    assert np.allclose((a * b).sum(axis=1), 0, atol=1e-12)
    assert bt.valence_shapes(cap).shape == (3 * cap.face_count, 2)
    with pytest.raises(bt.BadOption) as caught:
        bt.shapes_from_angles(cap, np.full(3 * cap.face_count, 0.1))
    assert caught.value.indices
    curves, corners = bt.feature_curves(cap)
    assert len(curves) == 1 and curves[0][1] and sorted(curves[0][0]) == sorted(cap.boundary_loops[0])
    box = bt.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
                  [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
    curves, corners = bt.feature_curves(bt.Surface(box), angle=0.5)
    assert len(curves) == 12 and len(corners) == 8
    net = bt.Mesh(box.positions, box.faces, texture=(np.arange(48).reshape(24, 2), np.arange(24)))
    assert len(bt.seam_edges(net)) == 12 and len(bt.texture_charts(net)) == 6
    assert bt.cut_along_seams(net).vertex_count == 24
    points, at = bt.carried_texture(net, bt.places_of_vertices(net))
    assert np.allclose(points[at], net.texture[0])
    with pytest.raises(bt.BadMesh):
        bt.texture_charts(box)


def test_handles_deform_a_surface(cap: bt.Surface) -> None:
    handles = [0, *map(int, cap.boundary_loops[0][::6])]
    solver = bt.DeformSolver(cap, handles)
    places = cap.positions[handles].copy()
    still = solver.solve(places)
    assert np.allclose(still.positions[handles], places, atol=1e-9) and still.distortion.mean < 0.05
    places[0] += [0, 0, 0.2]
    moved = solver.solve(places)
    assert np.allclose(moved.positions[0], places[0]) and moved.no_flips and len(moved.folds) == 0
    assert moved.kind in ("thin_plate", "thin-plate", "rigid", "uniform") and json.loads(moved.to_json())["deform"]
    assert moved.places.interpolate(moved.surface.positions) == pytest.approx(moved.positions, abs=1e-9)
    onto = bt.DeformSolver(cap, handles, last_power=4).solve_onto(cap, cap.positions[handles])
    assert onto.kind == "given"
    with pytest.raises(bt.BadOption):
        bt.DeformSolver(cap, [10**6])
    with pytest.raises(bt.BadOption):
        solver.solve(places[:-1])
    with pytest.raises(bt.BadBoundary):
        bt.DeformSolver(cap, [])


def test_least_squares_maps_into_space(cap: bt.Surface) -> None:
    rim = cap.boundary_loops[0]
    problem = bt.LeastSquaresMap(cap, rim, cap.positions[rim])
    assert np.allclose(problem.solve(), cap.positions, atol=1e-8)
    # A scale and a translation are conformal; the energy of the identity is 0.
    turned = 2 * cap.positions + [3, -1, 2]
    assert np.allclose(bt.LeastSquaresMap(cap, rim, turned[rim]).solve(), turned, atol=1e-8)
    assert problem.energy(cap.positions) == pytest.approx(0, abs=1e-9) and np.allclose(problem.gradient(cap.positions), 0, atol=1e-9)
    mu = np.full(cap.face_count, 0.2)
    bent = problem.solve(mu)
    assert problem.energy(bent, mu) <= problem.energy(cap.positions, mu)
    assert 0 <= problem.best_step(np.zeros(cap.face_count), mu, bent) <= 1
    elements = problem.elements
    assert np.allclose(bt.face_means(elements, bt.face_values_at_samples(elements, mu)), mu)
    assert bt.corner_normals(cap).shape == (elements.sample_count, 3)
    even = bt.uniform_map(problem, max_iterations=5)
    assert even.first == pytest.approx(cap.positions, abs=1e-8) and even.wanted.shape == (cap.face_count,)
    smooth = bt.smoothed_over_edges(bt.corner_elements(cap), cap, 0.1 * np.exp(1j * np.arange(cap.face_count)))
    assert np.allclose(np.abs(smooth), 0.1)
    with pytest.raises(bt.BadBoundary):
        bt.LeastSquaresMap(cap)
    with pytest.raises(bt.BadOption) as caught:
        problem.solve(np.where(np.arange(cap.face_count) == 3, 1.5, 0))
    assert caught.value.indices == [3]


def test_results_in_space_have_pages_and_pictures(potato: bt.Surface, tmp_path: Path) -> None:
    result = bt.sphere_map(potato)
    assert repr(result).startswith("<beltrami map in space: sphere, K_max 1.") and "\n" not in repr(result)
    result.report(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8").lstrip().startswith("<!")
    assert result._repr_html_().startswith("<iframe srcdoc=") and "K_max" in str(result)
    assert json.loads(result.to_json())["sphere"]
    result.save(tmp_path / "sphere.ply")
    assert np.array_equal(bt.read_mesh(tmp_path / "sphere.ply").positions, result.positions)
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    result.plot().figure.savefig(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 5000
    assert not result.positions.flags.writeable
