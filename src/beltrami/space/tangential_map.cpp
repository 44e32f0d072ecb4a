#include <beltrami/space/tangential_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/locate/surface_locator.h>
#include <beltrami/solve/damping.h>

namespace beltrami {

namespace {

constexpr int kExpectedTangentialFactorizations = 40;
constexpr int kMostHalvings = 20;  // of a step, then none is taken
constexpr double kTangentialShift = 1e-10, kLargestTangentialShift = 1e-4;
constexpr double kUndamped = 1e-2;  // below it a small step says that the end is near
constexpr int kFutileSteps = 5;     // in a row, with more damping each
constexpr double kCusp = 0.2;       // cosine of a face's normal and the target's
constexpr double kFirstStiffness = 0.05, kStiffnessFactor = 4;
constexpr double kBlocking = 0.2, kLooked = 0.26;  // step lengths: held if it stays shorter, looked for from here on
constexpr double kNearlyFolded = 0.999;            // |μ| of a sample that blocks
constexpr double kOpening = 30 * (180 / std::numbers::pi) * (180 / std::numbers::pi);  // of missing angles, radians²
constexpr double kAllRound = 0.3;  // of a blocking vertex's quadric, in every direction

using Vector3 = Eigen::Vector3d;

Vector3 normal_of(const ImageFrame& frame) {
    const Vector3 up = frame.e1.cross(frame.e2);
    return frame.upright ? up : Vector3(-up);
}

/// The same sample seen from the other side.
void turn_over(ImageFrame& frame) {
    const Complex p = std::conj(frame.q);
    frame.q = std::conj(frame.p);
    frame.p = p;
    frame.e2 = -frame.e2;
    frame.upright = !frame.upright;
}

/// Elements: the samples, then every vertex by itself.
ElementSystem system_of(const Operators& operators, const std::vector<int>& place) {
    std::vector<int> nodes, offsets = operators.offsets;
    for (const int v : operators.vertices) nodes.push_back(place[v]);
    for (const int node : place) {
        nodes.push_back(node);
        offsets.push_back(static_cast<int>(nodes.size()));
    }
    const int count = place.empty() ? 0 : *std::max_element(place.begin(), place.end()) + 1;
    return {std::move(offsets), std::move(nodes), count, kExpectedTangentialFactorizations, 2};
}

std::vector<double> of_unit_sum(std::vector<double> weights) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    return weights;
}

double jacobian(const ImageFrame& frame) {
    return std::norm(frame.p) - std::norm(frame.q);
}

}  // namespace

TangentialMap::TangentialMap(const Surface& start, const Operators& reference, const Target& target,
                             const TargetConstraints& constraints, double even_size)
    : start_(start),
      operators_(reference),
      target_(target),
      motion_(start, target, constraints),
      map_(target_map(start, target, constraints, start.mesh.positions)),
      even_size_(even_size),
      weights_(of_unit_sum(reference.weights)),
      wanted_(Eigen::VectorXcd::Zero(reference.sample_count())),
      area_(reference.sample_count()),
      cusp_(static_cast<std::size_t>(reference.sample_count()), 0),
      own_normal_(Positions::Zero(reference.sample_count(), 3)),
      stiffness_(Eigen::VectorXd::Zero(start.mesh.vertex_count())),
      size_(Eigen::VectorXd::Zero(start.mesh.vertex_count())),
      place_(motion_.indices_of_moving()),
      system_(system_of(reference, place_)),
      gradient_(system_.unknown_count()) {
    follow_cusps();
    set_quadrics(start.mesh);
    const Positions points = positions(), normals = normals_of(map_.points);
    for (int s = 0; s < operators_.sample_count(); ++s) area_[s] = std::abs(jacobian(frame(s, points, normals)));
}

/// Before the normals at its vertices turn against a face that no step has folded: it would hold up all others.
void TangentialMap::follow_cusps() {
    const Positions points = positions(), normals = normals_of(map_.points);
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const Vector3 own = normal_of(image_frame(operators_, s, points, normals));
        if (!cusp_[s]) {
            Vector3 up = Vector3::Zero();
            for (const int v : operators_.stencil(s)) up += normals.row(v).transpose();
            cusp_[s] = own.dot(up.normalized()) < kCusp;
        }
        if (cusp_[s]) own_normal_.row(s) = own;
    }
}

