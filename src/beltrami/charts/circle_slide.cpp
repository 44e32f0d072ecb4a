#include <beltrami/charts/circle_slide.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/charts/circle_rims.h>

namespace beltrami {

namespace {

constexpr double kMostNegative = 0.4;  // curvature of a circle, half the diagonal of the rest on an even rim
constexpr double kRounding = 1e-15;    // of energies, which are at most about 3
constexpr double kFirstGap = 0.05;     // circles are first made smaller until they have it
constexpr double kKeptGap = 0.3;       // part of the least gap that a step leaves
constexpr double kKeptRadius = 0.3;    // and of a radius
constexpr double kArmijo = 1e-4;
constexpr int kMostHalvings = 12;
constexpr int kMostProducts = 150;  // of one step
constexpr int kDenseRim = 1500;     // vertices; longer rims share the kernel of so many places

/// The inverse of the Dirichlet-to-Neumann map of a circle, for nodal values and integrated fluxes: −log|2 sin(Δ/2)|/π,
/// and a constant for the mean. The diagonal is chosen so that the smallest eigenvalue on even places is that of
/// the wave of two edges.
class CircleKernel {
  public:
    explicit CircleKernel(const CircleRim& rim) {
        const int n = rim.size();
        const int places = std::min(n, kDenseRim);
        group_.resize(n);
        std::vector<double> angles(places);
        for (int i = 0; i < n; ++i) group_[i] = static_cast<int>(static_cast<long>(i) * places / n);
        for (int i = n - 1; i >= 0; --i) angles[group_[i]] = rim.angles[i];
        spacing_.resize(n);
        for (int i = 0; i < n; ++i) spacing_[i] = 0.5 * (rim.increment(i) + rim.increment((i + n - 1) % n));
        kernel_.resize(places, places);
        for (int i = 0; i < places; ++i)
            for (int j = 0; j <= i; ++j)
                kernel_(i, j) = kernel_(j, i) =
                    i == j ? 0.0 : 1 - std::log(std::max(2 * std::abs(std::sin((angles[i] - angles[j]) / 2)), 1e-12));
    }

    double diagonal(int i) const { return (kDiagonal - std::log(spacing_[i])) / kPi; }

    Eigen::VectorXd operator*(const Eigen::VectorXd& load) const {
        Eigen::VectorXd grouped = Eigen::VectorXd::Zero(kernel_.rows());
        for (Eigen::Index i = 0; i < load.size(); ++i) grouped[group_[i]] += load[i];
        const Eigen::VectorXd smooth = kernel_ * grouped;
        Eigen::VectorXd value(load.size());
        for (Eigen::Index i = 0; i < load.size(); ++i)
            value[i] = smooth[group_[i]] / kPi + diagonal(static_cast<int>(i)) * load[i];
        return value;
    }

  private:
    static constexpr double kDiagonal = 2.45;
    std::vector<int> group_;
    std::vector<double> spacing_;
    Eigen::MatrixXd kernel_;
};

/// The energy as a function of the rims, with its derivatives: by arc length along the circles, then by centre and
/// radius of every hole.
class RimEnergy {
  public:
    RimEnergy(const Surface& surface, const BeltramiSolver& dirichlet, const std::vector<CircleRim>& rims)
        : operators_(surface.operators), dirichlet_(dirichlet), slot_(surface.mesh.vertex_count(), -1) {
        for (const CircleRim& rim : rims)
            for (int i = 0; i < rim.size(); ++i) slot_[rim.vertices[i]] = rim.first + i;
        rim_vertices_ = rims.back().first + rims.back().size();
        for (int s = 0; s < operators_.sample_count(); ++s)
            for (const int v : operators_.stencil(s))
                if (slot_[v] >= 0) {
                    samples_.push_back(s);
                    break;
                }
    }

    int rim_vertices() const { return rim_vertices_; }
    int products() const { return products_; }

    /// The derivative of Σ A|∂̄f|² by the rim vertices, f given inside too.
    Eigen::VectorXcd force(const Eigen::VectorXcd& f) const {
        Eigen::VectorXcd force = Eigen::VectorXcd::Zero(rim_vertices_);
        for (const int s : samples_) {
            const Complex pull = operators_.weights[s] * operators_.derivatives(s, f)[1];
            const auto stencil = operators_.stencil(s);
            const auto gradient = operators_.gradient(s);
            for (std::size_t j = 0; j < stencil.size(); ++j)
                if (slot_[stencil[j]] >= 0) force[slot_[stencil[j]]] += std::conj(gradient[j]) * pull;
        }
        return force;
    }

    Eigen::VectorXcd extended(const Eigen::VectorXcd& boundary) const {
        ++products_;
        return dirichlet_.solve(boundary);
    }

