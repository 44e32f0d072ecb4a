// What Teichmüller maps look like nearby: 1 and 4 (drawn from closed forms), 5, 6.
#include "gallery/gallery.h"

#include <beltrami/base/constants.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/uniformize/flatten.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace beltrami::gallery {

namespace {

using Chain = std::vector<Complex>;
using PlaneFunction = std::function<Complex(Complex)>;

std::vector<Chain> mapped(const std::vector<Chain>& lines, const PlaneFunction& f) {
    std::vector<Chain> result = lines;
    for (Chain& line : result)
        for (Complex& p : line) p = f(p);
    return result;
}

Chain circle(Complex centre, double radius) {
    Chain line;
    for (int i = 0; i <= 120; ++i) line.push_back(centre + std::polar(radius, 2 * kPi * i / 120));
    return line;
}

/// Lines Re z or Im z = const of the unit disk, and small circles.
struct DiskLines {
    std::vector<Chain> across, along, circles, rim{circle(0, 1)};
};
DiskLines disk_lines() {
    DiskLines lines;
    for (int i = -4; i <= 4; ++i) {
        const double c = 0.2 * i, end = std::sqrt(1 - c * c);
        Chain across, along;
        for (int j = -40; j <= 40; ++j) across.emplace_back(end * j / 40, c), along.emplace_back(c, end * j / 40);
        lines.across.push_back(across);
        lines.along.push_back(along);
    }
    for (const Complex c : {Complex(0, 0), Complex(0.6, 0), Complex(-0.6, 0), Complex(0, 0.6), Complex(0, -0.6)})
        lines.circles.push_back(circle(c, 0.12));
    return lines;
}

nlohmann::json composition_panel(const DiskLines& lines, const std::string& title, const PlaneFunction& f) {
    return lines_panel({{"0.7", 0.6, mapped(lines.across, f)},
                        {"0.7", 0.6, mapped(lines.along, f)},
                        {"k", 1, mapped(lines.rim, f)},
                        {"C0", 1.6, mapped(lines.circles, f)}},
                       title);
}

/// φ at the vertices of a planar mesh, times a factor that takes its pole away: means of the samples around.
class InterpolatedPhi {
  public:
    /// @param pole divide by z where φ has a simple pole at 0
    InterpolatedPhi(const Surface& surface, const Eigen::VectorXcd& phi, bool pole)
        : locator_(surface.mesh), pole_(pole), values_(Eigen::VectorXcd::Zero(surface.mesh.vertex_count())) {
        const Eigen::VectorXcd z = planar_coordinates(surface.mesh);
        Eigen::VectorXd weights = Eigen::VectorXd::Zero(z.size());
        for (int s = 0; s < surface.operators.sample_count(); ++s) {
            Complex centre = 0;
            for (const int v : surface.operators.stencil(s)) centre += z[v] / 3.0;
            for (const int v : surface.operators.stencil(s)) {
                values_[v] += surface.operators.weights[s] * phi[s] * (pole ? centre : Complex(1));
                weights[v] += surface.operators.weights[s];
            }
        }
        values_.array() /= weights.array();
    }
    Complex operator()(Complex z) const {
        const Complex value = locator_.nearest(z).interpolate(values_);
        return pole_ ? value / z : value;
    }

