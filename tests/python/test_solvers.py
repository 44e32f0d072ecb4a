"""Linear solves, evening out, bounds and brackets."""

import json

import numpy as np
import pytest

import beltrami as bt


def test_a_linear_solver_is_kept(disk: bt.Surface) -> None:
    z = disk.positions[:, 0] + 1j * disk.positions[:, 1]
    rim = disk.boundary_loops[0]
    solver = bt.BeltramiSolver(disk, bt.BoundaryCondition(rim, z[rim]), expected_factorizations=3)
    with pytest.raises(bt.BadOption, match="factorize"):
        solver.solve(z)
    assert solver.decoupled and solver.freedoms[rim].tolist() == [2] * len(rim)
    for k in (0.0, 0.3, 0.2j):
        wanted = z + k * z.conj()
        solver.factorize(np.full(disk.face_count, k))
        assert np.allclose(solver.solve(wanted), wanted)
        assert np.allclose(solver.gradient(wanted)[solver.freedoms == 0], 0, atol=1e-12)
    assert solver.factorization_count == 3
    near = z + 0.21j * z.conj()
    assert np.allclose(solver.solve_near(np.full(disk.face_count, 0.21j), near, z + 0.2j * z.conj()), near, atol=1e-9)
    solver.factorize(np.zeros(disk.face_count))
    # −Δu = 1 on the disk: u = (1 − r²)/4.
    hats = np.zeros(disk.vertex_count)
    np.add.at(hats, disk.faces, (np.asarray(disk.weights) / 3)[:, None])
    u = solver.solve_poisson(hats)
    assert np.abs(u - (1 - np.abs(z) ** 2) / 4).max() < 0.01
    offsets = np.column_stack([np.full(disk.sample_count, 0.1), np.zeros(disk.sample_count)])
    assert np.allclose(solver.solve_offsets(offsets)[:, 1], 0)
    assert np.allclose(solver.solve(np.zeros(disk.vertex_count), offsets[:, 0]), solver.solve_offsets(offsets)[:, 0])
    with pytest.raises(bt.BadOption):
        solver.factorize(np.full(disk.face_count, 1.1))
    with pytest.raises(bt.BadOption):
        bt.BeltramiSolver(disk, np.full(disk.vertex_count, 3))
    with pytest.raises(bt.BadOption):
        solver.solve_poisson(hats[:-1])


def test_conditions(disk: bt.Surface) -> None:
    boundary = bt.boundary_to_disk(disk) + bt.BoundaryCondition().pin_to_line(0, 0.1, 1j)
    assert bt.freedoms(boundary, disk)[0] == 1 and bt.prescribed_values(boundary, disk)[0] == 0.1
    assert bt.line_directions(boundary, disk)[0] == 1j
    bt.require_whole_boundary(boundary, disk)
    part = bt.BoundaryCondition(disk.boundary_loops[0][:3], [0, 1, 1j])
    with pytest.raises(bt.BadBoundary):
        bt.require_whole_boundary(part, disk)
    assert len(bt.free_parts(disk, part)) == len(disk.boundary_loops[0]) - 3
    assert bt.takes_least_maximum(disk, part) and not bt.takes_least_maximum(disk, bt.boundary_to_disk(disk))
    with pytest.raises(bt.BadOption) as caught:
        bt.require_coefficient(disk, np.where(np.arange(disk.face_count) == 5, 2, 0))
    assert caught.value.indices == [5]


def test_harmonic_and_conformal_maps(cap: bt.Surface) -> None:
    boundary = bt.boundary_to_disk(cap)
    assert np.array_equal(bt.harmonic_map(cap, boundary), bt.harmonic_baseline(cap, boundary).map)
    pins = bt.BoundaryCondition(cap.boundary_loops[0][[0, 30]], [0, 1])
    assert np.allclose(bt.least_squares_conformal_map(cap, pins), bt.lscm_baseline(cap, pins).map, atol=1e-9)
    with pytest.raises(bt.BadBoundary):
        bt.harmonic_map(cap, pins)


