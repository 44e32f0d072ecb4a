"""Whatever arrays come, an error of Python comes of them and nothing worse."""

import os
import sys
from typing import Any, Callable, List

import numpy as np
import pytest

import beltrami as bt

from every_function import call_everything, callables, good_objects, parameters

GOOD_V = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
GOOD_F = np.array([[0, 1, 2], [0, 2, 3]])
# AddressSanitizer ends a program whose operator new finds no memory, where others raise MemoryError.
MANY = 2**16 if "asan" in os.environ.get("LD_PRELOAD", "") else 2**40
ALLOWED = (bt.Error, TypeError, ValueError, MemoryError, OverflowError)

TABLE = [
    ("no rows", np.zeros((0, 3)), GOOD_F, bt.BadMesh),
    ("no faces", GOOD_V, np.zeros((0, 3), int), bt.BadMesh),
    ("nothing", np.zeros((0, 0)), np.zeros((0, 0)), ALLOWED),
    ("one dimension", np.zeros(12), GOOD_F, bt.BadMesh),
    ("three dimensions", np.zeros((2, 2, 3)), GOOD_F, bt.BadMesh),
    ("four columns", np.zeros((4, 4)), GOOD_F, bt.BadMesh),
    ("a number", 3.0, GOOD_F, bt.BadMesh),
    ("text", "V", GOOD_F, TypeError),
    ("None", None, GOOD_F, TypeError),
    ("objects", np.array([[object()] * 3] * 4), GOOD_F, TypeError),
    ("complex", GOOD_V.astype(complex), GOOD_F, TypeError),
    ("flags", GOOD_V.astype(bool), GOOD_F, TypeError),
    ("dates", np.zeros((4, 3), "M8[s]"), GOOD_F, TypeError),
    ("ragged", [[0, 0], [1]], GOOD_F, TypeError),
    ("NaN", np.full((4, 2), np.nan), GOOD_F, bt.BadMesh),
    ("infinite", np.full((4, 2), np.inf), GOOD_F, bt.BadMesh),
    ("beyond float64", np.full((4, 2), np.longdouble(10) ** 4000), GOOD_F, bt.BadMesh),
    ("huge", np.broadcast_to(np.zeros(1), (2**40, 3)), GOOD_F, (bt.BadOption, MemoryError)),
    ("huge faces", GOOD_V, np.broadcast_to(np.zeros(1, int), (2**40, 3)), (bt.BadOption, MemoryError)),
    ("faces of floats", GOOD_V, GOOD_F.astype(float), TypeError),
    ("faces of five", GOOD_V, np.zeros((2, 5), int), bt.BadMesh),
    ("negative", GOOD_V, -GOOD_F - 1, bt.BadMesh),
    ("beyond int", GOOD_V, GOOD_F + 2**40, bt.BadMesh),
    ("beyond int64", GOOD_V, np.full((2, 3), 2**64 - 1, np.uint64), bt.BadMesh),
    ("one vertex", GOOD_V, np.zeros((2, 3), int), bt.BadMesh),
    ("a list of text", GOOD_V, [["a", "b", "c"]], TypeError),
    ("a face of one", GOOD_V, [[0, 1, 2], [0]], bt.BadMesh),
    ("the empty face", GOOD_V, [[0, 1, 2], []], bt.BadMesh),
    ("coinciding", np.zeros((4, 2)), GOOD_F, ALLOWED),
]


@pytest.mark.parametrize("V, F, error", [row[1:] for row in TABLE], ids=[row[0] for row in TABLE])
@pytest.mark.filterwarnings("ignore")
def test_bad_surfaces(V: Any, F: Any, error: Any) -> None:
    with pytest.raises(error):
        bt.Surface(V, F)
    with pytest.raises(ALLOWED):
        mesh = bt.Mesh(V, F)
        bt.Surface(mesh)


