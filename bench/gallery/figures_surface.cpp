// Figures of surfaces in space: 10, 12, 13, 18, 19.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <beltrami/base/random.h>
#include <beltrami/generate/grids.h>
#include <beltrami/mesh/submesh.h>

#include "gallery/gallery.h"

namespace beltrami::gallery {

using namespace beltrami::bench;

Figure figure_10(Output& output) {
    Figure figure{"Figure 10: dependence on the start",
                  "*The paper:* A screw to an annulus from a harmonic, an ARAP and a noisy start with 924, 268 and 831 "
                  "folds: the same map every time, without folds."};
    const Problem problem = named_problem("screw");
    const Surface surface(problem.mesh);
    Table table{problem.statement + ", " + std::to_string(problem.mesh.face_count()) + " triangles",
                {"start", "its flips", "k", "K_lower", "K", "mean abs(μ)", "std", "max", "flips", "iterations",
                 "seconds", "distance from the first map"},
                {}};
    Picture starts{"figure_10", "The three starts, flipped faces in red.", {}},
        maps{"figure_10_texture", "A checkerboard of the plane under the extremal maps from these starts.", {}};
    std::optional<Eigen::VectorXcd> first;
    std::vector<std::pair<std::string, std::string>> lines;
    // Noisy starts: inner vertices of a map without folds displaced by up to so much; the annulus is .55 wide.
    const std::map<std::string, double> noise{{"noise .02", 0.02}, {"noise .05", 0.05}, {"noise .1", 0.1}};
    for (const std::string name : {"harmonic", "ARAP", "noise .02", "noise .05", "noise .1"}) {
        const Solved start = solve_with(surface, name, [&] {
            if (name == "harmonic") return harmonic_map(surface, problem.boundary);
            if (name == "ARAP") return arap_baseline(surface, problem.boundary).map;
            Eigen::VectorXcd map = *problem.witness;
            Random random(10);
            for (int v = 0; v < map.size(); ++v) {
                const double x = random.uniform(-noise.at(name), noise.at(name)),
                             y = random.uniform(-noise.at(name), noise.at(name));
                if (!surface.topology.on_boundary[v]) map[v] += Complex(x, y);
            }
            return map;
        });
        ExtremalOptions options;
        options.start = start.map;
        const Solved solved = solve(surface, problem.boundary, "extremal", options);
        const std::string flips = std::to_string(start.distortion.flipped.size());
        if (!solved) {
            table.rows.push_back({name, flips, "refused: " + solved.refusal});
            continue;
        }
        if (!first) first = solved.map;
        const Distortion& d = solved.distortion;
        table.rows.push_back(
            {name, flips, number(*solved.k, 6), number(*solved.K_lower, 5), number(*solved.K, 5), number(d.mean, 5),
             number(d.standard_deviation, 5), number(d.max), std::to_string(d.flipped.size()),
             std::to_string(solved.iterations) + (solved.end == "converged" ? "" : " (" + solved.end + ")"),
             number(solved.seconds, 2), number((solved.map - *first).cwiseAbs().maxCoeff(), 5)});
        if (name == "noise .02" || name == "noise .1") continue;  // not drawn
        starts.panels.push_back(
            map_panel(output.write("figure_10_start_" + name, surface, start), name + ": " + flips + " flips"));
        lines.push_back({"from " + name, output.write("figure_10_" + name, surface, solved)});
        maps.panels.push_back(
            surface_panel(lines.back().second, "from " + name, "checker", 20, 25, 30, 1, problem.highlights));
    }
    maps.panels.push_back(histogram_panel(lines, "|μ|", {}, 1));
    figure.tables.push_back(std::move(table));
    figure.pictures = {std::move(starts), std::move(maps)};
    figure.remarks.push_back(
        "The starts give the same map as long as their noise is not too wild. From .1, where close to half of all "
        "faces "
        "are flipped, what comes out is no map, and the iteration begins again from the harmonic start, with a "
        "warning; both runs are counted. The harmonic start needs no option and is the best one.");
    return figure;
}

namespace {

/// The extremal maps of the pieces into which pinned curves cut a surface: nothing passes from piece to piece, so K* of
/// the whole is the largest of theirs.
Table pieces_table(const Problem& problem, const BoundaryCondition& boundary) {
    Table table{
        "The same, piece by piece: curves that are pinned cut the surface into problems of their own, and K* of "
        "the whole is the largest of theirs",
        usual_head("piece"),
        {}};
    std::map<int, Complex> images;
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) images[boundary.vertices[i]] = boundary.images[i];
    std::set<std::pair<int, int>> walls;
    for (const FeatureCurve& curve : problem.features)
        for (std::size_t i = 1; i < curve.vertices.size(); ++i)
            walls.insert(std::minmax(curve.vertices[i], curve.vertices[i - 1]));
    const FaceList& faces = problem.mesh.faces;
    std::map<std::pair<int, int>, std::vector<int>> beside;
    const auto edge = [&](int f, int j) {
        return std::pair<int, int>(std::minmax(faces[f][j], faces[f][(j + 1) % 3]));
    };
    for (int f = 0; f < problem.mesh.face_count(); ++f)
        for (int j = 0; j < 3; ++j) beside[edge(f, j)].push_back(f);
    std::vector<char> done(problem.mesh.face_count(), 0);
    for (int first = 0; first < problem.mesh.face_count(); ++first) {
        if (done[first]) continue;
        std::vector<int> piece{first};
        done[first] = 1;
        for (std::size_t i = 0; i < piece.size(); ++i)
            for (int j = 0; j < 3; ++j) {
                if (walls.contains(edge(piece[i], j))) continue;
                for (const int g : beside[edge(piece[i], j)])
                    if (!done[g]) {
                        done[g] = 1;
                        piece.push_back(g);
                    }
            }
        std::sort(piece.begin(), piece.end());
        const Submesh part = keep_faces(problem.mesh, piece);
        const Surface surface(part.mesh);
        BoundaryCondition own;
        for (const auto& loop : surface.topology.boundary_loops)
            for (const int v : loop) own.pin(v, images.at(part.vertices[v]));
        table.rows.push_back(
            usual_row(std::to_string(part.mesh.face_count()) + " triangles", solve(surface, own, "extremal")));
    }
    return table;
}

/// The part's near end with a step: between the first two edges the outline runs on another parametric line, so that
/// the image is not convex. Images of features that end there follow; lines stay parametric.
BoundaryCondition stepped_outline(const Problem& problem, double depth) {
    const auto feature = [&](const std::string& name) -> const FeatureCurve& {
        return *std::find_if(problem.features.begin(), problem.features.end(),
                             [&](const FeatureCurve& curve) { return curve.name == name; });
    };
    const double u1 = feature("wall to round").value, u2 = feature("round to plateau").value,
                 u4 = feature("chamfer").value, top = feature("far end").value;
    const std::vector<Complex> outline{0, u1, {u1, depth * top}, {u2, depth * top}, u2, u4};
    // The near end's vertices run along it: the two edges' ends go to the step's upper corners.
    const std::vector<double> places{0, 0.75, 1, 2, 2.25, 4};
    const FeatureCurve& near_end = feature("near end");
    std::map<int, Complex> images;
    for (std::size_t i = 0; i < near_end.vertices.size(); ++i) {
        const double at = 4.0 * static_cast<double>(i) / static_cast<double>(near_end.vertices.size() - 1);
        const std::size_t piece = std::min<std::size_t>(
            std::upper_bound(places.begin() + 1, places.end() - 1, at) - places.begin() - 1, places.size() - 2);
        const double part = (at - places[piece]) / (places[piece + 1] - places[piece]);
        images[near_end.vertices[i]] = (1 - part) * outline[piece] + part * outline[piece + 1];
    }
    BoundaryCondition boundary = problem.boundary;
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        if (const auto image = images.find(boundary.vertices[i]); image != images.end())
            boundary.images[i] = image->second;
    return boundary;
}

/// Features on their lines, free to slide; where they cross both coordinates are fixed.
void hold_on_lines(const Problem& problem, BoundaryCondition& boundary) {
    std::set<int> taken(boundary.vertices.begin(), boundary.vertices.end());
    std::map<int, int> curves;  // through a vertex
    for (const FeatureCurve& curve : problem.features)
        for (const int v : curve.vertices) ++curves[v];
    for (const FeatureCurve& curve : problem.features)
        for (std::size_t i = 0; i < curve.vertices.size(); ++i) {
            const int v = curve.vertices[i];
            if (!taken.insert(v).second) continue;
            if (curves[v] > 1)
                boundary.pin(v, curve.images[i]);
            else if (curve.fixed == FeatureCurve::Fixed::u)
                boundary.pin_to_line(v, {curve.value, 0}, {0, 1});
            else
                boundary.pin_to_line(v, {0, curve.value}, {1, 0});
        }
}

}  // namespace