void TangentialMap::set_quadrics(const Mesh& start) {
    std::vector<int> faces;
    Positions points(start.vertex_count(), 3);
    for (int v = 0; v < start.vertex_count(); ++v) points.row(v) = start.point(v);
    const std::vector<std::array<int, 3>> triangles = as_triangles(start.faces, points, faces);
    quadric_.assign(static_cast<std::size_t>(start.vertex_count()), Eigen::Matrix3d::Zero());
    Eigen::VectorXd angles = Eigen::VectorXd::Zero(start.vertex_count());
    for (const auto& triangle : triangles)
        for (int j = 0; j < 3; ++j) {
            const Vector3 u = start.point(triangle[(j + 1) % 3]) - start.point(triangle[j]),
                          v = start.point(triangle[(j + 2) % 3]) - start.point(triangle[j]), normal = u.cross(v);
            const double twice = normal.norm(), angle = std::atan2(twice, u.dot(v));
            if (!(twice > 0)) continue;
            quadric_[triangle[j]] += angle / (twice * twice) * normal * normal.transpose();
            angles[triangle[j]] += angle;
            size_[triangle[j]] += twice / 6;
        }
    for (int v = 0; v < start.vertex_count(); ++v) {
        if (angles[v] > 0) quadric_[v] /= angles[v];
        size_[v] = size_[v] > 0 ? std::sqrt(size_[v]) : 1;
    }
}

void TangentialMap::scale_areas(const Eigen::VectorXd& factors) {
    area_.array() *= factors.array();
}

ImageFrame TangentialMap::frame(int sample, const Positions& points, const Positions& normals) const {
    ImageFrame result = image_frame(operators_, sample, points, normals);
    if (cusp_[sample]) {
        const bool upright = normal_of(result).dot(own_normal_.row(sample)) > 0;
        if (upright != result.upright) turn_over(result);
    }
    return result;
}

Eigen::VectorXcd TangentialMap::coefficients() const {
    const Positions points = positions(), normals = normals_of(map_.points);
    Eigen::VectorXcd mu(operators_.sample_count());
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const ImageFrame at = frame(s, points, normals);
        mu[s] = at.q / at.p;
    }
    return mu;
}

std::vector<int> TangentialMap::folded() const {
    const Positions points = positions(), normals = normals_of(map_.points);
    std::vector<int> result;
    for (int s = 0; s < operators_.sample_count(); ++s)
        if (!frame(s, points, normals).upright) result.push_back(s);
    return result;
}

double TangentialMap::drawn_back(const Positions& points) const {
    double sum = 0;
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
        if (stiffness_[v] == 0) continue;
        const Vector3 away = (points.row(v).transpose() - start_.mesh.point(static_cast<int>(v))) / size_[v];
        sum += stiffness_[v] * away.dot(quadric_[v] * away);
    }
    return sum / static_cast<double>(points.rows());
}

double TangentialMap::value(const BarrierEnergy& energy, const TargetMap& map) const {
    const Positions points = positions_of(map.points), normals = normals_of(map.points);
    const double area_weight = even_size_ / energy.unit();
    const double sum = parallel_sum(operators_.sample_count(), 0.0, [&](int first, int last) {
        double part = 0;
        for (int s = first; s < last; ++s) {
            const ImageFrame at = frame(s, points, normals);
            if (!at.upright) return kInfinity;
            part += energy.value(at, s);
            if (area_weight > 0) {
                const double log_area = std::log(jacobian(at) / area_[s]);
                part += area_weight * weights_[s] * log_area * log_area;
            }
        }
        return part;
    });
    return sum + drawn_back(points) / energy.unit() + (least_angle_ > 0 ? lacking_angles(points) : 0);
}

/// Of how many corners of a sample the angles are those of its face: of all of a triangle, of one of the corner
/// triangles of a polygon.
int TangentialMap::face_corners(int sample) const {
    return start_.mesh.faces.degree(operators_.faces[sample]) == 3 ? 3 : 1;
}

double TangentialMap::lacking_angles(const Positions& points) const {
    return parallel_sum(operators_.sample_count(), 0.0, [&](int first, int last) {
        double part = 0;
        for (int s = first; s < last; ++s)
            for (int j = 0; j < face_corners(s); ++j) {
                const double lack = least_angle_ - corner_angle(operators_.stencil(s), j, points).angle;
                if (lack > 0) part += kOpening * weights_[s] * lack * lack;
            }
        return part;
    });
}