    double energy(const std::vector<CircleRim>& rims, const Eigen::VectorXcd& force) const {
        double sum = 0;
        for (const CircleRim& rim : rims)
            for (int i = 0; i < rim.size(); ++i) sum += std::real(std::conj(rim.position(i)) * force[rim.first + i]);
        return sum / 2;
    }

  private:
    const Operators& operators_;
    const BeltramiSolver& dirichlet_;
    std::vector<int> slot_;     // #V place among the rim vertices, −1 inside
    std::vector<int> samples_;  // those with a rim vertex
    int rim_vertices_ = 0;
    mutable int products_ = 0;
};

/// Tangential part of rim forces, and their sums for every hole: the derivative of the energy.
Eigen::VectorXd pulled_back(const std::vector<CircleRim>& rims, const Eigen::VectorXcd& force, int unknowns) {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(unknowns);
    const int circles = static_cast<int>(force.size());
    for (const CircleRim& rim : rims)
        for (int i = 0; i < rim.size(); ++i) {
            const Complex pull = std::conj(rim.direction(i)) * force[rim.first + i];
            result[rim.first + i] = pull.imag();
            if (rim.hole < 0) continue;
            double* of_hole = result.data() + circles + 3L * rim.hole;
            of_hole[0] += force[rim.first + i].real();
            of_hole[1] += force[rim.first + i].imag();
            of_hole[2] += pull.real();
        }
    project(rims, result);
    return result;
}

/// The motion of the rim vertices for given unknowns, to first order.
Eigen::VectorXcd pushed_forward(const std::vector<CircleRim>& rims, const Eigen::VectorXd& unknowns, int circles,
                                Eigen::Index vertices) {
    Eigen::VectorXcd motion = Eigen::VectorXcd::Zero(vertices);
    for (const CircleRim& rim : rims)
        for (int i = 0; i < rim.size(); ++i) {
            Complex& m = motion[rim.vertices[i]];
            m = Complex(0, unknowns[rim.first + i]) * rim.direction(i);
            if (rim.hole < 0) continue;
            const double* of_hole = unknowns.data() + circles + 3L * rim.hole;
            m += Complex(of_hole[0], of_hole[1]) + of_hole[2] * rim.direction(i);
        }
    return motion;
}

struct NewtonSystem {
    const std::vector<CircleRim>& rims;
    const RimEnergy& energy;
    const std::vector<CircleKernel>& kernels;
    Eigen::VectorXd curvature;  // of the circles, for every rim vertex
    Eigen::Index vertices;

    Eigen::VectorXd apply(const Eigen::VectorXd& p) const {
        const int circles = energy.rim_vertices();
        const Eigen::VectorXcd motion = pushed_forward(rims, p, circles, vertices);
        Eigen::VectorXd result = pulled_back(rims, energy.force(energy.extended(motion)), static_cast<int>(p.size()));
        result.head(circles) += curvature.cwiseProduct(p.head(circles));
        project(rims, result);
        return result;
    }

    Eigen::VectorXd precondition(const Eigen::VectorXd& r) const {
        Eigen::VectorXd result = r;
        // The energy is a quarter of ∫|∇f|² less half the area.
        for (std::size_t l = 0; l < rims.size(); ++l)
            result.segment(rims[l].first, rims[l].size()) = 2 * (kernels[l] * r.segment(rims[l].first, rims[l].size()));
        project(rims, result);
        return result;
    }

