// Tori: their flat metrics, and the extremal maps between them.
#include <cmath>
#include <numbers>

#include "gallery/sliding.h"

namespace beltrami::gallery {

namespace {

/// The parallel v = 0 and the meridian u = 0 of torus(); turned: the meridian that also goes once along the parallel.
struct Paths {
    std::vector<int> parallel, meridian, turned;

    Paths(int nu, int nv) {
        const auto at = [&](int i, int j) { return (i % nu) * nv + j % nv; };
        for (int i = 0; i < nu; ++i) parallel.push_back(at(i, 0));
        for (int j = 0; j < nv; ++j) meridian.push_back(at(0, j));
        // Along the parallel first, then round the tube, but for the vertex where both begin.
        turned = parallel;
        turned.push_back(at(0, 0));
        for (int j = 1; j < nv; ++j) turned.push_back(at(0, j));
    }
};

std::string complex_number(Complex z) {
    const double real = std::abs(z.real()) < 5e-6 ? 0.0 : z.real();  // no −0.00000
    return number(real, 5) + (z.imag() < 0 ? " − " : " + ") + number(std::abs(z.imag()), 5) + "i";
}

std::string order_of(double before, double error) {
    return before > 0 ? number(std::log2(before / error), 2) : "";
}

/// τ of tori of revolution against i√(R² − r²)/r.
Table periods_of_revolution() {
    Table table{"τ of tori of revolution, whose own is i√(R² − r²)/r or −1/τ, reduced",
                {"R, r", "faces", "τ", "error", "order", "error of this polyhedron's at most", "max abs(μ)", "flips"},
                {}};
    struct Shape {
        const char* name;
        double major, minor;
    };
    for (const Shape& s : {Shape{"2, 1", 2, 1}, Shape{"√2, 1", std::numbers::sqrt2, 1}, Shape{"4, 1.7", 4, 1.7}}) {
        double before = 0;
        for (const int nu : {16, 32, 64, 128}) {
            const Surface surface(torus(s.major, s.minor, nu, nu / 2));
            const FlatTorus flat = flat_torus(surface);
            const Complex exact(0, std::sqrt(s.major * s.major - s.minor * s.minor) / s.minor);
            const double error = std::abs(flat.tau - exact);
            table.rows.push_back({s.name, std::to_string(surface.mesh.face_count()), complex_number(flat.tau),
                                  scientific(error), order_of(before, error), scientific(flat.tau_error),
                                  number(flat.distortion.max), std::to_string(flat.distortion.flipped.size())});
            before = error;
        }
    }
    return table;
}

/// A map with the flat coordinates of the source drawn on both tori.
Picture picture_of(Output& output, const std::string& name, const std::string& caption, const Surface& source,
                   const FlatTorus& flat, const TorusMap& map) {
    const auto [from, to] = output.write_cut(name, source.mesh, flat.layout, map.positions, map.distortion.face_abs_mu);
    return {name,
            caption,
            {faces_panel(from, "the source, cut open and flat"), surface_panel(from, "source", "checker", 30, 45),
             surface_panel(to, "its image", "checker", 30, 45),
             histogram_panel({{"", from}}, "|μ| of the source's faces", map.k, 1)}};
}

/// (2, 1) → (√2, 1) in two markings.
void add_pairs(Output& output, Figure& figure) {
    Table table{
        "(R, r) = (2, 1) onto (√2, 1), other meshes, in two markings; the second sends the meridian to meridian + "
        "parallel. Faces: K of the source's faces on the flat target, where the map is affine; flips there / of the "
        "triangles between the vertices' places in space",
        {"marking", "source", "target", "K", "exact", "error", "order", "bracket", "mean", "std", "max", "flips"},
        {}};
    const std::array<double, 2> exact{std::numbers::sqrt3, 3.776668};
    std::array<double, 2> before{};
    for (const int k : {4, 8, 16, 32}) {
        const Surface source(torus(2, 1, 4 * k, 2 * k)), target(torus(std::numbers::sqrt2, 1, 5 * k, 4 * k));
        const FlatTorus flat_source = flat_torus(source), flat_target = flat_torus(target);
        const Paths there(4 * k, 2 * k), here(5 * k, 4 * k);
        for (std::size_t m = 0; m < 2; ++m) {
            TorusMapOptions options;
            options.marking = marking_of_paths(source, flat_source, {there.parallel, there.meridian}, target,
                                               flat_target, {here.parallel, m == 0 ? here.meridian : here.turned});
            const TorusMap map = torus_map(source, flat_source, target, flat_target, options);
            const double error = std::abs(map.K - exact[m]);
            Eigen::VectorXd K = map.distortion.face_abs_mu.unaryExpr([](double mu) { return dilatation(mu); });
            const double mean = K.mean(), spread = std::sqrt((K.array() - mean).square().mean());
            table.rows.push_back(
                {m == 0 ? "natural" : "twisted", std::to_string(source.mesh.face_count()),
                 std::to_string(target.mesh.face_count()), number(map.K), number(exact[m]), scientific(error),
                 order_of(before[m], error), number(map.K_lower) + "–" + number(map.K_upper), number(mean, 3),
                 number(spread, 3), number(K.maxCoeff(), 3),
                 std::to_string(map.distortion.flipped.size()) + " / " + std::to_string(map.in_space.flipped.size())});
            before[m] = error;
            if (k == 16)
                figure.pictures.push_back(picture_of(
                    output, m == 0 ? "tori_natural" : "tori_twisted",
                    m == 0 ? "The natural marking, K = √3." : "The meridian goes once along the parallel as well.",
                    source, flat_source, map));
        }
    }
    figure.tables.push_back(std::move(table));
}

}  // namespace

Figure tori(Output& output) {
    Figure figure{"Tori", "Flat metrics of tori and the affine maps between them ([tori](tori.md))."};
    figure.tables.push_back(periods_of_revolution());
    add_pairs(output, figure);
    if (const auto path = scan_path("torus.obj")) {
        const Surface surface(read_mesh(*path).mesh);
        const FlatTorus flat = flat_torus(surface);
        figure.remarks.push_back("torus.obj (" + std::to_string(surface.mesh.face_count()) +
                                 " faces): τ = " + complex_number(flat.tau) + ", " + std::to_string(flat.flips) +
                                 " edges flipped to intrinsic Delaunay, mean abs(μ) " + number(flat.distortion.mean) +
                                 ", largest " + number(flat.distortion.max) + ", " +
                                 std::to_string(flat.distortion.flipped.size()) + " faces drawn flipped.");
    }
    return figure;
}

}  // namespace beltrami::gallery