Figure figure_12(Output& output) {
    Figure figure{"Figure 12: aligned sharp features",
                  "*The paper:* The front of the fandisk, its features and boundary on parametric lines: harmonic and "
                  "ARAP maps fold or distort strongly, the extremal map does not."};
    const Problem problem = named_problem("cad_part");
    const auto compare = [&](const std::string& name, const std::string& how, const BoundaryCondition& boundary,
                             const std::vector<std::string>& methods) {
        Comparison{output, figure, name, problem, boundary, -40, 50, 24, 0.7}.run(methods);
        figure.tables.back().caption += "; " + how;
        for (Picture* picture : {&figure.pictures.back(), &figure.pictures[figure.pictures.size() - 2]})
            picture->caption.insert(picture->caption.size() - 1, "; " + how);
    };
    BoundaryCondition pinned = problem.boundary;
    std::set<int> taken(pinned.vertices.begin(), pinned.vertices.end());
    for (const FeatureCurve& curve : problem.features)
        for (std::size_t i = 0; i < curve.vertices.size(); ++i)
            if (taken.insert(curve.vertices[i]).second) pinned.pin(curve.vertices[i], curve.images[i]);
    compare("figure_12", "features pinned by arc length", pinned, {"harmonic", "ARAP", "extremal"});
    figure.tables.push_back(pieces_table(problem, pinned));
    BoundaryCondition lines = problem.boundary;
    hold_on_lines(problem, lines);
    compare("figure_12_lines", "features slide along their lines", lines, {"harmonic", "extremal"});
    compare("figure_12_outline", "the outline with a step, features free", stepped_outline(problem, 0.3),
            {"harmonic", "ARAP", "extremal"});
    figure.remarks.push_back(
        "Onto the rectangle our part is gentler than the fandisk, and no method flips many faces. With a step in the "
        "outline, as the front of the "
        "fandisk has them, harmonic and ARAP maps fold at its corners and the extremal map does not. Pinned features "
        "cut the part into pieces, each of "
        "which is mapped by its own extremal map; k is that of the worst, and the histogram has a peak for every k of "
        "a piece. Features that slide leave φ a real jump "
        "across them.");
    return figure;
}