  private:
    PlanarLocator locator_;
    bool pole_;
    Eigen::VectorXcd values_;
};

/// The trajectory through a point, along which φ dz² is positive (negative: a vertical one), within a disk.
Chain trajectory(const InterpolatedPhi& phi, Complex start, bool vertical, double radius) {
    constexpr double step = 0.004;
    Chain whole;
    for (const double sign : {-1.0, 1.0}) {
        Chain half;
        Complex z = start, last = sign * std::conj(std::sqrt(phi(start))) * (vertical ? Complex(0, 1) : Complex(1));
        for (int i = 0; i < 2000 && std::abs(z) < radius; ++i) {
            const auto direction = [&](Complex at) {
                Complex d = std::conj(std::sqrt(phi(at)));
                if (vertical) d *= Complex(0, 1);
                d /= std::abs(d);
                return std::real(std::conj(last) * d) < 0 ? -d : d;
            };
            const Complex first = direction(z), d = direction(z + 0.5 * step * first);
            // At a zero or a pole directions jump.
            if (i > 0 && std::real(std::conj(last) * d) < 0.3) break;
            z += step * d;
            last = d;
            half.push_back(z);
        }
        if (sign < 0) {
            std::reverse(half.begin(), half.end());
            half.push_back(start);
        }
        whole.insert(whole.end(), half.begin(), half.end());
    }
    return whole;
}

/// Both families of trajectories around 0 on the source and on the image, black what ends at 0.
void add_trajectories(Picture& picture, const std::string& name, const Surface& surface, const Solved& solved,
                      bool pole) {
    constexpr double radius = 0.5;
    const InterpolatedPhi phi(surface, solved.all->phi, pole);
    const PlanarLocator locator(surface.mesh);
    const PlaneFunction f = [&](Complex z) { return locator.nearest(z).interpolate(solved.map); };
    std::vector<Lines> groups{{"C0", 0.8, {}}, {"C1", 0.8, {}}};
    for (const bool vertical : {false, true}) {
        std::vector<Chain>& lines = groups[vertical ? 1 : 0].lines;
        // Seeds on rays where trajectories of the other family come from 0, so that they are spread.
        for (int ray = 0; ray < 12; ++ray)
            for (int i = 1; i <= 6; ++i) {
                const Complex seed = std::polar(radius * std::pow(i / 6.5, pole ? 2.0 : 0.7), 2 * kPi * ray / 12);
                bool near = false;
                for (const Chain& line : lines)
                    for (const Complex p : line) near = near || std::abs(p - seed) < 0.035 + 0.05 * std::abs(seed);
                if (!near) lines.push_back(trajectory(phi, seed, vertical, radius));
            }
    }
    std::vector<Lines> images = groups;
    for (Lines& group : images) group.lines = mapped(group.lines, f);
    groups.push_back({"k", 1, {circle(0, radius)}});
    images.push_back({"k", 1, mapped({circle(0, radius)}, f)});
    picture.panels.push_back(lines_panel(groups, name + ", source", {{0, "●"}}));
    picture.panels.push_back(lines_panel(images, name + ", image", {{f(0), "●"}}));
}

}  // namespace

Figure figure_01(Output&) {
    Figure figure{"Figures 1 and 4: what μ means, and what a Teichmüller map is",
                  "*The paper:* A small circle becomes an ellipse with axes 1 + |μ| and 1 − |μ|, the long one at the "
                  "angle arg(μ)/2 before "
                  "the map turns it (Fig. 1). A Teichmüller map is conformal, then affine, then conformal again: h ∘ "
                  "A_k ∘ g (Fig. 4)."};
    const Complex mu = std::polar(0.5, 1.2);
    const Complex along = std::polar(1 + std::abs(mu), std::arg(mu) / 2),
                  across = Complex(0, 1) * std::polar(1 - std::abs(mu), std::arg(mu) / 2);
    figure.pictures.push_back(
        {"figure_01",
         "The circle |z| = 1 and its image under z + μ z̄, |μ| = .5, arg μ = 1.2: axes of 1.5 and .5 at the angle .6.",
         {lines_panel(
             {{"k", 1, {circle(0, 1)}},
              {"C0", 1.6, {mapped({circle(0, 1)}, [&](Complex z) { return z + mu * std::conj(z); })[0]}},
              {"C1", 1, {{-along, along}}},
              {"C2", 1, {{-across, across}}}},
             "circle and ellipse",
             {{0.6 * along + Complex(0.15, -0.12), "1 + |μ|"}, {1.15 * across + Complex(0.3, 0.05), "1 − |μ|"}})}});
    const DiskLines lines = disk_lines();
    const PlaneFunction g = [](Complex z) { return z + 0.3 * z * z; },
                        affine = [&](Complex z) { return g(z) + 0.5 * std::conj(g(z)); },
                        all = [&](Complex z) { return std::exp(0.6 * affine(z)); };
    figure.pictures.push_back(
        {"figure_04",
         "The exact composition of Figure 7, k = ½: z, g(z) = z + .3z², g + ½ conj(g), exp(.6 ·).",
         {composition_panel(lines, "z", [](Complex z) { return z; }), composition_panel(lines, "g: conformal", g),
          composition_panel(lines, "A_k: affine", affine), composition_panel(lines, "h: conformal", all)}});
    return figure;
}

