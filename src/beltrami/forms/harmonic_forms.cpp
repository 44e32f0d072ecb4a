#include <beltrami/forms/harmonic_forms.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>

#include <beltrami/base/error.h>
#include <beltrami/uniformize/flatten.h>

namespace beltrami::detail {

namespace {

constexpr double kFitTolerance = 1e-5;
constexpr int kMostFitSteps = 500;

std::vector<char> one_vertex_held(const Surface& source) {
    std::vector<char> held(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    held[source.topology.boundary_loops[0][0]] = 1;
    return held;
}

/// The points of the faces' corners: of the metric, or of the mesh itself (#corners×3).
Positions corner_points(const Surface& source) {
    const int count = source.mesh.faces.corner_count();
    Positions corners = Positions::Zero(count, 3);
    if (source.metric) {
        corners.leftCols(source.metric->cols()) = *source.metric;
    } else {
        for (int c = 0; c < count; ++c) corners.row(c) = source.mesh.point(source.mesh.faces.vertices()[c]);
    }
    return corners;
}

/// A conformal flattening (#V). Holes are filled by cones whose spokes are as long as the radius of a circle of the
/// hole's length.
Eigen::VectorXcd flattened(const Surface& source, Warnings& warnings) {
    Flattening flat;
    const auto& loops = source.topology.boundary_loops;
    if (loops.size() == 1 && !source.metric) {
        flat = flatten(source.mesh);
    } else {
        Mesh filled = source.mesh;
        filled.texture.reset();
        const int vertices = filled.vertex_count();
        filled.positions.conservativeResize(vertices + static_cast<int>(loops.size()) - 1, Eigen::NoChange);
        std::vector<std::array<double, 2>> cones;  // spoke and base of each new face
        for (std::size_t l = 1; l < loops.size(); ++l) {
            const int apex = vertices + static_cast<int>(l) - 1;
            filled.positions.row(apex) = filled.positions.row(loops[l][0]);
            double length = 0, longest = 0;
            for (const double edge : source.boundary_edge_lengths[l]) length += edge, longest = std::max(longest, edge);
            const double spoke = std::max(length / (2 * std::numbers::pi), 0.6 * longest);
            for (std::size_t i = 0; i < loops[l].size(); ++i) {
                filled.faces.add({loops[l][(i + 1) % loops[l].size()], loops[l][i], apex});
                cones.push_back({spoke, source.boundary_edge_lengths[l][i]});
            }
        }
        Positions corners = corner_points(source);
        Eigen::Index c = corners.rows();
        corners.conservativeResize(filled.faces.corner_count(), Eigen::NoChange);
        for (const auto& [spoke, base] : cones) {
            corners.row(c++).setZero();
            corners.row(c++) << base, 0, 0;
            corners.row(c++) << base / 2, std::sqrt(spoke * spoke - base * base / 4), 0;
        }
        flat = flatten(filled, corners);
        flat.positions.conservativeResize(vertices);
        std::erase_if(flat.flipped, [&](int f) { return f >= source.mesh.face_count(); });
    }
    if (!flat.flipped.empty())
        warnings.push_back({WarningKind::chart,
                            std::to_string(flat.flipped.size()) +
                                " faces are flipped in the flattening that the differential is written in",
                            {Things::faces, flat.flipped}});
    return flat.positions;
}

/// From the outer loop to a hole across faces and edges: what a function that jumps by 1 across this way has at the
/// corners of the faces on it, as the field Σ value · gradient at the samples.
class Ways {
  public:
    explicit Ways(const Surface& source) : source_(source), entered_(source.mesh.face_count(), -1) {
        // Breadth first over the faces; entered_ is the edge that a face was first reached by.
        const Topology& t = source.topology;
        std::vector<char> outer(source.mesh.vertex_count(), 0);
        for (const int v : t.boundary_loops[0]) outer[v] = 1;
        for (int e = 0; e < t.edge_count() && order_.empty(); ++e)
            if (is_boundary(e) && outer[t.edges[e][0]]) enter(std::max(t.edge_faces[e][0], t.edge_faces[e][1]), e);
        for (std::size_t next = 0; next < order_.size(); ++next) {
            const int f = order_[next];
            for (int c = source.mesh.faces.offsets()[f]; c < source.mesh.faces.offsets()[f + 1]; ++c)
                enter(across(f, t.corner_edges[c]), t.corner_edges[c]);
        }
    }

    Eigen::VectorXcd field_to(const std::vector<int>& hole) const {
        const Topology& t = source_.topology;
        const FaceList& faces = source_.mesh.faces;
        std::vector<char> wanted(source_.mesh.vertex_count(), 0);
        for (const int v : hole) wanted[v] = 1;
        int leave = -1, face = -1;
        for (const int f : order_) {
            for (int c = faces.offsets()[f]; c < faces.offsets()[f + 1] && leave < 0; ++c)
                if (is_boundary(t.corner_edges[c]) && wanted[faces.vertices()[c]]) leave = t.corner_edges[c], face = f;
            if (leave >= 0) break;
        }
        std::vector<std::array<int, 2>> doors(faces.size(), {-1, -1});  // corners where the way comes in and goes out
        while (face >= 0) {
            for (int c = faces.offsets()[face]; c < faces.offsets()[face + 1]; ++c) {
                if (t.corner_edges[c] == entered_[face]) doors[face][0] = c - faces.offsets()[face];
                if (t.corner_edges[c] == leave) doors[face][1] = c - faces.offsets()[face];
            }
            leave = entered_[face];
            face = across(face, leave);
        }
        const Operators& operators = source_.operators;
        Eigen::VectorXcd field = Eigen::VectorXcd::Zero(operators.sample_count());
        for (int s = 0; s < operators.sample_count(); ++s) {
            const auto [in, out] = doors[operators.faces[s]];
            if (in < 0) continue;
            const auto g = operators.gradient(s);
            for (int j = 0; j < static_cast<int>(g.size()); ++j)
                field[s] += static_cast<double>((j > in) - (j > out)) * g[j];
        }
        return field;
    }

  private:
    bool is_boundary(int e) const {
        return source_.topology.edge_faces[e][0] < 0 || source_.topology.edge_faces[e][1] < 0;
    }
    int across(int face, int edge) const {
        const auto [a, b] = source_.topology.edge_faces[edge];
        return a == face ? b : a;
    }
    void enter(int face, int edge) {
        if (face < 0 || entered_[face] >= 0) return;
        entered_[face] = edge;
        order_.push_back(face);
    }

    const Surface& source_;
    std::vector<int> entered_, order_;
};

double dot(const HarmonicForms::Form& a, const HarmonicForms::Form& b) {
    return a.potential.dot(b.potential) + a.periods.dot(b.periods);
}

void add(HarmonicForms::Form& to, double factor, const HarmonicForms::Form& form) {
    to.potential += factor * form.potential;
    to.periods += factor * form.periods;
}

}  // namespace

HarmonicForms::HarmonicForms(const Surface& source, Warnings& warnings)
    : operators_(source.operators),
      neumann_(source.operators, one_vertex_held(source), 10),
      dirichlet_(source.operators, source.topology.on_boundary) {
    if (source.topology.genus != 0)
        throw Error(Cause::bad_mesh,
                    "the surface has genus " + std::to_string(source.topology.genus) +
                        ", and its quadratic differentials are not squares of one coordinate's 1-forms",
                    "cut it open, or use another method");
    const int samples = operators_.sample_count();
    dz_ = Eigen::VectorXcd::Ones(samples);
    if (!source.in_plane()) {
        const Eigen::VectorXcd z = flattened(source, warnings);
        for (int s = 0; s < samples; ++s) dz_[s] = operators_.derivatives(s, z)[0];
    }

    const auto& loops = source.topology.boundary_loops;
    if (loops.size() > 1) {
        const Ways ways(source);
        for (std::size_t l = 1; l < loops.size(); ++l) hole_fields_.push_back(ways.field_to(loops[l]));
    }
    for (Eigen::VectorXcd& hole : hole_fields_) {
        // What a gradient can take away is taken away, so that holes and potentials are orthogonal.
        Eigen::VectorXcd flux(samples);
        for (int s = 0; s < samples; ++s) flux[s] = operators_.weights[s] * hole[s];
        const Eigen::VectorXd u = neumann_.solve(force(flux).potential);
        for (int s = 0; s < samples; ++s) hole[s] -= 2.0 * operators_.derivatives(s, u.cast<Complex>())[1];
    }
}

HarmonicForms::Form HarmonicForms::zero() const {
    return {Eigen::VectorXd::Zero(operators_.vertex_count), Eigen::VectorXd::Zero(hole_count())};
}

/// The vector field of the 1-form, a complex number per sample: conj(φ) in the coordinate z.
Eigen::VectorXcd HarmonicForms::field(const Form& form) const {
    const Eigen::VectorXcd u = form.potential.cast<Complex>();
    Eigen::VectorXcd result(operators_.sample_count());
    for (int s = 0; s < operators_.sample_count(); ++s) result[s] = 2.0 * operators_.derivatives(s, u)[1];
    for (int l = 0; l < hole_count(); ++l) result += form.periods[l] * hole_fields_[l];
    return result;
}

Eigen::VectorXcd HarmonicForms::values(const Form& form) const {
    return field(form).conjugate().cwiseProduct(dz_);
}

/// The adjoint of field(): Σ Re(conj(field) flux) as a linear function of the form.
HarmonicForms::Form HarmonicForms::force(const Eigen::VectorXcd& flux) const {
    Form result = zero();
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const auto stencil = operators_.stencil(s);
        const auto g = operators_.gradient(s);
        for (std::size_t j = 0; j < g.size(); ++j) result.potential[stencil[j]] += std::real(std::conj(g[j]) * flux[s]);
    }
    for (int l = 0; l < hole_count(); ++l) result.periods[l] = hole_fields_[l].dot(flux).real();
    return result;
}

Eigen::VectorXd HarmonicForms::laplacian(const Eigen::VectorXd& u) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(u.size());
    const Eigen::VectorXcd values = u.cast<Complex>();
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const Complex flux = 2 * operators_.weights[s] * operators_.derivatives(s, values)[1];
        const auto stencil = operators_.stencil(s);
        const auto g = operators_.gradient(s);
        for (std::size_t j = 0; j < g.size(); ++j) result[stencil[j]] += std::real(std::conj(g[j]) * flux);
    }
    return result;
}

