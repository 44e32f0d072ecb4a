"""Maps: extremal and others, what they say, where they evaluate."""

import json
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import beltrami as bt


def test_the_affine_map_of_a_rectangle() -> None:
    """Grötzsch: the extremal map of rectangles is affine."""
    surface = bt.Surface(bt.rectangle(1, 1, 8, 8))
    result = bt.extremal_map(surface, bt.boundary_to_rectangle(surface, 2, 1, corners=(0, 8, 80, 72)))
    assert abs(result.K - 2) < 1e-6 and result.K_lower_proved <= 2 + 1e-9
    x, y = surface.positions.T
    assert np.allclose(result.map, 2 * x + 1j * y, atol=1e-6)
    assert result.termination == "converged" and result.one_to_one
    assert abs(result.K_max - 2) < 1e-5


def test_results_are_small_objects(cap: bt.Surface) -> None:
    result = bt.extremal_map(cap, bt.boundary_to_disk(cap, 0.5))
    assert repr(result).startswith("<beltrami map: extremal, K 1.") and "\n" not in repr(result)
    assert result.map.shape == (cap.vertex_count,) and result.map.dtype == np.complex128
    assert result.uv.shape == (cap.vertex_count, 2) and np.shares_memory(result.uv, result.map)
    assert not result.map.flags.writeable and not result.uv.flags.writeable
    assert result.phi.shape == result.mu.shape == (cap.sample_count,)
    assert np.allclose(result.mu, bt.beltrami_coefficient(cap, result.map))
    record = json.loads(result.to_json())
    assert record["map"]["K"] == result.K and record["source"]["vertices"] == cap.vertex_count
    assert 1 <= result.K_lower_proved <= result.K_lower <= result.K_max
    assert len(result.history) >= result.iterations and 0 < result.history[-1].k < 1
    assert {bound.kind for bound in result.bounds} and "K" in str(result)


def test_points_and_back(cap: bt.Surface) -> None:
    result = bt.extremal_map(cap, bt.boundary_to_disk(cap, 0.3))
    middles = cap.positions[cap.faces].mean(axis=1)
    images = result(middles)
    assert np.allclose(images, result.map[cap.faces].mean(axis=1))
    assert np.allclose(result.inverse(images), middles, atol=1e-9)
    places = result.preimages(images)
    assert np.array_equal(places.face, np.arange(cap.face_count)) and np.allclose(result(places), images)
    assert np.allclose(places.interpolate(cap.positions), middles)
    assert np.allclose(result.inverse(np.column_stack([images.real, images.imag])), middles)
    with pytest.raises(bt.BadBoundary) as caught:
        result.inverse([0.1, 3 + 4j])
    assert caught.value.indices == [1]
    with pytest.raises(bt.BadOption):
        result(bt.Places([10**6], [[0, 1, 2]], [[1, 0, 0]]))