def bad_array(random: np.random.Generator) -> Any:
    """Anything: of any type, shape and layout, now and then an array that would do."""
    kinds: List[Any] = [np.float64, np.float32, np.float16, np.int64, np.int32, np.uint8, np.uint64, np.complex128, bool]
    kinds += ["U3", object, ">f8", ">i4", "M8[s]", np.longdouble]
    shape = tuple(int(n) for n in random.choice([0, 1, 2, 3, 4, 5, 8, 24, 64, 150], size=random.integers(0, 4)))
    if random.random() < 0.3:
        shape = (int(random.choice([4, 91, 150])), int(random.choice([2, 3, 4])))
    if random.random() < 0.2:
        shape = (int(random.choice([4, 91, 150])),)
    values = np.asarray(random.normal(size=shape) * random.choice([0, 1, 100, 1e300]))
    if random.random() < 0.3 and values.size:
        values.flat[random.integers(values.size)] = random.choice([np.nan, np.inf, -np.inf, -1, 2**31, 1e308])
    with np.errstate(all="ignore"):
        kind = kinds[random.integers(len(kinds))]
        array: Any = np.nan_to_num(values, posinf=1e18, neginf=-1e18).astype("i8").astype(kind) if kind == "M8[s]" else values.astype(kind)
    if array.ndim == 2 and random.random() < 0.3:
        array = array.T.copy().T
    if array.ndim and random.random() < 0.2:
        array = np.concatenate([array, array])[::2]
    if random.random() < 0.2:
        array.setflags(write=False)
    if random.random() < 0.1:
        return array.tolist()
    if random.random() < 0.05:
        return np.broadcast_to(array.reshape(-1)[:1] if array.size else np.zeros(1), (MANY, 3))
    if random.random() < 0.05:
        return random.choice(np.array([None, "x", 3, 2.5], dtype=object))
    return array


def calls(surface: bt.Surface, boundary: bt.BoundaryCondition, mesh: bt.Mesh, result: bt.PlanarMap) -> List[Callable[..., Any]]:
    constraints = bt.Constraints(boundary)
    solver = bt.ExtremalSolver(surface, bt.Constraints(boundary).pin(0, 0))
    faces = mesh.faces
    return [
        lambda a, b: bt.Surface(a, b),
        lambda a, b: bt.Surface(a, faces),
        lambda a, b: bt.Surface(mesh.positions, a),
        lambda a, b: bt.Mesh(a, faces, texture=(a, b)),
        lambda a, b: bt.Mesh(mesh.positions, faces, texture=(a, b)),
        lambda a, b: bt.diagnose(bt.Mesh(a, b)),
        lambda a, b: bt.Surface(mesh, metric=a),
        lambda a, b: bt.corners_from_lengths(mesh, a, b),
        lambda a, b: bt.measure(surface, a),
        lambda a, b: bt.distortion_to_corners(surface, a),
        lambda a, b: bt.PlanarMap(surface, a).K_max,
        lambda a, b: bt.PlanarMap(surface, a)(b),
        lambda a, b: result(a),
        lambda a, b: result.inverse(a),
        lambda a, b: bt.BoundaryCondition(a, b),
        lambda a, b: bt.harmonic_baseline(surface, bt.BoundaryCondition(a, b)),
        lambda a, b: bt.find_corners(surface, bt.BoundaryCondition(a, b)),
        lambda a, b: bt.require_feasible(surface, bt.BoundaryCondition(a, b)),
        lambda a, b: bt.split_prescribed(surface, bt.BoundaryCondition(a, b)),
        lambda a, b: bt.extremal_map(surface, boundary, start=a, max_iterations=2),
        lambda a, b: bt.extremal_map(surface, bt.BoundaryCondition(a, b), max_iterations=2),
        lambda a, b: bt.extremal_map_between(surface, surface, a, max_iterations=2),
        lambda a, b: solver.update(a),
        lambda a, b: bt.quasiconformal_map(surface, a, boundary),
        lambda a, b: bt.mu_along_first_edge(surface, a),
        lambda a, b: bt.mu_at_samples(surface, a),
        lambda a, b: bt.fold_free_map(surface, a, b, max_iterations=2),
        lambda a, b: bt.boundary_to_polygon(surface, a),
        lambda a, b: bt.TargetCurve.polygon(a).area,
        lambda a, b: bt.TargetCurve.spline(a).length,
        lambda a, b: bt.TargetCurve.circle(0, 1).nearest(a),
        lambda a, b: bt.TargetCurve.circle(0, 1).point(a),
        lambda a, b: bt.polygon_domain(a, edge_length=1),
        lambda a, b: bt.keep_faces(mesh, a),
        lambda a, b: bt.Places(a, b, a).interpolate(b),
        lambda a, b: bt.compose_maps(a, mesh, b),
        lambda a, b: bt.with_parents_means(a, b),
        lambda a, b: bt.bounds_of_map(surface, a),
        lambda a, b: bt.Constraints(boundary, turns=a, loops=b),
        lambda a, b: bt.write_mesh("/dev/null/never.obj", mesh, a),
        lambda a, b: constraints.pin(a, b),
        *calls_in_space(surface, boundary, mesh),
    ]


