"""Every public function and class of the library has a binding, or a reason why it has none."""

import re
from pathlib import Path
from types import FunctionType
from typing import Dict, Iterator, List, Set, Tuple

import pytest

import beltrami as bt

SOURCE = Path(__file__).resolve().parents[2] / "src"

# What has no binding by its name, and why. A name that is new in a public header is bound, or entered here; an entry that
# no longer stands for anything is an error too.
NOT_BOUND: Dict[str, str] = {
    "is in C++ what NumPy and Python have themselves": """
        parallel_for parallel_for_each parallel_sum stop_if_wanted StopWhen count append prefixed sentences
        to_string loop_images""",
    "is what a class of the module is made by, holds or does: Surface, Mesh, Places, Constraints, PlanarMap": """
        surface_of mesh_from face_matrix topology Topology FaceList TextureCoordinates MeshPoint MapEvaluation Shape shape_of
        circle_domain_of SlidingArc SurfaceTarget Mark Waypoint CurveParameter TargetVertex Correspondence on_curve CurvePlace
        Circle HalfSpace SphereLandmark LpNorm CurveThrough CurvePair
        PlacePair BoundaryPlacement spoils_topology validate locate_in_chart mesh_point boundary_place
        BoundaryPlace Column MeshOutput ReichStrebel ProblemSolver prescribed_target places_on_target
        PrescribedTarget proves texture_of_map CircleDomainChart places_of normals_of positions_of
        EdgeGroup Marking""",
    "is a result that comes as a tuple, a dict, an array or a field": """
        ConformalCarrier BoundaryCorrespondence CircleMatching HyperbolicCircle Uniformization Flattening FoldFreeFlattening
        FoldFreeMap FoldFreeStep CutMesh OrientedMesh WeldSuggestion WeldedMesh SubdividedMesh Submesh FilledSurface HoleFill
        SplitProblem MeshWithCurves CriticalPoint CoefficientError FlowIteration SurfaceFlowIteration CutOpen HarmonicBasis
        PeriodMatrix FollowedMap HoleTurns HomotopyClass LoopPath HoleRing StartInClass LoadedMesh MuStatistics NearestPlace
        FeatureCurves SurfaceDistance TargetMesh DistanceMatrix Merge TorusDistances LeastDilatationMap InChart NoiseCost
        SlackReport ExtremalPiece ProvedBounds SphereRegistration OpenRegistration LpRegistration HandleRegistration
        HandleMarking boundary_lengths DrawnSurface TransferredPolyline""",
    "is what register_handles does with search=True": "search_class ClassSearch",
    "is what registration with curves does with extremal=True": "extremal_flow ExtremalFlowMap",
    "is the picture of deformed_picture, an array, and where it lies": "Picture Box",
    "is Places.interpolate with texture coordinates": "texture_at",
    "is a part of maps between hyperbolic surfaces, which register_handles puts together":
        "edge_between flatness periods_of_images step_at_corner",
    "is told by PlaneGrid": "lines_of",
    "is what Continuation leads: follow and continuation_steps take the way": "Continuation",
    "writes records and pages: to_json(), report() and str() of results": """render_page require_texture PageContent PageMap to_json to_table
        to_remarks to_sentence record_findings certificate_record corners_record correspondence_record hyperbolic_record
        map_record onto_record periods_record registration_record solve_record source_record sphere_record split_record
        torus_record uniformization_record""",
    "is said by warnings and fields of results": "corner_decides corner_warning misfit_warning coefficient_fits",
    "is the map of the command's own files: write_mesh takes any": "write_obj write_off write_ply",
    "evaluates charts, which QuadraticDifferential.at does": "chart_points boundary_on_circles",
    "is in terms of DomainOptions and sizes, which circle_domain and polygon_domain take": "SizeSource",
}

# Headers that beltrami.h does not name itself and that are only what its own need: parts of a solver, not for calling.
PARTS: Dict[str, str] = {
    "the records of the command": "report/*",
    "the certificate's own spaces and images": "certificate/quadratic_map.h certificate/quadratic_space.h certificate/pair_bound.h",
    "charts, spaces and singularities in which φ is written down": "charts/chart.h charts/hole_rounding.h differentials/*",
    "how starts of sliding boundaries are found": "starts/* solve/sliding_boundary.h flow/flow_start.h flow/slid_map.h",
    "numbers in which surfaces are triangulated and laid out": """uniformize/intrinsic_triangulation.h
        uniformize/triangle_metric.h plane/disk_isometry.h plane/segment_tree.h plane/circle_domain.h meshing/delaunay.h
        meshing/jitter.h locate/surface_locator.h hyperbolic/equivariant_map.h base/* mesh/edge_table.h""",
    "columns of files": "io/*",
    "operators, derivatives, options and results in parts": """operators/* solve/map_result.h
        registration/surface_landmarks.h applications/grid_quality.h applications/plane_grid.h
        teichmuller/iteration.h teichmuller/extremal_options.h teichmuller/carried_surface.h""",
}