    /// The Newton step to the relative accuracy @p accuracy; less where the energy is not convex.
    Eigen::VectorXd solve(const Eigen::VectorXd& gradient, double accuracy) const {
        Eigen::VectorXd x = Eigen::VectorXd::Zero(gradient.size()), r = -gradient, z = precondition(r), p = z;
        double rz = r.dot(z);
        const double wanted = accuracy * accuracy * rz;
        for (int i = 0; i < kMostProducts && rz > wanted && rz > 0; ++i) {
            const Eigen::VectorXd q = apply(p);
            const double curved = p.dot(q);
            if (!(curved > 0)) return i == 0 ? p : x;
            const double step = rz / curved;
            x += step * p;
            r -= step * q;
            z = precondition(r);
            const double next = r.dot(z);
            p = z + next / rz * p;
            rz = next;
        }
        return x;
    }
};

}  // namespace

CircleSlide put_on_circles(const Surface& surface, const BeltramiSolver& dirichlet, int outer_loop,
                           const Eigen::VectorXcd& vertices, std::vector<RoundHole> holes) {
    for (int i = 0; i < 200 && least_gap(holes) < kFirstGap; ++i)
        for (RoundHole& hole : holes) hole.radius *= 0.95;
    std::vector<CircleRim> rims = rims_of(surface, outer_loop, holes);
    Eigen::VectorXcd correction = Eigen::VectorXcd::Zero(vertices.size());
    for (CircleRim& rim : rims) {
        choose_angles(rim, vertices);
        for (int i = 0; i < rim.size(); ++i) correction[rim.vertices[i]] = rim.position(i) - vertices[rim.vertices[i]];
    }
    CircleSlide result;
    result.vertices = vertices;
    const Eigen::VectorXcd inside = dirichlet.solve(correction);
    for (const int v : surface.mesh.faces.vertices())
        if (!surface.topology.on_boundary[v]) result.vertices[v] = vertices[v] + inside[v];
    for (const CircleRim& rim : rims)
        for (int i = 0; i < rim.size(); ++i) result.vertices[rim.vertices[i]] = rim.position(i);
    for (CircleRim& rim : rims) result.least_increments.push_back(std::move(rim.least));
    result.holes = holes_of(rims, outer_loop);
    result.products = 1;
    return result;
}

void slide_on_circles(const Surface& surface, const BeltramiSolver& dirichlet, int outer_loop, CircleSlide& map,
                      const CircleSlideOptions& options) {
    const Eigen::Index vertices = map.vertices.size();
    std::vector<CircleRim> rims = rims_of(surface, outer_loop, map.holes);
    for (std::size_t l = 0; l < rims.size(); ++l) {
        read_angles(rims[l], map.vertices);
        rims[l].least = map.least_increments[l];
    }
    hold_three(rims[outer_loop]);
    const RimEnergy rim_energy(surface, dirichlet, rims);
    std::vector<CircleKernel> kernels;
    kernels.reserve(rims.size());
    for (const CircleRim& rim : rims) kernels.emplace_back(rim);
    const int circles = rim_energy.rim_vertices(), unknowns = circles + 3 * static_cast<int>(map.holes.size());

    Eigen::VectorXcd f = rim_energy.extended(rim_positions(rims, vertices)), force = rim_energy.force(f);
    map.energy = rim_energy.energy(rims, force);
    double first_gradient = 0;
    for (map.steps = 0; map.steps < options.max_steps && !map.converged; ++map.steps) {
        NewtonSystem system{rims, rim_energy, kernels, Eigen::VectorXd::Zero(circles), vertices};
        for (std::size_t l = 0; l < rims.size(); ++l)
            for (int i = 0; i < rims[l].size(); ++i) {
                const double bend =
                    -std::real(std::conj(force[rims[l].first + i]) * rims[l].direction(i)) / rims[l].radius;
                system.curvature[rims[l].first + i] = std::max(bend, -kMostNegative);
            }
        const Eigen::VectorXd gradient = pulled_back(rims, force, unknowns);
        const double norm = std::sqrt(std::max(0.0, gradient.dot(system.precondition(gradient))));
        if (map.steps == 0) first_gradient = norm;
        if (!(norm > 0)) {
            map.converged = true;
            break;
        }
        const Eigen::VectorXd step = system.solve(gradient, std::min(0.1, std::max(norm / first_gradient, 1e-4)));
        const double slope = gradient.dot(step);
        const bool converging = -slope <= options.tolerance * map.energy + kRounding;

        const double gap = least_gap(map.holes);
        double length = 1;
        bool accepted = false, near = false;
        for (int halving = 0; halving < kMostHalvings && !accepted; ++halving, length /= 2) {
            std::vector<CircleRim> trial = moved(rims, step, length);
            bool possible = true;
            for (std::size_t l = 0; l < rims.size(); ++l)
                possible = possible && trial[l].radius > kKeptRadius * rims[l].radius;
            if (!possible) continue;
            const std::vector<RoundHole> holes = holes_of(trial, outer_loop);
            const double left = least_gap(holes);
            near = left < options.least_gap;
            if (near || left < kKeptGap * gap) continue;
            Eigen::VectorXcd g = rim_energy.extended(rim_positions(trial, vertices));
            const Eigen::VectorXcd new_force = rim_energy.force(g);
            const double energy = rim_energy.energy(trial, new_force);
            if (!(energy <= map.energy + kArmijo * length * slope + kRounding)) continue;
            accepted = true;
            map.converged = converging && release(trial, new_force) == 0;
            rims = std::move(trial);
            map.holes = holes;
            map.energy = energy;
            f = std::move(g);
            force = new_force;
        }
        if (!accepted) {
            map.too_close = near;
            map.converged = !near && converging;
            break;
        }
    }
    for (const int v : surface.mesh.faces.vertices()) map.vertices[v] = f[v];
    map.products += rim_energy.products();
}

}  // namespace beltrami
