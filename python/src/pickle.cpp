#include "pickle.h"

#include <beltrami/charts/circle_domain_chart.h>

namespace beltrami::python {

namespace {

py::tuple hole_state(const RoundHole& hole) {
    return py::make_tuple(hole.loop, hole.centre, hole.radius);
}

RoundHole hole_from(const py::handle& object) {
    const auto state = object.cast<py::tuple>();
    return {state[0].cast<int>(), state[1].cast<Complex>(), state[2].cast<double>()};
}

py::tuple chart_state(const CircleDomainChart& circles) {
    const Chart& chart = circles.chart;
    py::list holes, chart_holes, warnings;
    for (const RoundHole& hole : circles.holes) holes.append(hole_state(hole));
    for (const Chart::Hole& hole : chart.holes) chart_holes.append(py::make_tuple(hole.loop, hole.centre, hole.radius));
    for (const Warning& warning : chart.warnings)
        warnings.append(py::make_tuple(static_cast<int>(warning.kind), warning.sentence,
                                       static_cast<int>(warning.where.of), warning.where.indices));
    return py::make_tuple(chart.vertices, chart.corners, chart.positions, chart.derivatives,
                          py::bytes(chart.excluded.data(), chart.excluded.size()), chart.excluded_faces, chart.exact,
                          chart.outer_loop, chart_holes, chart.factorizations, warnings, holes, circles.roundness,
                          circles.mean_mu, circles.standard_deviation, circles.max_mu, circles.flipped, circles.pinched,
                          circles.steps, circles.converged, circles.factorizations, circles.harmonic_solves);
}

CircleDomainChart chart_from(const py::tuple& state) {
    CircleDomainChart circles;
    Chart& chart = circles.chart;
    std::size_t next = 0;
    const auto take = [&](auto& value) { value = state[next++].cast<std::decay_t<decltype(value)>>(); };
    take(chart.vertices);
    take(chart.corners);
    take(chart.positions);
    take(chart.derivatives);
    const auto excluded = state[next++].cast<std::string>();
    chart.excluded.assign(excluded.begin(), excluded.end());
    take(chart.excluded_faces);
    take(chart.exact);
    take(chart.outer_loop);
    for (const py::handle item : state[next++]) {
        const RoundHole hole = hole_from(item);
        chart.holes.push_back({hole.loop, hole.centre, hole.radius});
    }
    take(chart.factorizations);
    for (const py::handle item : state[next++]) {
        const auto warning = item.cast<py::tuple>();
        chart.warnings.push_back({static_cast<WarningKind>(warning[0].cast<int>()),
                                  warning[1].cast<std::string>(),
                                  {static_cast<Things>(warning[2].cast<int>()), warning[3].cast<std::vector<int>>()}});
    }
    for (const py::handle item : state[next++]) circles.holes.push_back(hole_from(item));
    take(circles.roundness);
    take(circles.mean_mu);
    take(circles.standard_deviation);
    take(circles.max_mu);
    take(circles.flipped);
    take(circles.pinched);
    take(circles.steps);
    take(circles.converged);
    take(circles.factorizations);
    take(circles.harmonic_solves);
    return circles;
}

/// Circle domains that are more than numbers (of an exact chart with a formula) are left to be computed again.
py::list circles_of(const Shape& shape) {
    py::list list;
    for (const auto& [outer, circles] : shape.kept_circles())
        if (!circles.chart.analytic) list.append(chart_state(circles));
    return list;
}

}  // namespace

py::tuple state_of(const SurfaceObject& object) {
    const Mesh& mesh = object.surface.mesh;
    const Shape& split = object.shape.without_bridges();
    return py::make_tuple(mesh.positions, index_array(mesh.faces.vertices()), index_array(mesh.faces.offsets()),
                          object.surface.metric ? py::cast(*object.surface.metric) : py::none(),
                          circles_of(object.shape), &split == &object.shape ? py::list() : circles_of(split));
}

SurfacePtr surface_from_state(const py::tuple& state) {
    if (state.size() != 6) throw py::value_error("this is no pickled surface");
    Mesh mesh;
    mesh.positions = state[0].cast<Positions>();
    const std::vector<int> vertices = whole_numbers(state[1], "faces"), offsets = whole_numbers(state[2], "offsets");
    for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
        if (offsets[f] < 0 || offsets[f + 1] < offsets[f] || offsets[f + 1] > static_cast<int>(vertices.size()))
            throw py::value_error("this is no pickled surface");
        mesh.faces.add(std::span<const int>(vertices).subspan(static_cast<std::size_t>(offsets[f]),
                                                              static_cast<std::size_t>(offsets[f + 1] - offsets[f])));
    }
    std::optional<Positions> metric;
    if (!state[3].is_none()) metric = state[3].cast<Positions>();
    SurfacePtr surface = make_surface(checked(std::move(mesh)), std::move(metric));
    for (const py::handle chart : state[4]) surface->shape.keep(chart_from(chart.cast<py::tuple>()));
    for (const py::handle chart : state[5]) surface->shape.without_bridges().keep(chart_from(chart.cast<py::tuple>()));
    return surface;
}

}  // namespace beltrami::python