def test_the_page_and_the_picture(disk: bt.Surface, tmp_path: Path) -> None:
    result = bt.extremal_map(disk, bt.boundary_to_disk(disk, 0.5))
    result.report(tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert page.lstrip().startswith("<!") and "page" in page
    assert result._repr_html_().startswith("<iframe srcdoc=")
    result.save(tmp_path / "out.obj")
    assert np.array_equal(bt.texture_map(bt.read_mesh(tmp_path / "out.obj")), result.map)
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = result.plot()
    axes.figure.savefig(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 5000
    with pytest.raises(bt.Unwritable):
        result.report(tmp_path / "nowhere" / "page.html")


def test_pins_lines_and_slack(disk: bt.Surface) -> None:
    boundary = bt.boundary_to_disk(disk)
    pinned = bt.extremal_map(disk, bt.Constraints(boundary).pin(0, 0.2 + 0.1j))
    assert pinned.map[0] == 0.2 + 0.1j and pinned.K > 1.2
    line = bt.extremal_map(disk, bt.Constraints(boundary).line(0, 0.3, 1j), tolerance=1e-5)
    assert abs(line.map[0].real - 0.3) < 1e-9
    assert 1 < line.K < pinned.K * 2
    noisy = bt.boundary_to_disk(disk, 0.5)
    assert bt.extremal_map(disk, noisy, slack=1).K < bt.extremal_map(disk, noisy).K


def test_holes_and_classes(ring: bt.Surface) -> None:
    boundary = bt.boundary_to_disk(ring) + bt.hole_to_circle(ring, 1, 0, 0.4)
    none = bt.extremal_map(ring, boundary)
    once = bt.extremal_map(ring, bt.Constraints(boundary, turns=[0, 1]))
    assert abs(none.K - 1) < 1e-3 and none.turns == {1: 0} and once.turns == {1: 1}
    # The shear of a full turn in log z: √K − 1/√K = 2π/log(1/0.4).
    s = 2 * np.pi / np.log(1 / 0.4)
    K = ((s + np.hypot(s, 2)) / 2) ** 2
    assert 10 < once.K and once.K_lower_proved < K < once.K_max


def test_boundaries_slide(ring: bt.Surface) -> None:
    domain = bt.TargetDomain(bt.TargetCurve.circle(0, 1), [bt.TargetCurve.circle(0, 0.3)])
    result = bt.extremal_map(ring, domain)
    assert result.K == pytest.approx(np.log(0.3) / np.log(0.4), rel=1e-3)
    assert np.allclose(np.abs(result.map[ring.boundary_loops[0]]), 1)
    other = bt.Surface(bt.annulus(0.3, 1.0, 40))
    onto = bt.extremal_map(ring, other)
    assert onto.K == pytest.approx(result.K, rel=1e-2) and onto.places is not None
    assert onto.positions.shape == (ring.vertex_count, 2)
    marked = bt.Constraints(target=domain, marks=[(int(ring.boundary_loops[0][0]), 0, 0.0)])
    assert bt.extremal_map(ring, marked).K >= 1


def test_baselines_and_measure(cap: bt.Surface) -> None:
    boundary = bt.boundary_to_disk(cap, 0.5)
    extremal = bt.extremal_map(cap, boundary)
    for method in ("harmonic", "tutte", "mean_value", "arap", "mips", "alternation", "qc_iteration"):
        other = getattr(bt, f"{method}_baseline")(cap, boundary)
        assert other.map.shape == (cap.vertex_count,) and other.method == method
        assert other.K_max >= extremal.K * (1 - 1e-6)
    free = bt.lscm_baseline(cap)
    measured = bt.measure(cap, free.map)
    assert measured.mean == free.distortion.mean < 0.1
    assert np.array_equal(bt.distortion(cap, free.uv).face_abs_mu, measured.face_abs_mu)
    assert bt.distortion(cap, cap.positions).max < 1e-12
    mine = bt.PlanarMap(cap, 2 * free.map)
    assert mine.distortion.mean == pytest.approx(measured.mean) and json.loads(mine.to_json())["command"] == "measure"
    with pytest.raises(bt.BadOption):
        bt.measure(cap, free.map[:-1])


def test_a_given_coefficient(disk: bt.Surface) -> None:
    z = disk.positions[:, 0] + 1j * disk.positions[:, 1]
    wanted = z + 0.3 * z.conj()
    rim = disk.boundary_loops[0]
    boundary = bt.BoundaryCondition(rim, wanted[rim])
    assert np.allclose(bt.quasiconformal_map(disk, np.full(disk.face_count, 0.3), boundary), wanted)
    with pytest.raises(bt.BadOption) as caught:
        mu = np.full(disk.face_count, 0.3)
        mu[7] = 1.5
        bt.quasiconformal_map(disk, mu, boundary)
    assert caught.value.indices == [7]


def test_a_certificate() -> None:
    surface = bt.Surface(bt.rectangle(1, 1, 6, 6))
    boundary = bt.boundary_to_rectangle(surface, 1.5, 1, corners=(0, 6, 48, 42))
    proof = bt.certify(surface, boundary, 0.01)
    assert proof.reached and proof.K_lower <= 1.5 * (1 + 1e-9) and proof.K_upper >= 1.5 * (1 - 1e-9)
    assert proof.gap <= 0.01 and proof.result.K == pytest.approx(1.5, rel=1e-2)
    bounds = bt.bounds_of_map(surface, bt.harmonic_baseline(surface, boundary).map)
    assert any(bound.rigorous for bound in bounds)


def test_a_dragged_handle(disk: bt.Surface) -> None:
    constraints = bt.Constraints(bt.boundary_to_disk(disk)).pin(0, 0.0)
    solver = bt.ExtremalSolver(disk, constraints)
    images = constraints.prescribed.images.copy()
    assert list(solver.vertices) == list(constraints.prescribed.vertices)
    for x in (0.05, 0.1, 0.15):
        images[-1] = x
        map, k, _, flipped = solver.update(images)
        assert map[0] == x and k > 0 and flipped == 0
    last = solver.solve()
    assert last.K == pytest.approx(bt.extremal_map(disk, bt.Constraints(bt.boundary_to_disk(disk)).pin(0, 0.15)).K, rel=1e-3)
    with pytest.raises(bt.BadBoundary):
        images[-1] = 5
        solver.update(images)


def test_onto_a_surface_with_pairs(cap: bt.Surface, disk: bt.Surface) -> None:
    pairs = [(int(cap.boundary_loops[0][i]), int(disk.boundary_loops[0][i])) for i in (0, 15, 30)]
    result = bt.extremal_map_between(cap, disk, pairs)
    assert result.positions.shape[0] == cap.vertex_count and len(result.places) == cap.vertex_count
    assert result.partner == [0] and result.plane.one_to_one


def test_free_parts(disk: bt.Surface) -> None:
    rim = disk.boundary_loops[0]
    boundary = bt.BoundaryCondition(rim[:20], np.exp(2j * np.pi * np.arange(20) / len(rim)) * [1.2 if i == 7 else 1 for i in range(20)])
    result = bt.least_dilatation_map(disk, boundary, power=4)
    assert isinstance(result, bt.LeastMaximumMap) and result.fold_free


def test_progress_and_stopping(cap: bt.Surface) -> None:
    calls: list = []
    bt.extremal_map(cap, bt.boundary_to_disk(cap, 0.5), progress=lambda i, k: calls.append((i, k)))
    assert len(calls) > 1 and calls[0][0] == 1
    with pytest.raises(bt.Cancelled):
        bt.extremal_map(cap, bt.boundary_to_disk(cap, 0.5), progress=lambda i, k: False)
    with pytest.raises(ZeroDivisionError):
        bt.extremal_map(cap, bt.boundary_to_disk(cap, 0.5), progress=lambda i, k: 1 / 0)
    with pytest.raises(TypeError):
        bt.extremal_map(cap, bt.boundary_to_disk(cap, 0.5), progress=3)


@pytest.mark.parametrize("after", [0.05, 0.4])
def test_ctrl_c_stops_a_solve(after: float) -> None:
    """Within the time of two harmonic maps, wherever the solve is."""
    surface = bt.Surface(bt.disk(90, jitter=0.3))
    boundary = bt.boundary_to_disk(surface, 0.9)
    start = time.perf_counter()
    bt.harmonic_baseline(surface, boundary)
    harmonic = time.perf_counter() - start
    sent: list = []

    def interrupt() -> None:
        sent.append(time.perf_counter())
        signal.raise_signal(signal.SIGINT)

    timer = threading.Timer(after, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            bt.extremal_map(surface, boundary)
    assert time.perf_counter() - sent[0] < 2 * harmonic + 0.1
    timer.join()
    assert bt.harmonic_baseline(surface, boundary).map.shape  # and the library works on


def test_threads_do_not_wait_for_each_other(cap: bt.Surface) -> None:
    boundary = bt.boundary_to_disk(cap, 0.5)
    wanted = bt.extremal_map(cap, boundary).map
    results: list = []
    threads = [threading.Thread(target=lambda: results.append(bt.extremal_map(cap, boundary).map)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4 and all(np.array_equal(result, wanted) for result in results)


def test_the_command_finds_the_same_map(cap: bt.Surface, command: str, tmp_path: Path) -> None:
    import subprocess

    bt.write_mesh(tmp_path / "cap.obj", cap)
    arguments = ["map", "cap.obj", "-o", "out.obj", "--boundary", "disk:0.5", "--quiet"]
    subprocess.run([command, *arguments], cwd=tmp_path, check=True)
    theirs = bt.texture_map(bt.read_mesh(tmp_path / "out.obj"))
    assert np.array_equal(theirs, bt.extremal_map(cap, bt.boundary_to_disk(cap, 0.5)).map)


def test_options_have_names(disk: bt.Surface) -> None:
    boundary = bt.boundary_to_disk(disk)
    with pytest.raises(TypeError, match="slck"):
        bt.extremal_map(disk, boundary, slck=1)
    with pytest.raises(TypeError, match="max_iterations"):
        bt.extremal_map(disk, boundary, max_iterations="many")
    with pytest.raises(bt.BadOption, match="evening"):
        bt.extremal_map(disk, boundary, evening="morning")
    with pytest.raises(bt.BadOption):
        bt.extremal_map(disk, boundary, max_iterations=-1)
    with pytest.raises(TypeError, match="constraints"):
        bt.extremal_map(disk, "disk")
    with pytest.raises(bt.BadOption):
        bt.boundary_to_disk(disk, loop=1)


@pytest.mark.parametrize("vertex", [1000, -1])
def test_vertices_out_of_range(vertex: int) -> None:
    surface = bt.Surface(bt.disk(3))
    boundary = bt.BoundaryCondition()
    boundary.pin(vertex, 0.5)
    with pytest.raises(bt.BadBoundary, match=f"vertex {vertex} is pinned"):
        bt.unprescribed_boundary(surface, boundary)