Figure figure_13(Output& output) {
    Figure figure{
        "Figure 13: a multiply connected curved surface",
        "*The paper:* A large curved model with holes, aligned to all its boundaries, without cones or cuts."};
    const Problem problem = named_problem("curved_plate");
    Comparison{output, figure, "figure_13", problem, problem.boundary, -60, 45, 30, 0.7}.run({"harmonic", "extremal"});
    return figure;
}

namespace {

/// A square sheet over the plane and markers on it that are to be moved.
struct Sheet {
    std::string name, caption;
    std::function<double(double x, double y)> height;
    std::vector<std::pair<Complex, Complex>> markers;  ///< place, and how far its image is moved
};

/// The metric in which a mesh is what a map makes of it: texture coordinates as `--metric vt` reads them.
Surface in_metric_of(const Mesh& mesh, const Eigen::VectorXcd& map) {
    Positions corners(static_cast<int>(mesh.faces.corner_count()), 2);
    int corner = 0;
    for (int f = 0; f < mesh.face_count(); ++f)
        for (const int v : mesh.faces[f]) corners.row(corner++) << map[v].real(), map[v].imag();
    return {mesh, corners};
}

void with_markers(Output& output, Figure& figure, const Sheet& sheet) {
    constexpr int count = 70;
    const Mesh plane = rectangle(2, 2, count, count);
    Mesh mesh;
    mesh.faces = plane.faces;
    mesh.positions.resize(plane.vertex_count(), 3);
    for (int v = 0; v < plane.vertex_count(); ++v) {
        const double x = plane.positions(v, 0) - 1, y = plane.positions(v, 1) - 1;
        mesh.positions.row(v) << x, y, sheet.height(x, y);
    }
    const Surface surface(mesh);
    const Eigen::VectorXcd flat = arap_baseline(surface, {}).map;
    const Surface in_arap = in_metric_of(mesh, flat);
    // The boundary stays where the ARAP map has it; the markers are moved.
    BoundaryCondition boundary;
    for (const int v : surface.topology.boundary_loops[0]) boundary.pin(v, flat[v]);
    std::vector<std::vector<int>> crosses;
    for (const auto& [place, shift] : sheet.markers) {
        int nearest = 0;
        double best = 1e300;
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const double d = std::abs(Complex(mesh.positions(v, 0), mesh.positions(v, 1)) - place);
            if (d < best) best = d, nearest = v;
        }
        boundary.pin(nearest, flat[nearest] + shift);
        crosses.push_back({nearest - 1, nearest, nearest + 1});
        crosses.push_back({nearest - count - 1, nearest, nearest + count + 1});
    }
    Table table{sheet.caption,
                {"map", "metric", "k", "K_lower", "K", "mean abs(μ) in the ARAP metric", "std", "p99", "max", "flips",
                 "mean abs(μ) on the surface", "std", "iterations"},
                {}};
    Picture picture{sheet.name, sheet.caption + ": |μ| in the ARAP metric.", {}},
        views{sheet.name + "_texture", "A checkerboard of the plane; markers in black.", {}};
    const auto add = [&](const std::string& name, const std::string& metric, const Solved& solved) {
        if (!solved) {
            table.rows.push_back({name, metric, "refused: " + solved.refusal});
            return;
        }
        const Distortion arap = distortion(in_arap.operators, solved.map),
                         own = distortion(surface.operators, solved.map);
        table.rows.push_back({name, metric, solved.k ? number(*solved.k) : "",
                              solved.K_lower ? number(*solved.K_lower) : "", solved.K ? number(*solved.K) : "",
                              number(arap.mean), number(arap.standard_deviation), number(arap.p99), number(arap.max),
                              std::to_string(arap.flipped.size()), number(own.mean), number(own.standard_deviation),
                              solved.iterations > 0 ? std::to_string(solved.iterations) : ""});
        const std::string data = output.write(sheet.name + "_" + std::to_string(picture.panels.size()), surface.mesh,
                                              solved.map, arap.face_abs_mu);
        const std::string title = name + (metric.empty() ? "" : ", " + metric);
        picture.panels.push_back(map_panel(data, title, 0.6));
        views.panels.push_back(surface_panel(data, title, "checker", -60, 50, 24, 1, crosses));
    };
    add("ARAP, no markers", "", solve_with(surface, "ARAP", [&] { return flat; }));
    const Solved folded = solve(surface, boundary, "ARAP");
    add("ARAP with markers", "", folded);
    add("extremal", "surface", solve(surface, boundary, "extremal"));
    add("extremal", "ARAP", solve(in_arap, boundary, "extremal"));
    if (folded) {
        const Solved corrected = solve(in_metric_of(mesh, folded.map), boundary, "extremal");
        add("extremal", "ARAP with markers", corrected);
        if (corrected)
            figure.remarks.push_back(
                sheet.caption +
                ": the folded ARAP map with markers, corrected by the extremal map in its own metric, " +
                std::to_string(folded.distortion.flipped.size()) + " flipped faces → " +
                std::to_string(corrected.distortion.flipped.size()) + "; vertices move by " +
                number((corrected.map - folded.map).cwiseAbs().mean()) + " in the mean and " +
                number((corrected.map - folded.map).cwiseAbs().maxCoeff()) + " at most.");
    }
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back(std::move(picture));
    figure.pictures.push_back(std::move(views));
}

}  // namespace

