"""Long computations of all kinds on small or large surfaces, to interrupt them."""

import signal
import time
from typing import Any, Callable, Dict, List

import numpy as np

import beltrami as bt

Solve = Callable[..., Any]


def heard_after(solve: Callable[[], Any], moment: float) -> float:
    """Seconds of the processor from a signal, so many after the beginning, until it ends a solve; NaN where that had ended."""
    before = signal.signal(signal.SIGPROF, signal.default_int_handler)
    start = time.process_time()
    try:
        signal.setitimer(signal.ITIMER_PROF, max(moment, 1e-3))
        solve()
        signal.setitimer(signal.ITIMER_PROF, 0)
        return float("nan")
    except KeyboardInterrupt:
        return time.process_time() - start - moment
    finally:
        signal.signal(signal.SIGPROF, before)


def processor_seconds(solve: Callable[[], Any]) -> float:
    start = time.process_time()
    solve()
    return time.process_time() - start


def harmonic_seconds(size: int) -> List[float]:
    """Of harmonic maps of such a surface, the least first."""
    surface = bent(size)
    boundary = bt.boundary_to_disk(surface)
    return sorted(processor_seconds(lambda: bt.harmonic_baseline(bt.Surface(surface.positions, surface.faces), boundary)) for _ in range(5))


def bent(rings: int) -> bt.Surface:
    mesh = bt.disk(rings, jitter=0.3)
    x, y = mesh.positions.T
    return bt.Surface(np.column_stack([x, y, 0.5 * x * x - 0.3 * x * y]), mesh.faces)


def with_progress(size: int) -> Dict[str, Solve]:
    """Solves that take progress=, of surfaces with about 6 size² faces."""
    return {**_planar(size), **_in_space(size), **_of_closed_surfaces(size)}