void TangentialMap::assemble_angles(const std::vector<TargetMotion::Directions>& ways) {
    const Positions points = positions();
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const auto stencil = operators_.stencil(s);
        for (int corner = 0; corner < face_corners(s); ++corner) {
            const CornerAngle at = corner_angle(stencil, corner, points);
            const double lack = least_angle_ - at.angle, weight = kOpening * weights_[s];
            if (!(lack > 0)) continue;
            std::array<double, 6> l{};
            std::array<double, 21> hessian{};
            for (std::size_t i = 0, entry = 0; i < 6; ++i) {
                l[i] = at.by[i / 2].dot(ways[stencil[i / 2]][i % 2]);
                if (const int node = place_[stencil[i / 2]]; node >= 0)
                    gradient_[2 * node + static_cast<int>(i % 2)] -= weight * lack * l[i];
                for (std::size_t j = 0; j <= i; ++j) hessian[entry++] = weight * l[i] * l[j];
            }
            system_.add(s, hessian);
        }
    }
}

void TangentialMap::assemble_samples(const BarrierEnergy& energy, const std::vector<TargetMotion::Directions>& ways) {
    const Positions points = positions(), normals = normals_of(map_.points);
    std::array<Complex, 6> v;
    std::array<double, 6> l;
    std::array<double, 21> hessian;
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const ImageFrame at = frame(s, points, normals);
        const SampleTerm term = energy.term(at, s);
        const auto stencil = operators_.stencil(s);
        const auto g = operators_.gradient(s);
        const double area = jacobian(at), weight = even_size_ / energy.unit() * weights_[s],
                     slope = weight * std::log(area / area_[s]);
        std::size_t entry = 0;
        for (std::size_t i = 0; i < 6; ++i) {
            const int vertex = stencil[i / 2];
            const Complex half = 0.5 * at.along(ways[vertex][i % 2]);
            const Complex dp = half * std::conj(g[i / 2]), dq = half * g[i / 2];
            v[i] = term.of_dzbar * dq + term.of_dz * dp;
            l[i] = 2 * (std::conj(at.p) * dp - std::conj(at.q) * dq).real() / area;
            if (const int node = place_[vertex]; node >= 0)
                gradient_[2 * node + static_cast<int>(i % 2)] +=
                    std::real(std::conj(term.gradient) * v[i]) + slope * l[i];
            for (std::size_t j = 0; j <= i; ++j)
                hessian[entry++] = term.along * v[i].real() * v[j].real() + term.across * v[i].imag() * v[j].imag() +
                                   weight * l[i] * l[j];
        }
        system_.add(s, {hessian.data(), entry});
    }
}

/// What draws vertices back, and the damping.
void TangentialMap::assemble_vertices(double unit, const std::vector<TargetMotion::Directions>& ways) {
    const auto vertices = static_cast<double>(place_.size());
    for (std::size_t v = 0; v < place_.size(); ++v) {
        if (place_[v] < 0) continue;
        const auto i = static_cast<Eigen::Index>(v);
        const double scale = 1 / (size_[i] * size_[i] * vertices * unit);
        const Eigen::Matrix3d pull = scale * stiffness_[i] * quadric_[v];
        const Vector3 force = pull * (map_.points[v].position - start_.mesh.point(static_cast<int>(v)));
        std::array<double, 3> lower{};
        for (int a = 0, entry = 0; a < 2; ++a) {
            gradient_[2 * place_[v] + a] += ways[v][a].dot(force);
            for (int b = 0; b <= a; ++b, ++entry) lower[entry] = ways[v][a].dot(pull * ways[v][b]);
        }
        lower[0] += scale * damping_ * ways[v][0].squaredNorm();
        // A vertex that slides has one unknown only.
        lower[2] += ways[v][1].isZero(0) ? 1 : scale * damping_ * ways[v][1].squaredNorm();
        system_.add(operators_.sample_count() + static_cast<int>(v), lower);
    }
}

void TangentialMap::assemble(const BarrierEnergy& energy, const std::vector<TargetMotion::Directions>& ways) {
    system_.clear();
    gradient_.setZero();
    assemble_samples(energy, ways);
    if (least_angle_ > 0) assemble_angles(ways);
    assemble_vertices(energy.unit(), ways);
}

/// Directions of such lengths that the diagonal of the system becomes 1.
void TangentialMap::equilibrate(std::vector<TargetMotion::Directions>& ways) const {
    for (std::size_t v = 0; v < place_.size(); ++v)
        for (int a = 0; a < 2; ++a)
            if (place_[v] >= 0 && !ways[v][a].isZero(0))
                ways[v][a] /= std::sqrt(std::max(system_.diagonal(2 * place_[v] + a), 1e-300));
}

