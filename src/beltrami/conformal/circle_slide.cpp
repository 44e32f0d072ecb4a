#include <beltrami/conformal/circle_slide.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace beltrami {

namespace {

constexpr double kPi = std::numbers::pi;

constexpr double kLeastShare = 0.2;        // of an increment in proportion to the edge's length
constexpr int kNearby = 4;                 // edges on either side with which one is compared
constexpr double kLeastRate = 1e-4;        // of angle per length, and of length, against the mean
constexpr double kLeastIncrement = 0.1;    // of the old increment
constexpr double kAtLeast = 1.01;          // of the least increment: as good as it
constexpr double kMostNegative = 0.4;      // curvature of a circle, half the diagonal of the rest on an even rim
constexpr double kRounding = 1e-15;        // of energies, which are at most about 3
constexpr double kLargestIncrement = 2.0;  // radians
constexpr double kFirstGap = 0.05;         // circles are first made smaller until they have it
constexpr double kKeptGap = 0.3;           // part of the least gap that a step leaves
constexpr double kKeptRadius = 0.3;        // and of a radius
constexpr double kArmijo = 1e-4;
constexpr int kMostHalvings = 12;
constexpr int kMostProducts = 150;  // of one step
constexpr int kDenseRim = 1500;     // vertices; longer rims share the kernel of so many places

/// Increments become at least @p least and at most kLargestIncrement with the same sum: what that adds is taken from
/// the others in proportion to what they can give.
void limit_increments(std::vector<double>& increments, const std::vector<double>& least) {
    double sum = 0, limited_sum = 0;
    for (std::size_t i = 0; i < increments.size(); ++i) {
        sum += increments[i];
        increments[i] = std::clamp(increments[i], least[i], std::max(least[i], kLargestIncrement));
        limited_sum += increments[i];
    }
    const double excess = limited_sum - sum;
    if (excess == 0) return;
    double slack = 0;
    for (std::size_t i = 0; i < increments.size(); ++i)
        slack += excess > 0 ? increments[i] - least[i] : std::max(0.0, kLargestIncrement - increments[i]);
    if (!(slack > 0)) return;
    for (std::size_t i = 0; i < increments.size(); ++i) {
        const double room = excess > 0 ? increments[i] - least[i] : std::max(0.0, kLargestIncrement - increments[i]);
        increments[i] -= excess * room / slack;
    }
}

/// A boundary loop on its circle, run through counter-clockwise: holes' loops backwards.
struct Rim {
    std::vector<int> vertices;
    int hole = -1;  // index, −1 for the outer loop
    Complex centre = 0;
    double radius = 1;
    std::vector<double> angles;  // increasing, less than a turn
    std::vector<double> least;   // increments
    std::vector<char> held;      // does not slide
    std::vector<char> released;  // once; 1 while it is being done
    std::vector<char> tied;      // keeps its increment to the next one
    int first = 0;               // of its vertices among all rim vertices