/// From a linear function of harmonic forms to a harmonic form near the one it is the weighted product with. The
/// function is first read by boundary values alone, then those of the weighted problem are extended harmonically.
HarmonicForms::Form HarmonicForms::precondition(const Form& residual) const {
    Eigen::VectorXd reduced = residual.potential - laplacian(dirichlet_.solve(residual.potential));
    const Eigen::VectorXd weighted = neumann_.solve(reduced);
    return {weighted - dirichlet_.solve(laplacian(weighted)), hole_gram_inverse_ * residual.periods};
}

HarmonicForms::Form HarmonicForms::fit(const Eigen::VectorXd& weights, const Eigen::VectorXcd& pull,
                                       const Form& start) {
    // |φ|² = |field|² |dz|², Re(conj(pull) φ) = Re(conj(field) dz conj(pull)).
    const Eigen::VectorXcd scale = weights.cwiseProduct(dz_.cwiseAbs2()).cast<Complex>();
    std::vector<double> scales(scale.size());
    for (std::size_t s = 0; s < scales.size(); ++s) scales[s] = scale[s].real();
    neumann_.factorize(scales);
    Eigen::MatrixXd gram(hole_count(), hole_count());
    for (int l = 0; l < hole_count(); ++l)
        for (int m = 0; m < hole_count(); ++m)
            gram(l, m) = hole_fields_[l].dot(scale.cwiseProduct(hole_fields_[m])).real();
    hole_gram_inverse_ = gram.llt().solve(Eigen::MatrixXd::Identity(hole_count(), hole_count()));

    const Eigen::VectorXcd wanted = dz_.cwiseProduct(pull.conjugate());

    Form x = start;
    Form residual = force(wanted);
    const double size = dot(residual, precondition(residual));
    add(residual, -1, force(scale.cwiseProduct(field(x))));
    Form z = precondition(residual), direction = z;
    double square = dot(residual, z);
    for (int step = 0; step < kMostFitSteps && square > kFitTolerance * kFitTolerance * size; ++step) {
        const Form image = force(scale.cwiseProduct(field(direction)));
        const double curvature = dot(direction, image);
        if (!(curvature > 0)) break;
        const double alpha = square / curvature;
        add(x, alpha, direction);
        add(residual, -alpha, image);
        z = precondition(residual);
        const double before = std::exchange(square, dot(residual, z));
        add(z, square / before, direction);
        direction = z;
    }
    return x;
}

}  // namespace beltrami::detail
