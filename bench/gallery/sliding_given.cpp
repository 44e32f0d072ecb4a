// What an extremal map is: beside general quasiconformal maps (Fig. 1), beside the extremal maps of given boundary
// values (Fig. 2), and how |μ| becomes even (Fig. 3).
#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/mesh/planar.h>

#include "gallery/sliding.h"

namespace beltrami::gallery {

namespace {

/// Boundary values that nobody has chosen well: every circle to its partner, angle t to t + a sin(t + b) + c.
BoundaryCondition uneven_boundary(const Surface& source, const std::vector<Hole>& from, const std::vector<Hole>& to) {
    struct Speed {
        double a, b, c;
    };
    const std::vector<Speed> speeds{{0.5, 0.4, 0}, {0.4, 2, 0.3}, {-0.5, 0, -0.2}, {0.3, 1, 0.4}};
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    BoundaryCondition boundary;
    for (std::size_t l = 0; l < source.topology.boundary_loops.size(); ++l) {
        const Hole a = l ? from[l - 1] : Hole{0, 0, 1}, b = l ? to[l - 1] : Hole{0, 0, 1};
        for (const int v : source.topology.boundary_loops[l]) {
            const double t = std::arg(z[v] - Complex(a[0], a[1]));
            boundary.pin(
                v, Complex(b[0], b[1]) + std::polar(b[2], t + speeds[l].a * std::sin(t + speeds[l].b) + speeds[l].c));
        }
    }
    return boundary;
}

/// Mean |μ| of the faces that the circle |z| = radius crosses, by sectors of their barycentres.
Curve around_circle(const std::string& label, const Surface& source, const Eigen::VectorXd& face_abs_mu,
                    double radius) {
    constexpr int sectors = 60;
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    std::vector<double> sums(sectors, 0), counts(sectors, 0);
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        Complex centre = 0;
        bool inside = false, outside = false;
        for (const int v : source.mesh.faces[f]) {
            centre += z[v] / 3.0;
            (std::abs(z[v]) < radius ? inside : outside) = true;
        }
        if (!inside || !outside) continue;
        const int sector = std::min(sectors - 1, static_cast<int>((std::arg(centre) + kPi) / (2 * kPi) * sectors));
        sums[sector] += std::min(1.0, face_abs_mu[f]);
        counts[sector] += 1;
    }
    Curve curve{label, {}, {}};
    for (int s = 0; s < sectors; ++s)
        if (counts[s] > 0) {
            curve.x.push_back(2 * kPi * (s + 0.5) / sectors - kPi);
            curve.y.push_back(sums[s] / counts[s]);
        }
    return curve;
}

/// |μ| on the circle after 0, 1, 2, 3 and all iterations.
nlohmann::json course_on_circle(Table& table, const std::string& title, const Surface& source, const Constraints& onto,
                                ExtremalOptions options) {
    constexpr double radius = 0.65;
    options.remove_folds = false;
    options.coarse_start = false;
    std::vector<Curve> curves;
    const auto add = [&](const std::string& label, const Eigen::VectorXd& face_abs_mu) {
        curves.push_back(around_circle(label, source, face_abs_mu, radius));
        const auto [least, largest] = std::minmax_element(curves.back().y.begin(), curves.back().y.end());
        table.rows.push_back({title, label, number(*least, 3), number(*largest, 3)});
    };
    for (const int n : {1, 2, 3, 90}) {
        options.max_iterations = n;
        const SolvedOnto solved = solve_onto(source, onto, options);
        if (!solved) continue;
        if (n == 1) add("start", distortion(source.operators, solved.all->start).face_abs_mu);
        add(n == 90 ? "all (" + std::to_string(solved.all->iterations) + ")"
                    : std::to_string(n) + (n == 1 ? " iteration" : " iterations"),
            solved.all->distortion.face_abs_mu);
    }
    return curves_panel(curves, title, "angle", "|μ|", false);
}

}  // namespace