    int size() const { return static_cast<int>(vertices.size()); }
    Complex direction(int i) const { return std::polar(1.0, angles[i]); }
    Complex position(int i) const { return centre + radius * direction(i); }
    double increment(int i) const {
        return i + 1 < size() ? angles[i + 1] - angles[i] : angles[0] + 2 * kPi - angles[i];
    }
};

std::vector<Rim> rims_of(const Surface& surface, int outer_loop, const std::vector<RoundHole>& holes) {
    std::vector<Rim> rims;
    int hole = 0, first = 0;
    for (int l = 0; l < static_cast<int>(surface.topology.boundary_loops.size()); ++l) {
        Rim rim;
        rim.vertices = surface.topology.boundary_loops[l];
        rim.first = first;
        first += rim.size();
        rim.held.assign(rim.vertices.size(), 0);
        rim.tied.assign(rim.vertices.size(), 0);
        rim.released.assign(rim.vertices.size(), 0);
        if (l != outer_loop) {
            std::reverse(rim.vertices.begin(), rim.vertices.end());
            rim.hole = hole;
            rim.centre = holes[hole].centre;
            rim.radius = holes[hole++].radius;
        }
        rims.push_back(std::move(rim));
    }
    return rims;
}

/// Angles of points on circles, as they are.
void read_angles(Rim& rim, const Eigen::VectorXcd& z) {
    rim.angles.resize(rim.vertices.size());
    for (int i = 0; i < rim.size(); ++i) {
        const Complex arm = z[rim.vertices[i]] - rim.centre;
        if (i == 0) {
            rim.angles[0] = std::arg(arm);
            continue;
        }
        const Complex before = z[rim.vertices[i - 1]] - rim.centre;
        rim.angles[i] = rim.angles[i - 1] + std::arg(arm * std::conj(before));
    }
}

/// For every edge of a rim a part of the angle that is its due by length among the edges nearby. The conformal map
/// gives a long bay little of the circle, but a spike of one or two edges no less than that here.
std::vector<double> least_increments(const std::vector<double>& lengths, const std::vector<double>& increments) {
    const int n = static_cast<int>(lengths.size());
    const double even = 2 * kPi / std::accumulate(lengths.begin(), lengths.end(), 0.0);
    std::vector<double> least(n);
    for (int i = 0; i < n; ++i) {
        double length = 0, angle = 0;
        for (int j = -kNearby; j <= kNearby; ++j) {
            const int k = (i + n + j % n) % n;
            length += lengths[k];
            angle += increments[k];
        }
        const double rate = std::max(angle / length, kLeastRate * even);
        least[i] = kLeastShare * rate * std::max(lengths[i], kLeastRate * length);
    }
    return least;
}

/// Angles of points near circles, brought in order.
void choose_angles(Rim& rim, const Eigen::VectorXcd& z) {
    read_angles(rim, z);
    const int n = rim.size();
    std::vector<double> increments(n), lengths(n);
    for (int i = 0; i < n; ++i) {
        const Complex a = z[rim.vertices[i]], b = z[rim.vertices[(i + 1) % n]];
        lengths[i] = std::abs(b - a);
        increments[i] = std::arg((b - rim.centre) * std::conj(a - rim.centre));
    }
    const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0),
                 turn = std::accumulate(increments.begin(), increments.end(), 0.0);
    if (!(std::abs(turn - 2 * kPi) < 1e-6))  // the centre is not inside: by length
        for (int i = 0; i < n; ++i) increments[i] = lengths[i] / length * 2 * kPi;
    rim.least = least_increments(lengths, increments);
    limit_increments(increments, rim.least);
    Complex turned = 0;  // mean rotation from the new angles to those of the points
    double angle = rim.angles[0];
    for (int i = 0; i < n; ++i) {
        rim.angles[i] = angle;
        const Complex arm = z[rim.vertices[i]] - rim.centre;
        if (std::abs(arm) > 0) turned += arm / std::abs(arm) * std::polar(1.0, -angle);
        angle += increments[i];
    }
    for (double& a : rim.angles) a += std::arg(turned);
}

Eigen::VectorXcd boundary_values(const std::vector<Rim>& rims, Eigen::Index vertices) {
    Eigen::VectorXcd z = Eigen::VectorXcd::Zero(vertices);
    for (const Rim& rim : rims)
        for (int i = 0; i < rim.size(); ++i) z[rim.vertices[i]] = rim.position(i);
    return z;
}

std::vector<RoundHole> holes_of(const std::vector<Rim>& rims, int outer_loop) {
    std::vector<RoundHole> holes;
    for (int l = 0; l < static_cast<int>(rims.size()); ++l)
        if (l != outer_loop) holes.push_back({l, rims[l].centre, rims[l].radius});
    return holes;
}