def test_evening_out(disk: bt.Surface) -> None:
    boundary = bt.Constraints(bt.boundary_to_disk(disk)).pin(0, 0.2)
    rough = bt.extremal_map(disk, boundary, evening="never")
    surface = rough.surface
    condition = bt.BoundaryCondition(
        [*surface.boundary_loops[0], 0], [*rough.map[surface.boundary_loops[0]], rough.map[0]]
    )
    updates: list = []

    def same(map: np.ndarray) -> None:  # type: ignore[type-arg]
        updates.append(map.shape)

    even = bt.even_dilatation(surface, condition, rough.map, rough.k, rough.phi, same)
    assert even.improved and even.distortion.standard_deviation < rough.distortion.standard_deviation and even.energy < even.start_energy
    assert updates and updates[0] == rough.map.shape and even.flipped <= even.start_flipped
    with pytest.raises(ZeroDivisionError):
        bt.even_dilatation(surface, condition, rough.map, rough.k, rough.phi, lambda map: 1 / 0)
    with pytest.raises(bt.BadOption):
        bt.even_dilatation(surface, condition, rough.map, 1.0, rough.phi)


def test_bounds_are_below_what_is_known() -> None:
    surface = bt.Surface(bt.rectangle(1, 1, 6, 6))
    boundary = bt.boundary_to_rectangle(surface, 1.5, 1, corners=(0, 6, 48, 42))
    map = bt.harmonic_map(surface, boundary)
    bounds = bt.proved_bounds(surface, boundary, map, exact_polygons=True)
    assert bounds and all(bound.rigorous and bound.K <= 1.5 + 1e-9 for bound in bounds)
    assert max(bound.K for bound in bounds) == pytest.approx(1.5, rel=1e-2)
    bracket = bt.verified_bracket(surface, boundary, map, gap=0.01)
    assert bracket.reached and bracket.K_lower <= 1.5 + 1e-9 <= bracket.K_upper + 2e-9 and bracket.K_upper <= 1.01 * bracket.K_lower
    assert json.loads(bracket.to_json())["reached"] is True and len(bracket.map) >= bracket.surface.vertex_count
    loop = list(surface.boundary_loops[0])
    corners = sorted(loop.index(v) for v in (0, 6, 48, 42))
    assert bt.quadrilateral_bound(surface, map, corners) == pytest.approx(1.5, rel=1e-6)
    assert bt.mesh_harmonic_bound(surface, map) == pytest.approx(1.5, rel=1e-6)
    with pytest.raises(bt.BadBoundary):
        bt.proved_bounds(surface, boundary, 2 * map)
    with pytest.raises(bt.BadOption):
        bt.quadrilateral_bound(surface, map, (3, 2, 1, 0))


def test_differentials_of_ones_own(disk: bt.Surface) -> None:
    z = disk.positions[:, 0] + 1j * disk.positions[:, 1]
    one = bt.differential_of(disk, lambda z: 1)
    assert not one.zero and not one.tabulated and np.allclose(one.at_samples(), 1)
    affine = z + 0.2 * z.conj()
    found = bt.reich_strebel(disk, one, affine)
    assert found["proves"] and found["lower"] == pytest.approx(1.5) == found["estimate"]
    assert bt.reich_strebel(disk, lambda z: 1, affine)["lower"] == pytest.approx(1.5)
    table = bt.differential_of(disk, np.ones(disk.sample_count))
    assert table.tabulated and not bt.reich_strebel(disk, table, affine)["proves"]
    result = bt.extremal_map(disk, bt.Constraints(bt.boundary_to_disk(disk)).pin(0, 0.2))
    phi = bt.QuadraticDifferential(result)
    places = bt.Places([3, 5], disk.faces[[3, 5]], [[1 / 3] * 3] * 2)
    assert list(bt.nearest_samples(disk, places)) == [3, 5] and phi.at(places).shape == (2,) and 0 in phi.poles
    assert bt.averaged_estimate(disk, result.phi, result.map) > 1
    assert bt.reich_strebel_of(1, 1, 0)["estimate"] == 1
    with pytest.raises(ZeroDivisionError):
        bt.reich_strebel(disk, lambda z: 1 / 0, affine)
    with pytest.raises(bt.BadMesh):
        x, y = disk.positions.T
        bt.differential_of(bt.Surface(np.column_stack([x, y, x * y]), disk.faces), lambda z: 1)


def test_the_least_maximum(disk: bt.Surface) -> None:
    boundary = bt.boundary_to_disk(disk, 0.5)
    extremal = bt.extremal_map(disk, boundary)
    least = bt.least_maximum_map(disk, boundary, power=16)
    assert least.distortion.max <= extremal.distortion.max and least.fold_free


def test_work_is_counted(disk: bt.Surface) -> None:
    before = bt.effort()
    bt.harmonic_map(disk, bt.boundary_to_disk(disk))
    assert bt.effort()["factorization"] == before["factorization"] + 1