Positions TangentialMap::direction(const BarrierEnergy& energy) {
    std::vector<TargetMotion::Directions> ways;
    ways.reserve(place_.size());
    // Across the normal, not the face: vertices that run along ridges would come to rest there.
    for (std::size_t v = 0; v < place_.size(); ++v)
        ways.push_back(motion_.directions(static_cast<int>(v), map_, map_.points[v].normal));
    Eigen::VectorXd solution;
    double shift = kTangentialShift;
    for (bool solved = false; !solved; shift *= 100) {
        assemble(energy, ways);
        const bool last = shift >= kLargestTangentialShift;
        system_.scale_diagonal(1 + shift);
        try {
            system_.factorize();
            solution = system_.solve(-gradient_);
            solved = true;
        } catch (const Error& error) {
            if (error.cause() != Cause::not_solved || last) throw;
            equilibrate(ways);
        }
    }
    return motion_along(place_, ways, solution);
}

void TangentialMap::draw_back(std::span<const int> vertices) {
    for (const int v : vertices) {
        if (stiffness_[v] == 0) quadric_[v] += kAllRound * Eigen::Matrix3d::Identity();
        stiffness_[v] = std::max(kStiffnessFactor * stiffness_[v], kFirstStiffness);
    }
}

void TangentialMap::return_to(TargetMap map) {
    map_ = std::move(map);
    follow_cusps();
}

/// Holds the vertices of samples that keep a step short.
void TangentialMap::hold_blocked(const TargetMap& trial) {
    const Positions points = positions_of(trial.points), normals = normals_of(trial.points);
    std::vector<char> blocking(place_.size(), 0);
    for (int s = 0; s < operators_.sample_count(); ++s) {
        const ImageFrame at = frame(s, points, normals);
        if (at.upright && std::abs(at.q) < kNearlyFolded * std::abs(at.p)) continue;
        for (const int v : operators_.stencil(s)) blocking[v] = 1;
    }
    std::vector<int> held;
    for (std::size_t v = 0; v < blocking.size(); ++v)
        if (blocking[v]) held.push_back(static_cast<int>(v));
    draw_back(held);
}

TangentialMap::Taken TangentialMap::step(BarrierEnergy& energy) {
    energy.prepare(operators_, positions(), normals_of(map_.points));
    const double before = value(energy, map_);
    if (!std::isfinite(before))
        throw Error(Cause::not_solved, "the map folds where it begins", "begin with one that does not");
    const Positions motion = direction(energy);
    Taken taken;
    std::optional<TargetMap> blocked;
    for (int halvings = 0; halvings < kMostHalvings; ++halvings) {
        const double length = std::ldexp(1.0, -halvings);
        TargetMap trial = motion_.moved(map_, motion, length);
        const double there = value(energy, trial);
        if (there < before) {
            map_ = std::move(trial);
            taken = {length, 1 - there / before};
            break;
        }
        if (length <= kLooked && !std::isfinite(there)) blocked = std::move(trial);
    }
    if (blocked && taken.length < kBlocking) hold_blocked(*blocked);
    if (taken.length > 0) follow_cusps();
    ++steps_;
    return taken;
}

void TangentialMap::damp(double length) {
    if (length < kShort)
        damping_ = std::max(kDampingFactor * damping_, kFirstDamping);
    else if (length > kNearlyFull)
        damping_ = damping_ / kDampingFactor < kLeastDamping ? 0 : damping_ / kDampingFactor;
}

int TangentialMap::relax(double power, int max_steps, double tolerance) {
    BarrierEnergy energy(wanted_, operators_.weights, power);
    int futile = 0;
    for (int count = 1; count <= max_steps; ++count) {
        const Taken taken = step(energy);
        if (progress_ && !progress_(steps_, value(energy, map_)))
            throw Error(Cause::cancelled, "cancelled after step " + std::to_string(steps_));
        damp(taken.length);
        futile = taken.length == 0 ? futile + 1 : 0;
        const bool at_rest = taken.length > kShort && taken.fallen < tolerance && damping_ < kUndamped;
        if (at_rest || futile >= kFutileSteps) return count;
    }
    return max_steps;
}

std::vector<int> TangentialMap::hold_within(double distance, double growth) {
    if (!gap_) gap_ = std::make_unique<SurfaceGap>(start_.mesh, target_);
    std::vector<int> strayed = gap_->strayed(positions(), distance);
    for (const int v : strayed) stiffness_[v] = std::max(growth * stiffness_[v], kFirstStiffness);
    return strayed;
}

}  // namespace beltrami