Figure figure_05(Output&) {
    Figure figure{
        "Figure 5: a zero and a pole",
        "*The paper:* The directions of stretch change rapidly near zeros and poles of the quadratic differential."};
    Table table{"The unit disk to itself", usual_head("boundary values"), {}};
    Picture picture{
        "figure_05",
        "Trajectories of φ around a zero and around a pole, and their images: along the blue lines the map stretches "
        "by 1 + k, along the orange "
        "ones by 1 − k, up to a common factor. Three of each kind meet at the zero, one of each at the pole.",
        {}};
    DomainOptions domain;
    domain.edge_length = 0.03;
    domain.sources = {{Eigen::Vector2d::Zero(), 0.004}};
    domain.interior_points = {Eigen::Vector2d::Zero()};
    const Surface surface(circle_domain({}, {}, domain));
    const Eigen::VectorXcd z = planar_coordinates(surface.mesh);
    for (const bool pole : {false, true}) {
        BoundaryCondition boundary;
        for (const int v : surface.topology.boundary_loops[0]) {
            const double t = std::arg(z[v]);
            boundary.pin(v, std::polar(1.0, pole ? t : t + 0.25 * std::sin(3 * t)));
        }
        if (pole) boundary.pin(0, 0.35);
        const Solved solved = solve(surface, boundary, "extremal");
        table.rows.push_back(usual_row(pole ? "fixed, the centre pinned to .35" : "e^{i(t + .25 sin 3t)}", solved));
        if (solved) add_trajectories(picture, pole ? "pole" : "zero", surface, solved, pole);
    }
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back(std::move(picture));
    return figure;
}

Figure figure_06(Output& output) {
    Figure figure{"Figure 6: |μ| of a discrete conformal map",
                  "*The paper:* Even a conformal map of high quality (conformal equivalence) has |μ| far from zero on "
                  "many triangles: no piecewise linear map is "
                  "perfectly even."};
    Table table{
        "By `flatten`, the boundary keeping its lengths",
        {"surface", "triangles", "mean abs(μ)", "std", "p99", "max", "flips", "triangles with abs(μ) > .02", "> .1"},
        {}};
    std::vector<std::pair<std::string, Mesh>> surfaces;
    Mesh hills = rectangle(2, 2, 70, 70);
    Mesh lifted;
    lifted.faces = hills.faces;
    lifted.positions.resize(hills.vertex_count(), 3);
    for (int v = 0; v < hills.vertex_count(); ++v) {
        const double x = hills.positions(v, 0) - 1, y = hills.positions(v, 1) - 1;
        lifted.positions.row(v) << x, y,
            0.5 * std::exp(-6 * ((x - .25) * (x - .25) + (y - .2) * (y - .2))) + 0.15 * std::sin(3 * x + y);
    }
    surfaces.emplace_back("hilly square", std::move(lifted));
    if (const char* folder = std::getenv("BELTRAMI_MESHES");
        folder && std::filesystem::exists(std::filesystem::path(folder) / "human_face.obj"))
        surfaces.emplace_back("human_face", read_mesh(std::filesystem::path(folder) / "human_face.obj").mesh);
    Picture picture{
        "figure_06", "A checkerboard of the plane by the conformal map, and |μ|, every triangle counted alike.", {}};
    for (const auto& [name, mesh] : surfaces) {
        const Surface surface(mesh);
        const Solved solved = solve_with(surface, name, [&] { return flatten(mesh).positions; });
        if (!solved) continue;
        const Distortion& d = solved.distortion;
        const auto above = [&](double limit) {
            return number(100.0 * static_cast<double>((d.face_abs_mu.array() > limit).count()) / mesh.face_count(), 1) +
                   " %";
        };
        table.rows.push_back({name, std::to_string(mesh.face_count()), number(d.mean), number(d.standard_deviation),
                              number(d.p99), number(d.max, 3), std::to_string(d.flipped.size()), above(0.02),
                              above(0.1)});
        const std::string data = output.write("figure_06_" + name, surface, solved);
        const bool face = name == "human_face";
        picture.panels.push_back(surface_panel(data, name, "checker", face ? -90 : -60, face ? 84 : 50, 24));
        picture.panels.push_back(histogram_panel({{"", data}}, "", {}, 0.1, "triangles"));
    }
    figure.tables.push_back(std::move(table));
    figure.pictures.push_back(std::move(picture));
    return figure;
}

}  // namespace beltrami::gallery