def calls_in_space(surface: bt.Surface, boundary: bt.BoundaryCondition, mesh: bt.Mesh) -> List[Callable[..., Any]]:
    linear = bt.BeltramiSolver(surface, boundary)
    linear.factorize(np.zeros(surface.face_count))
    problem = bt.LeastSquaresMap(surface, surface.boundary_loops[0], mesh.positions[surface.boundary_loops[0]])
    deform = bt.DeformSolver(surface, [0, 40, 80])
    ball = bt.Surface(bt.icosahedral_sphere(1))
    torus = bt.flat_torus(bt.Surface(bt.torus(2, 1, 8, 6)))
    square = bt.TargetDomain(bt.TargetCurve.polygon([0, 1, 1 + 1j, 1j]))
    elements = bt.corner_elements(surface)
    locator = bt.PlanarLocator(mesh)
    return [
        lambda a, b: bt.surface_flow(surface, bt.PlaneTarget(), a, start=b, max_iterations=2),
        lambda a, b: bt.surface_flow(surface, surface, a, bt.TargetConstraints(b), max_iterations=2),
        lambda a, b: bt.least_lp_map(surface, bt.PlaneTarget(), 2, a, start=b, max_iterations=2),
        lambda a, b: bt.target_map(ball, bt.SphereTarget(), bt.TargetConstraints(a), b),
        lambda a, b: bt.target_map(surface, square, bt.TargetConstraints().slide(a, bt.LevelCircle(1, 0)), b),
        lambda a, b: bt.nearest_points(ball, a),
        lambda a, b: bt.PolylineCurve(a, True).point(b),
        lambda a, b: bt.PolylineCurve(a, False).nearest(b),
        lambda a, b: bt.ring_module(surface, a),
        lambda a, b: bt.remesh(surface, a, sizing=b, fast=True),
        lambda a, b: bt.shapes_from_angles(mesh, a),
        lambda a, b: bt.feature_curves(surface, 0.3, a),
        lambda a, b: bt.carried_values(mesh, a, bt.Places(b, a, b)),
        lambda a, b: bt.LeastSquaresMap(surface, a, b).solve(),
        lambda a, b: bt.LeastSquaresMap(surface, [0, 1], [[0, 0], [1, 1]], reference=a),
        lambda a, b: problem.solve(a),
        lambda a, b: problem.energy(a, b),
        lambda a, b: bt.smoothed_over_edges(elements, surface, a),
        lambda a, b: bt.DeformSolver(surface, a).solve(b),
        lambda a, b: deform.solve(a),
        lambda a, b: bt.BeltramiSolver(surface, a).factorize(b),
        lambda a, b: linear.solve(a, b),
        lambda a, b: linear.solve_offsets(a),
        lambda a, b: linear.solve_poisson(a),
        lambda a, b: linear.solve_near(a, b, b),
        lambda a, b: bt.even_dilatation(surface, boundary, a, 0.1, b, steps=1),
        lambda a, b: bt.proved_bounds(surface, boundary, a),
        lambda a, b: bt.verified_bracket(surface, boundary, a, most_rounds=1),
        lambda a, b: bt.quadrilateral_bound(surface, a, b),
        lambda a, b: bt.differential_of(surface, a, b).at_samples(),
        lambda a, b: bt.averaged_estimate(surface, a, b),
        lambda a, b: bt.sphere_map(bt.Surface(a, b)),
        lambda a, b: bt.extremal_sphere_map(ball, ball.positions, a, b),
        lambda a, b: bt.register_spheres(ball, ball, a, b, max_iterations=2),
        lambda a, b: bt.register_open(surface, surface, a, b, max_iterations=2),
        lambda a, b: bt.register_least_lp(surface, surface, curves=[(a, b)], max_iterations=2),
        lambda a, b: bt.SurfaceCorrespondence(ball, ball, a, bt.Places(b, b, b)),
        lambda a, b: bt.homology_class(ball, torus.homology, a),
        lambda a, b: bt.torus_class(torus, a),
        lambda a, b: bt.marking_of_paths(torus, a, torus, b),
        lambda a, b: bt.places_on_torus(torus, a),
        lambda a, b: bt.symplectic_basis(a),
        lambda a, b: bt.wedge_products(ball, a),
        lambda a, b: locator.locate(a),
        lambda a, b: locator.nearest(a),
        lambda a, b: bt.mesh_with_curves(mesh, [(a, True)]),
        lambda a, b: bt.boundary_correspondence(surface, surface, a),
        lambda a, b: bt.reach_corners(surface, square, [(0, 0, a)], b),
        lambda a, b: bt.best_move(a, b),
        lambda a, b: bt.centre_in_disk(a, b),
        lambda a, b: bt.mu_statistics(a, b),
        lambda a, b: bt.fitted_to_unit_square(a),
        lambda a, b: bt.cut_along_seams(bt.Mesh(mesh.positions, mesh.faces, texture=(a, b))),
    ]