Figure figure_18(Output& output) {
    Figure figure{"Figure 18: combined with the metric of an ARAP map",
                  "*The paper:* A quasiconformal parametrization in the metric of an ARAP map reduces the artifacts at "
                  "constraints, at the cost of more distortion elsewhere; so markers can be moved to where they should "
                  "be. The metric of a map with folds serves to correct it."};
    with_markers(
        output, figure,
        {"figure_18",
         "A hilly square, its boundary where its ARAP map has it, four markers moved",
         [](double x, double y) {
             return 0.5 * std::exp(-6 * ((x - .25) * (x - .25) + (y - .2) * (y - .2))) + 0.15 * std::sin(3 * x + y);
         },
         {{{-.5, -.5}, {.2, .05}}, {{.5, -.5}, {.05, .2}}, {{.5, .5}, {-.2, -.05}}, {{-.5, .5}, {-.05, -.2}}}});
    with_markers(output, figure,
                 {"figure_18_nose",
                  "A sheet with a steep nose and a dent, six markers moved up and down in turn",
                  [](double x, double y) {
                      return 0.9 * std::exp(-14 * (x * x + y * y)) -
                             0.4 * std::exp(-10 * ((x + .5) * (x + .5) + (y - .45) * (y - .45)));
                  },
                  {{{-.6, -.1}, {0, .18}},
                   {{-.36, -.1}, {0, -.18}},
                   {{-.12, -.45}, {0, .18}},
                   {{.12, -.45}, {0, -.18}},
                   {{.36, -.1}, {0, .18}},
                   {{.6, -.1}, {0, -.18}}}});
    figure.remarks.push_back(
        "In the metric of a map, the map itself has μ = 0 and what is moved is spread evenly; `--metric vt` takes it "
        "from the texture "
        "coordinates of the mesh. Faces that are flipped there count by their edge lengths; where such a metric is far "
        "from flat it is mapped to the plane "
        "conformally first.");
    return figure;
}

Figure figure_19(Output& output) {
    Figure figure{"Figure 19: a ball with twelve holes",
                  "*The paper:* A ball with twelve pentagonal holes to a disk with round holes: the harmonic map has "
                  "more than 800 "
                  "flipped triangles, ARAP more than 600, the extremal map none."};
    figure.remarks.push_back(
        "The paper does not give its circles; ours are three rings of one, five and five. φ has a corner of the source "
        "at every corner "
        "of the pentagons; on a mesh with a quarter of the triangles, eight edges a side, the bracket of K* is 4.85 to "
        "5.11, ten times as wide. Ragged "
        "squares are the wrinkles of evening out, as in Figure 14.");
    const Problem problem = named_problem("pierced_ball", 0.0175);
    Comparison{output, figure, "figure_19", problem, problem.boundary, 30, 20, 24}.run(
        {"harmonic", "ARAP", "extremal"});
    return figure;
}

}  // namespace beltrami::gallery