Figure sliding_given(Output& output) {
    Figure figure{"Figures 1 to 3: general, given and extremal maps",
                  "*The paper:* The ellipses of a general quasiconformal map differ, those of a Teichmüller map are "
                  "all of one shape (Fig. 1). For every "
                  "boundary correspondence there is a Teichmüller map (.58 in Fig. 2); the extremal one is the least "
                  "of them (.11). During the "
                  "iteration |μ| on |z| = .65 becomes constant, at once from a good start (Fig. 3)."};
    const std::vector<Hole> from{{0, 0.45, 0.16}, {-0.4, -0.3, 0.16}, {0.4, -0.3, 0.16}},
        to{{0, 0.5, 0.2}, {-0.45, -0.25, 0.17}, {0.4, -0.35, 0.14}};
    const Surface source(disk_with_holes(from, 0.02));
    const BoundaryCondition given = uneven_boundary(source, from, to);
    Table table{
        "The unit disk less holes of radius .16 to one with holes of radius .20, .17, .14; \"given\" boundary values "
        "run unevenly. h = .02",
        usual_head("map"),
        {}};
    const Solved harmonic = solve(source, given, "harmonic"), prescribed = solve(source, given, "extremal");
    table.rows.push_back(usual_row("harmonic, boundary given", harmonic));
    table.rows.push_back(usual_row("extremal, boundary given", prescribed));
    const SolvedOnto sliding = solve_onto(source, {circles_target(to), numbered(3)});
    if (sliding) {
        Solved row;
        row.map = sliding.all->map;
        row.distortion = sliding.all->distortion;
        row.k = sliding.all->k, row.K = sliding.all->K, row.K_lower = sliding.all->K_lower;
        row.iterations = sliding.all->iterations;
        row.seconds = sliding.seconds;
        table.rows.push_back(usual_row("extremal, boundary sliding", row));
    }
    figure.tables.push_back(std::move(table));
    if (!harmonic || !prescribed || !sliding) return figure;
    const std::string general = output.write("sliding_given_harmonic", source, harmonic),
                      even = output.write("sliding_given_extremal", source, prescribed),
                      best = write(output, "sliding_given_sliding", source, sliding);
    figure.pictures.push_back(
        {"sliding_given",
         "Small circles of the source, their images by the harmonic map of given boundary values, by the "
         "extremal map of the same values, and by the extremal map whose boundary slides; |μ| of the three.",
         {circles_panel(general, "source", "source", 24), circles_panel(general, "harmonic", "image", 24),
          circles_panel(even, "extremal, given", "image", 24), circles_panel(best, "extremal, sliding", "image", 24),
          histogram_panel({{"harmonic", general}, {"extremal, given", even}, {"extremal, sliding", best}}, "", {},
                          0.8)}});

    // Their Fig. 3, on Example 4.
    const Surface example(disk_with_holes({{0, 0.33, 0.1}, {0.33, -0.33, 0.067}, {-0.33, -0.33, 0.133}}, 0.02));
    const Constraints onto{circles_target({{0, 0.6, 0.1}, {0.7, -0.3, 0.1}, {-0.7, -0.3, 0.1}}), numbered(3)};
    ExtremalOptions turned;
    turned.start_turns = {0, 2, -2, 1.5};
    Table circle{"Example 4, |μ| on |z| = .65 (means of the faces there in 60 sectors)",
                 {"start", "after", "least", "largest"},
                 {}};
    figure.pictures.push_back({"sliding_given_circle",
                               "|μ| on |z| = .65 after some iterations, from circles that begin evenly and from holes "
                               "turned by 2, −2 and 1.5 rad.",
                               {course_on_circle(circle, "even start", example, onto, {}),
                                course_on_circle(circle, "holes turned", example, onto, turned)}});
    figure.tables.push_back(std::move(circle));
    return figure;
}

}  // namespace beltrami::gallery