def reached(header: str, found: List[str]) -> List[str]:
    """The headers that beltrami.h includes, and those that these need."""
    if header not in found and header != "beltrami/version.h":
        found.append(header)
        for line in (SOURCE / header).read_text(encoding="utf-8").splitlines():
            if match := re.match(r"#include <(beltrami/[^>]*)>", line):
                reached(match[1], found)
    return found


def declarations(text: str) -> Iterator[str]:
    """What stands directly in namespace beltrami BELTRAMI_PUBLIC, without bodies."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/|^#[^\n]*", "", text, flags=re.S | re.M)
    text = re.sub(r'"(\\.|[^"\\])*"|' + r"'(\\.|[^'\\])'", '""', text)
    for match in re.finditer(r"namespace beltrami BELTRAMI_PUBLIC \{", text):
        start = position = match.end()
        depth, head = 0, ""
        while position < len(text) and not (text[position] == "}" and depth == 0):
            character = text[position]
            if character == "{":
                head = text[start:position] if depth == 0 else head
                depth += 1
            elif character == "}":
                depth -= 1
                if depth == 0 and not re.match(r"\s*;", text[position + 1 :]):  # the body of a function
                    yield head
                    start, head = position + 1, ""
            elif character == ";" and depth == 0:
                yield head or text[start:position]
                start, head = position + 1, ""
            position += 1


def names(header: str) -> Set[str]:
    """Functions and classes that a header declares; no enumerations, constants, operators and other names of types."""
    result = set()
    for declaration in declarations((SOURCE / header).read_text(encoding="utf-8")):
        text = " ".join(declaration.split())
        text = re.sub(r"^template <[^()]*?> (?=(class|struct|inline|auto|void|bool|double|\w+ \w+\())", "", text)
        if re.match(r"(enum|union|using|namespace|inline constexpr|constexpr)\b", text) or "operator" in text.split("(")[0]:
            continue
        if match := re.match(r"(?:class|struct) (?:\[\[\w+\]\] )?(\w+)( final)?( :.*)?$", text):
            result.add(match[1])
        else:
            while (bare := re.sub(r"<[^<>]*>", "", text)) != text:
                text = bare
            if match := re.search(r"(\w+) ?\(", text):
                result.add(match[1])
    return result


def public() -> Dict[str, Set[str]]:
    """Names by header, of headers with a name."""
    listed = set(re.findall(r"#include <(beltrami/[^>]*)>", (SOURCE / "beltrami/beltrami.h").read_text(encoding="utf-8")))
    parts = [pattern for text in PARTS.values() for pattern in text.split()]
    result = {}
    for header in reached("beltrami/beltrami.h", []):
        short = Path(header).relative_to("beltrami")
        if header in listed or not any(short.match(pattern) for pattern in parts):
            result[short.as_posix()] = names(header)
    return {header: found for header, found in result.items() if found}


def entered() -> Set[str]:
    return {name for text in NOT_BOUND.values() for name in text.split()}


def is_bound(name: str) -> bool:
    return hasattr(bt, name) or name.endswith(("Options", "Record")) or name in entered()


@pytest.mark.skipif(not (SOURCE / "beltrami").is_dir(), reason="the sources are not here")
def test_every_public_function_and_class_is_bound_or_has_a_reason() -> None:
    found = public()
    assert len(found) > 100 and sum(map(len, found.values())) > 350
    missing: List[Tuple[str, str]] = [(h, n) for h, all in found.items() for n in sorted(all) if not is_bound(n)]
    assert not missing, "bind these, or enter them in NOT_BOUND with a reason: " + ", ".join(f"{n} ({h})" for h, n in missing)


@pytest.mark.skipif(not (SOURCE / "beltrami").is_dir(), reason="the sources are not here")
def test_reasons_are_up_to_date() -> None:
    there = {name for all in public().values() for name in all}
    assert not (entered() - there), "these are no longer public: " + ", ".join(sorted(entered() - there))
    bound = sorted(name for name in entered() if hasattr(bt, name))
    assert not bound, "these are bound now: " + ", ".join(bound)


def test_docstrings_say_what_things_are() -> None:
    """Every function and class, method and property of the module has one; functions that can raise say so."""
    silent = []
    for name, member in vars(bt).items():
        if name.startswith("_") or getattr(member, "__module__", "") != "beltrami._core":
            continue
        text = member.__doc__ or ""
        # pybind11's first line is the signature.
        if not isinstance(member, type) and len(text.split("\n", 2)) < 3 or not text.strip():
            silent.append(name)
        for part, value in vars(member).items() if isinstance(member, type) else ():
            if part.startswith("_") or not callable(value) or isinstance(value, (staticmethod, FunctionType)):
                continue
            if len((value.__doc__ or "").split("\n", 2)) < 3 and name in RESULTS_WITH_METHODS:
                silent.append(f"{name}.{part}")
    assert not silent, silent


RESULTS_WITH_METHODS = {"PlanarMap", "SpaceMap", "Places", "Registration", "FlatTorus", "BeltramiSolver", "DeformSolver", "LeastSquaresMap"}