def _planar(size: int) -> Dict[str, Solve]:
    disk = bent(size)
    boundary = bt.boundary_to_disk(disk, 0.9)
    domain = bt.TargetDomain(bt.TargetCurve.polygon([0, 2, 2 + 1j, 1j]))
    corners = [int(v) for v in disk.boundary_loops[0][:: len(disk.boundary_loops[0]) // 5][:5]]
    marked = bt.Constraints(target=domain, marks=[(v, 0, s) for v, s in zip(corners, (0.0, 1.5, 2.5, 3.5, 5.0))])
    ring = bt.Surface(bt.annulus(0.3, 1, max(12, 6 * size)))
    turned = bt.Constraints(bt.boundary_to_disk(ring) + bt.hole_to_circle(ring, 1, 0, 0.4), turns=[0, 1])
    flat = bt.Surface(disk.positions[:, :2], disk.faces)
    start, rim = bt.harmonic_baseline(disk, boundary).map, disk.boundary_loops[0]
    return {
        "map": lambda **given: bt.extremal_map(disk, boundary, **given),
        "turns": lambda **given: bt.extremal_map(ring, turned, **given),
        "onto": lambda **given: bt.extremal_map(disk, marked, **given),
        "between": lambda **given: bt.extremal_map_between(flat, disk, np.column_stack([rim, rim]), **given),
        "certify": lambda **given: bt.certify(disk, boundary, most_refinements=1, most_proof_triangles=4000, **given),
        "least_maximum": lambda **given: bt.least_maximum_map(disk, boundary, **given),
        "fold_free": lambda **given: bt.fold_free_map(disk, start, rim, **given),
        "beltrami_flow": lambda **given: bt.beltrami_flow(disk, bt.TargetDomain(bt.TargetCurve.circle(0, 1)), np.full(disk.face_count, 0.3), **given),
        "mips": lambda **given: bt.mips_baseline(disk, boundary, **given),
        "arap": lambda **given: bt.arap_baseline(disk, boundary, **given),
        "qc_iteration": lambda **given: bt.qc_iteration_baseline(disk, boundary, max_iterations=60, **given),
        "alternation": lambda **given: bt.alternation_baseline(disk, boundary, max_iterations=60, **given),
        "t_map_scheme": lambda **given: bt.t_map_scheme(disk, domain, max_solves=40, **given),
    }


def _ball(size: int) -> bt.Mesh:
    return bt.icosahedral_sphere(max(2, round(np.log2(6 * size * size / 20) / 2)))


def _double_torus(size: int) -> bt.Mesh:
    mesh = bt.double_torus()
    for _ in range(max(0, round(np.log2(6 * size * size / mesh.face_count) / 2))):
        mesh = bt.midpoint_subdivide(mesh)[0]
    return mesh


def _in_space(size: int) -> Dict[str, Solve]:
    disk, ball = bent(size), _ball(size)
    other = bt.Surface(disk.positions * [1, 1.2, 1], disk.faces)
    potato = bt.Surface(ball.positions * [1, 0.8, 1.2], ball.faces)
    random = np.random.default_rng(0)
    rough = bt.Surface(bt.Mesh(potato.positions * [1, 1, 2] + random.normal(scale=0.1 / size, size=ball.positions.shape), ball.faces))
    rim = disk.boundary_loops[0]
    handles = [0, *map(int, rim[:: max(1, len(rim) // 12)])]
    places = disk.positions[handles].copy()
    places[0] += [0, 0, 0.3]
    sphere = bt.sphere_map(potato)
    inner = [int(np.argmin(np.abs(disk.positions[:, :2] - at).sum(axis=1))) for at in ([-0.5, 0], [0.5, 0], [0, 0.5], [0.1, -0.4])]
    return {
        "flow": lambda **given: bt.surface_flow(potato, bt.SphereTarget(), 0.3 + 0 * sphere.mu, start=sphere.positions, **given),
        "least_lp": lambda **given: bt.least_lp_map(potato, bt.SphereTarget(), 2, start=sphere.positions, **given),
        "remesh": lambda **given: bt.remesh(rough, **given),
        "deform": lambda **given: bt.DeformSolver(disk, handles, **given).solve(places),
        "register_open": lambda **given: bt.register_open(disk, other, inner, inner, **given),
        "register_curves": lambda **given: bt.register_least_lp(disk, other, curves=[(inner[:2], inner[:2])], **given),
    }


def _of_closed_surfaces(size: int) -> Dict[str, Solve]:
    ball = _ball(size)
    potato = bt.Surface(ball.positions * [1, 0.8, 1.2], ball.faces)
    pear = bt.Surface(ball.positions * [1.2, 1, 0.8], ball.faces)
    landmarks = list(range(0, 12, 2))
    double = _double_torus(size)
    wide = bt.Surface(double.positions * [1.3, 1, 1], double.faces)
    double_surface = bt.Surface(double)
    return {
        "register": lambda **given: bt.register_spheres(potato, pear, landmarks, landmarks, **given),
        "register_handles": lambda **given: bt.register_handles(double_surface, wide, **given),
    }


def without_progress(size: int) -> Dict[str, Solve]:
    """Computations that have no iteration to tell of, or several: Ctrl-C ends them as well."""
    disk, ball = bent(size), _ball(size)
    boundary = bt.boundary_to_disk(disk, 0.9)
    found = bt.extremal_map(disk, boundary)
    holes = [(0.42, 0.2), (-0.4 + 0.1j, 0.25)]
    masks = []
    for factor in (1.0, 1.15):
        flat = bt.circle_domain(1, holes, edge_length=factor * 1.9 / size, jitter=0.2)
        x, y = flat.positions.T
        masks.append(bt.Mesh(np.column_stack([x, y, 0.4 * x * x - 0.3 * y * y]), flat.faces))
    rings = [bt.torus(2, radius, 2 * size, max(6, size + size // 2)) for radius in (1.0, 0.7)]
    double = _double_torus(size)
    return {
        "sphere_map": lambda: bt.sphere_map(bt.Surface(ball.positions * [1, 0.8, 1.2], ball.faces)),
        "least_distortion": lambda: bt.sphere_map(bt.Surface(ball.positions * [1, 0.8, 1.2], ball.faces), "least_distortion"),
        "flatten": lambda: bt.flatten(bt.Surface(disk.positions, disk.faces)),
        "round_disk": lambda: bt.round_disk_chart(bt.Surface(disk.positions, disk.faces)),
        "circles": lambda: bt.circle_domain_chart(bt.Surface(masks[0])),
        "distance": lambda: bt.teichmueller_distance(*map(bt.Surface, masks)),
        "proved_bounds": lambda: bt.proved_bounds(disk, boundary, found.map),
        "tori": lambda: bt.register_tori(*map(bt.Surface, rings), search=True),
        "hyperbolic": lambda: bt.hyperbolic_surface(bt.Surface(double)),
        "cut_open": lambda: bt.cut_open(bt.Surface(double)),
    }