def random_calls(count: int, seed: int = 1) -> int:
    """How many of so many calls with bad arrays succeeded."""
    random = np.random.default_rng(seed)
    mesh = bt.disk(5)
    surface = bt.Surface(mesh)
    boundary = bt.boundary_to_disk(surface)
    result = bt.harmonic_baseline(surface, boundary)
    functions = calls(surface, boundary, mesh, result)
    succeeded = 0
    for i in range(count):
        function = functions[i % len(functions)]
        try:
            function(bad_array(random), bad_array(random))
            succeeded += 1
        except ALLOWED:
            pass
    return succeeded


@pytest.mark.filterwarnings("ignore")
def test_1000_random_arrays() -> None:
    assert 0 < random_calls(1000) < 1000


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seed", [0, 1])
def test_every_function(seed: int) -> None:
    count, succeeded = call_everything(np.random.default_rng(seed), bad_array, ALLOWED)
    assert count > 250 and 0 < succeeded < count


def test_no_lists_beyond_memory() -> None:
    torus = bt.flat_torus(bt.Surface(bt.torus(2, 1, 8, 6)))
    with pytest.raises(bt.BadOption):
        bt.marking_of_paths(torus, [[0, 1], [0, 2]], torus, np.broadcast_to(np.zeros(1, int), (2**40, 3)))


def test_none_is_no_object() -> None:
    asked = 0
    for name, function, of_object in callables(good_objects()):
        if of_object or isinstance(function, type) or "_core." not in parameters(function)[0][1]:
            continue
        with pytest.raises(TypeError):
            function(*[None] * sum(not key.startswith("*") for key, _ in parameters(function)))
        asked += 1
    assert asked > 100


if __name__ == "__main__":
    for round_ in range(max(1, int(sys.argv[1]) // 1000)):
        print(*call_everything(np.random.default_rng(int(sys.argv[2]) + round_), bad_array, ALLOWED), "calls of every function, and succeeded")
    print(random_calls(int(sys.argv[1]), int(sys.argv[2])), "of", sys.argv[1], "calls succeeded")
