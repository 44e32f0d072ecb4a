"""Calls every public function, constructor and method with bad arrays, as the module's own signatures say what they take."""

import inspect
import re
from typing import Any, Callable, Dict, Iterator, List, Tuple

import numpy as np

import beltrami as bt

# What writes or reads files, sets the process up, or calls back.
LEFT_OUT = {"set_thread_count", "read_mesh", "read_obj", "read_off", "read_ply", "read_stl", "save", "report", "plot", "write_mesh"}
NUMBERS: Dict[str, List[Any]] = {
    "int": [-1, 0, 1, 2, 5, 10**6],
    "float": [0.0, 0.5, 1.0, -1.0, np.nan, np.inf, 1e-300],
    "complex": [0j, 0.5 + 0.1j, complex(np.nan, 0), 1e300 + 0j],
    "bool": [True, False],
    "str": ["", "none", "rigid", "x"],
}


def parameters(function: Any) -> List[Tuple[str, str]]:
    """Names and types of what a function of the module takes, by the first line of its docstring."""
    found = re.match(r"\w+\((.*)\) -> ", (function.__doc__ or "").split("\n")[0])
    if not found:
        return []
    depth, parts = 0, [""]
    for letter in found[1]:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    pairs = [part.strip().split(":", 1) for part in parts if part.strip() not in ("", "*", "/")]
    return [(pair[0].strip(), pair[1].split(" = ")[0].strip() if len(pair) > 1 else "") for pair in pairs]


def good_objects() -> Dict[str, List[Any]]:
    """Something small of every class that functions ask for, by the class's name."""
    disk = bt.Surface(bt.disk(4, jitter=0.2))
    ring = bt.Surface(bt.annulus(0.4, 1, 16))
    ball = bt.Surface(bt.icosahedral_sphere(1))
    torus = bt.Surface(bt.torus(2, 1, 8, 6))
    double = bt.Surface(bt.double_torus())
    boundary = bt.boundary_to_disk(disk)
    square = bt.TargetDomain(bt.TargetCurve.polygon([0, 1, 1 + 1j, 1j]))
    flat = bt.flat_torus(torus)
    sphere = bt.sphere_map(ball)
    found = bt.extremal_map(disk, bt.boundary_to_disk(disk, 0.5))
    objects = [disk, ring, ball, torus, double, *(bt.Mesh(s.positions, s.faces) for s in (disk, ring, ball, torus)), boundary, square,
               square.outer, flat, sphere, found, bt.SphereTarget(), bt.PlaneTarget(), bt.TargetConstraints(), bt.Constraints(boundary),
               bt.corner_elements(disk), bt.places_of_vertices(bt.Mesh(disk.positions, disk.faces)), bt.hyperbolic_surface(double), bt.LevelCircle(1, 0),
               bt.register_spheres(ball, ball, [0, 3, 7, 9], [0, 3, 7, 9]), bt.PlanarLocator(bt.Mesh(disk.positions, disk.faces)),
               bt.circle_domain_chart(ring), bt.LeastSquaresMap(disk, disk.boundary_loops[0], disk.positions[disk.boundary_loops[0]]),
               bt.DeformSolver(disk, [0, 5, 9]), bt.BeltramiSolver(disk, boundary), bt.ExtremalSolver(disk, bt.Constraints(boundary).pin(0, 0))]
    pool: Dict[str, List[Any]] = {}
    for thing in objects:
        for kind in type(thing).__mro__:
            pool.setdefault(kind.__name__, []).append(thing)
    return pool


def callables(pool: Dict[str, List[Any]]) -> Iterator[Tuple[str, Any, bool]]:
    """Name, what is called, and whether it is asked of an object of a class."""
    for name in sorted(dir(bt)):
        thing = getattr(bt, name)
        if name.startswith("_") or name in LEFT_OUT or inspect.ismodule(thing):
            continue
        if not inspect.isclass(thing):
            if parameters(thing):
                yield name, thing, False
            continue
        if parameters(getattr(thing, "__init__", None)):
            yield name, thing, False
        for method in sorted(vars(thing)):
            if method.startswith("_") and method != "__call__" or method in LEFT_OUT:
                continue
            bound = getattr(thing, method)
            if callable(bound) and parameters(bound) and (name in pool or parameters(bound)[0][0] != "self"):
                yield f"{name}.{method}", bound, parameters(bound)[0][0] == "self"


def argument(kind: str, pool: Dict[str, List[Any]], random: np.random.Generator, bad: Callable[[np.random.Generator], Any]) -> Any:
    named = [name for name in re.findall(r"_core\.(\w+)", kind) if name in pool]
    if "List" not in kind and named and random.random() < 0.9:
        return pool[named[0]][random.integers(len(pool[named[0]]))]
    if kind in NUMBERS and random.random() < 0.8:
        return NUMBERS[kind][random.integers(len(NUMBERS[kind]))]
    if "List" in kind and random.random() < 0.5:
        return [pool[named[0]][0]] * 2 if named else [int(i) for i in random.integers(-1, 6, size=random.integers(0, 5))]
    if "function" in kind:
        return None if random.random() < 0.5 else (lambda *given: given[0] if given else None)
    return bad(random)


def call_everything(random: np.random.Generator, bad: Callable[[np.random.Generator], Any], allowed: tuple, say: Callable[[str], Any] = lambda name: None) -> Tuple[int, int]:
    """Each once. How many calls there were and how many succeeded; what is not allowed is raised."""
    pool = good_objects()
    count = succeeded = 0
    for name, function, of_object in callables(pool):
        taken = parameters(function.__init__ if inspect.isclass(function) else function)
        if inspect.isclass(function):
            taken = taken[1:]
        given = []
        for i, (key, kind) in enumerate(taken):
            if key.startswith("*"):
                break
            given.append(pool[name.split(".")[0]][0] if i == 0 and of_object else argument(kind, pool, random, bad))
        options: Dict[str, Any] = {"max_iterations": 2} if "max_iterations" in (function.__doc__ or "") and taken[-1][0] == "**kwargs" else {}
        say(name)
        count += 1
        try:
            function(*given, **options)
            succeeded += 1
        except allowed:
            pass
    return count, succeeded