/// The inverse of the Dirichlet-to-Neumann map of a circle, for nodal values and integrated fluxes: −log|2 sin(Δ/2)|/π,
/// and a constant for the mean. The diagonal is chosen so that the smallest eigenvalue on even places is that of
/// the wave of two edges.
class CircleKernel {
  public:
    explicit CircleKernel(const Rim& rim) {
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
    RimEnergy(const Surface& surface, const BeltramiSolver& dirichlet, const std::vector<Rim>& rims)
        : operators_(surface.operators), dirichlet_(dirichlet), slot_(surface.mesh.vertex_count(), -1) {
        for (const Rim& rim : rims)
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

    double energy(const std::vector<Rim>& rims, const Eigen::VectorXcd& force) const {
        double sum = 0;
        for (const Rim& rim : rims)
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

/// Chains of tied vertices slide together: their mean; not at all with a held one.
void project(const std::vector<Rim>& rims, Eigen::VectorXd& unknowns) {
    for (const Rim& rim : rims) {
        const int n = rim.size();
        int start = 0;  // of a chain
        while (start < n && rim.tied[(start + n - 1) % n]) ++start;
        start %= n;
        for (int done = 0; done < n;) {
            int count = 1;
            const auto at = [&](int j) { return (start + done + j) % n; };
            while (done + count < n && rim.tied[at(count - 1)]) ++count;
            double sum = 0;
            bool held = false;
            for (int j = 0; j < count; ++j) {
                sum += unknowns[rim.first + at(j)];
                held = held || rim.held[at(j)];
            }
            for (int j = 0; j < count; ++j) unknowns[rim.first + at(j)] = held ? 0.0 : sum / count;
            done += count;
        }
    }
}

/// Tangential part of rim forces, and their sums for every hole: the derivative of the energy.
Eigen::VectorXd pulled_back(const std::vector<Rim>& rims, const Eigen::VectorXcd& force, int unknowns) {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(unknowns);
    const int circles = static_cast<int>(force.size());
    for (const Rim& rim : rims)
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
Eigen::VectorXcd pushed_forward(const std::vector<Rim>& rims, const Eigen::VectorXd& unknowns, int circles,
                                Eigen::Index vertices) {
    Eigen::VectorXcd motion = Eigen::VectorXcd::Zero(vertices);
    for (const Rim& rim : rims)
        for (int i = 0; i < rim.size(); ++i) {
            Complex& m = motion[rim.vertices[i]];
            m = Complex(0, unknowns[rim.first + i]) * rim.direction(i);
            if (rim.hole < 0) continue;
            const double* of_hole = unknowns.data() + circles + 3L * rim.hole;
            m += Complex(of_hole[0], of_hole[1]) + of_hole[2] * rim.direction(i);
        }
    return motion;
}

/// The rims after a step. Sliding is by arc length on the new circle: then angle and radius do not mix in the second
/// derivatives.
std::vector<Rim> moved(std::vector<Rim> rims, const Eigen::VectorXd& step, double length, int circles) {
    for (Rim& rim : rims) {
        const int n = rim.size();
        if (rim.hole >= 0) {
            const double* of_hole = step.data() + circles + 3L * rim.hole;
            rim.centre += length * Complex(of_hole[0], of_hole[1]);
            rim.radius += length * of_hole[2];
            if (!(rim.radius > 0)) return rims;
        }
        std::vector<double> turn(n);
        for (int i = 0; i < n; ++i) turn[i] = length * step[rim.first + i] / rim.radius;
        // Pieces from one held vertex to the next; the whole circle where none is held.
        int start = 0;
        while (start < n && !rim.held[start]) ++start;
        const bool closed = start == n;
        if (closed) start = 0;
        for (int done = 0; done < n;) {
            std::vector<double> increments, least;
            int i = (start + done) % n;
            const int first = i;
            bool limited = false;
            do {
                const int next = (i + 1) % n;
                const double old = rim.increment(i);
                increments.push_back(old + turn[next] - turn[i]);
                least.push_back(std::min(old, std::max(kLeastIncrement * old, rim.least[i])));
                limited = limited || increments.back() < least.back() || increments.back() > kLargestIncrement;
                i = next;
            } while (i != first && !rim.held[i]);
            if (limited) {
                std::vector<double> wanted = increments;
                limit_increments(increments, least);
                double drift = 0, mean = 0;  // of the limited vertices against the wanted ones
                for (std::size_t j = 0; j < increments.size(); ++j) {
                    mean += drift / static_cast<double>(increments.size());
                    turn[(first + j) % n] += drift;
                    drift += increments[j] - wanted[j];
                }
                if (closed)
                    for (double& t : turn) t -= mean;
            }
            done += static_cast<int>(increments.size());
        }
        for (int i = 0; i < n; ++i) rim.angles[i] += turn[i];
        for (int i = 0; i < n; ++i)
            if (rim.increment(i) <= kAtLeast * rim.least[i]) rim.tied[i] = 1;
    }
    return rims;
}

/// Three vertices of the outer loop about a third of the circle apart.
void hold_three(Rim& outer) {
    int held = 0;
    for (int i = 0; i < outer.size() && held < 3; ++i)
        if (outer.angles[i] - outer.angles[0] >= held * 2 * kPi / 3 - 1e-12 || outer.size() - i == 3 - held) {
            outer.held[i] = 1;
            ++held;
        }
}

/// Unties what the energy wants apart; each tie once. The derivative by an increment, the rest of its chain at rest, is
/// the sum of what pulls at the vertices beyond it.
int release(std::vector<Rim>& rims, const Eigen::VectorXcd& force) {
    int count = 0;
    for (Rim& rim : rims) {
        const int n = rim.size();
        for (int first = 0; first < n; ++first) {
            if (!rim.tied[first] || rim.tied[(first + n - 1) % n]) continue;
            double mean = 0, below = 0;
            bool held = false;
            int length = 0;  // ties of the chain
            const auto pull = [&](int j) {
                const int i = (first + j) % n;
                return std::imag(std::conj(rim.direction(i)) * force[rim.first + i]);
            };
            while (length < n && rim.tied[(first + length) % n]) ++length;
            for (int j = 0; j <= length; ++j) {
                mean += pull(j) / (length + 1);
                held = held || rim.held[(first + j) % n];
            }
            if (held || length == n) continue;
            for (int j = 0; j < length; ++j) {
                below += pull(j) - mean;
                const int i = (first + j) % n;
                if (below > 0 && !rim.released[i]) {
                    rim.released[i] = 1;
                    ++count;
                }
            }
        }
        for (int i = 0; i < n; ++i)
            if (rim.released[i] == 1) {
                rim.tied[i] = 0;
                rim.released[i] = 2;
            }
    }
    return count;
}

struct NewtonSystem {
    const std::vector<Rim>& rims;
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
    std::vector<Rim> rims = rims_of(surface, outer_loop, holes);
    Eigen::VectorXcd correction = Eigen::VectorXcd::Zero(vertices.size());
    for (Rim& rim : rims) {
        choose_angles(rim, vertices);
        for (int i = 0; i < rim.size(); ++i) correction[rim.vertices[i]] = rim.position(i) - vertices[rim.vertices[i]];
    }
    CircleSlide result;
    result.vertices = vertices;
    const Eigen::VectorXcd inside = dirichlet.solve(correction);
    for (const int v : surface.mesh.faces.vertices())
        if (!surface.topology.on_boundary[v]) result.vertices[v] = vertices[v] + inside[v];
    for (const Rim& rim : rims)
        for (int i = 0; i < rim.size(); ++i) result.vertices[rim.vertices[i]] = rim.position(i);
    for (Rim& rim : rims) result.least_increments.push_back(std::move(rim.least));
    result.holes = holes_of(rims, outer_loop);
    result.products = 1;
    return result;
}

void slide_on_circles(const Surface& surface, const BeltramiSolver& dirichlet, int outer_loop, CircleSlide& map,
                      const CircleSlideOptions& options) {
    const Eigen::Index vertices = map.vertices.size();
    std::vector<Rim> rims = rims_of(surface, outer_loop, map.holes);
    for (std::size_t l = 0; l < rims.size(); ++l) {
        read_angles(rims[l], map.vertices);
        rims[l].least = map.least_increments[l];
    }
    hold_three(rims[outer_loop]);
    const RimEnergy rim_energy(surface, dirichlet, rims);
    std::vector<CircleKernel> kernels;
    for (const Rim& rim : rims) kernels.emplace_back(rim);
    const int circles = rim_energy.rim_vertices(), unknowns = circles + 3 * static_cast<int>(map.holes.size());

    Eigen::VectorXcd f = rim_energy.extended(boundary_values(rims, vertices)), force = rim_energy.force(f);
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
            std::vector<Rim> trial = moved(rims, step, length, circles);
            bool possible = true;
            for (std::size_t l = 0; l < rims.size(); ++l)
                possible = possible && trial[l].radius > kKeptRadius * rims[l].radius;
            if (!possible) continue;
            const std::vector<RoundHole> holes = holes_of(trial, outer_loop);
            const double left = least_gap(holes);
            near = left < options.least_gap;
            if (near || left < kKeptGap * gap) continue;
            Eigen::VectorXcd g = rim_energy.extended(boundary_values(trial, vertices));
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
