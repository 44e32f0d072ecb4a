#include <beltrami/differentials/table_zeros.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include <beltrami/base/constants.h>
#include <beltrami/base/disjoint_sets.h>
#include <beltrami/differentials/argument_principle.h>
#include <beltrami/mesh/quad_split.h>
#include <beltrami/operators/frames.h>

namespace beltrami {

namespace {

/// φ is real along a loop if the mean of |Im φ(e, e)|/|φ| over its edges is less than this (of any φ it is 2/π):
/// of one found as real there, on noisy rims, and of any other.
constexpr double kRealByCondition = 0.5, kReal = 0.1;

/// A face laid out in the frame whose real axis is its first edge, and φ there, the mean over its samples.
struct LaidOutFace {
    std::vector<Complex> corners;
    Complex phi = 0;
};

std::vector<LaidOutFace> laid_out_faces(const Surface& source, const Eigen::VectorXcd& phi) {
    const Mesh& mesh = source.mesh;
    std::vector<LaidOutFace> faces(static_cast<std::size_t>(mesh.face_count()));
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        std::vector<Eigen::Vector3d> points;
        for (std::size_t j = 0; j < v.size(); ++j) {
            Eigen::Vector3d point = Eigen::Vector3d::Zero();
            if (source.metric) {
                const Eigen::Index corner = mesh.faces.first_corner(f) + static_cast<Eigen::Index>(j);
                point.head(source.metric->cols()) = source.metric->row(corner).transpose();
            } else {
                point.head(mesh.positions.cols()) = mesh.positions.row(v[j]).transpose();
            }
            points.push_back(point);
        }
        const Eigen::Vector3d x = (points[1] - points[0]).normalized();
        Eigen::Vector3d area = Eigen::Vector3d::Zero();
        for (std::size_t j = 1; j + 1 < points.size(); ++j)
            area += (points[j] - points[0]).cross(points[j + 1] - points[0]);
        const Eigen::Vector3d y = (area - area.dot(x) * x).normalized().cross(x);
        for (const Eigen::Vector3d& point : points)
            faces[f].corners.emplace_back((point - points[0]).dot(x), (point - points[0]).dot(y));
    }
    const Eigen::VectorXcd along = phi_along_first_edge(source, phi);
    std::vector<int> samples(faces.size(), 0);
    for (const int f : source.operators.faces) ++samples[f];
    for (Eigen::Index s = 0; s < along.size(); ++s) {
        const int f = source.operators.faces[s];
        faces[f].phi += along[s] / static_cast<double>(samples[f]);
    }
    return faces;
}

/// A corner of a face at a vertex: directions of length 1 of its two edges in the face's frame, counter-clockwise.
struct Corner {
    int face, position, next, previous;  ///< vertices at the other ends of these edges
    Complex along_next, along_previous;
    double angle;
};

class Table {
  public:
    Table(const Surface& source, const Eigen::VectorXcd& phi, const std::vector<int>& poles, bool real)
        : source_(source),
          poles_(poles),
          most_imaginary_(real ? kRealByCondition : kReal),
          faces_(laid_out_faces(source, phi)),
          stars_(source.mesh.vertex_count()) {
        for (int f = 0; f < source.mesh.face_count(); ++f) {
            const auto v = source.mesh.faces[f];
            const int n = static_cast<int>(v.size());
            for (int j = 0; j < n; ++j) {
                const std::vector<Complex>& q = faces_[f].corners;
                const Complex next = q[(j + 1) % n] - q[j], previous = q[(j + n - 1) % n] - q[j];
                double angle = std::arg(previous / next);
                if (angle < 0) angle += 2 * kPi;
                stars_[v[j]].push_back({f, j, v[(j + 1) % n], v[(j + n - 1) % n], next / std::abs(next),
                                        previous / std::abs(previous), angle});
            }
        }
        for (std::vector<Corner>& star : stars_) sort_around(star);
    }

    std::vector<CriticalPoint> search() const {
        const std::vector<int> half_turns = half_turns_at_vertices();
        std::vector<Group> groups = groups_of(half_turns);
        remove_noise(groups);
        std::vector<CriticalPoint> result;
        for (const Group& group : groups) {
            if (group.half_turns == 0) continue;
            const int v = foremost(group, half_turns);
            const bool on_boundary = source_.topology.on_boundary[v];
            const int order = on_boundary ? group.half_turns : group.half_turns / 2;
            std::optional<MeshPoint> place;
            if (order == 1 && !on_boundary) place = linear_zero(stars_[v]);
            result.push_back({place ? *place : at_vertex(stars_[v]), order, on_boundary});
        }
        std::stable_sort(result.begin(), result.end(),
                         [](const CriticalPoint& a, const CriticalPoint& b) { return a.place.face < b.place.face; });
        return result;
    }

  private:
    /// Vertices next to each other at which φ turns.
    struct Group {
        std::vector<int> members;  ///< ascending
        int half_turns;            ///< of all: twice the order inside, the order on the boundary
    };

    std::vector<Group> groups_of(const std::vector<int>& half_turns) const {
        DisjointSets sets(static_cast<int>(half_turns.size()));
        for (const auto& [a, b] : source_.topology.edges)
            if (half_turns[a] != 0 && half_turns[b] != 0) sets.join(a, b);
        std::vector<int> number(half_turns.size(), -1);
        std::vector<Group> groups;
        for (int v = 0; v < static_cast<int>(half_turns.size()); ++v) {
            if (half_turns[v] == 0) continue;
            int& group = number[sets.find(v)];
            if (group < 0) {
                group = static_cast<int>(groups.size());
                groups.push_back({{}, 0});
            }
            groups[group].members.push_back(v);
            groups[group].half_turns += half_turns[v];
        }
        return groups;
    }

    /// Negative orders where there is no pole are noise of the values, which has turned something nearby too far: they
    /// are taken from the nearest groups.
    void remove_noise(std::vector<Group>& groups) const {
        std::vector<int> group_at(stars_.size(), -1);
        for (std::size_t g = 0; g < groups.size(); ++g)
            for (const int v : groups[g].members) group_at[v] = static_cast<int>(g);
        for (Group& group : groups) {
            const bool pole =
                std::any_of(group.members.begin(), group.members.end(), [&](int v) { return may_be_pole(v); });
            std::vector<char> seen(group.half_turns < 0 && !pole ? stars_.size() : 0, 0);
            std::vector<int> queue;
            for (const int v : group.members)
                if (!seen.empty()) {
                    seen[v] = 1;
                    queue.push_back(v);
                }
            for (std::size_t i = 0; i < queue.size() && group.half_turns < 0; ++i) {
                Group* const other = group_at[queue[i]] < 0 ? nullptr : &groups[group_at[queue[i]]];
                if (other && other->half_turns > 0) {
                    const int taken = std::min(other->half_turns, -group.half_turns);
                    other->half_turns -= taken;
                    group.half_turns += taken;
                    other->members.insert(other->members.end(), group.members.begin(), group.members.end());
                }
                for (const Corner& corner : stars_[queue[i]])
                    for (const int v : {corner.next, corner.previous})
                        if (!seen[v]) {
                            seen[v] = 1;
                            queue.push_back(v);
                        }
            }
        }
    }

    bool may_be_pole(int v) const { return std::binary_search(poles_.begin(), poles_.end(), v); }

    /// In the order around the vertex, counter-clockwise; at the boundary from its edge on.
    static void sort_around(std::vector<Corner>& star) {
        const auto starts_at = [&](int vertex) {
            return std::find_if(star.begin(), star.end(), [&](const Corner& c) { return c.next == vertex; });
        };
        const auto first = std::find_if(star.begin(), star.end(), [&](const Corner& c) {
            return std::none_of(star.begin(), star.end(), [&](const Corner& d) { return d.previous == c.next; });
        });
        if (first != star.end()) std::iter_swap(star.begin(), first);
        for (std::size_t i = 0; i + 1 < star.size(); ++i) {
            const auto following = starts_at(star[i].previous);
            if (following != star.end()) std::iter_swap(star.begin() + static_cast<std::ptrdiff_t>(i) + 1, following);
        }
    }

    /// arg of φ(e, e) at the edges of a corner.
    double argument_next(const Corner& c) const { return std::arg(faces_[c.face].phi * c.along_next * c.along_next); }
    double argument_previous(const Corner& c) const {
        return std::arg(faces_[c.face].phi * c.along_previous * c.along_previous);
    }

    /// What arg φ turns from face to face, in radians; nothing where φ is 0.
    std::optional<double> turned(const std::vector<Corner>& star, bool closed) const {
        double sum = 0;
        for (const Corner& corner : star)
            if (faces_[corner.face].phi == 0.0) return {};
        for (std::size_t i = 0; i + (closed ? 0 : 1) < star.size(); ++i)
            sum += std::remainder(argument_next(star[(i + 1) % star.size()]) - argument_previous(star[i]), 2 * kPi);
        return sum;
    }

    static double whole_angle(const std::vector<Corner>& star) {
        double sum = 0;
        for (const Corner& corner : star) sum += corner.angle;
        return sum;
    }

    /// In the coordinate w = z^(2π/Θ), Θ the whole angle, φ(e, e) of the developed star turns by 2(2π − Θ) less.
    int order_inside(int v) const {
        const std::optional<double> sum = turned(stars_[v], true);
        return sum ? static_cast<int>(std::lround((*sum - 2 * (2 * kPi - whole_angle(stars_[v]))) / (2 * kPi))) : 0;
    }

    /// The same with w = z^(π/Θ), and φ real along both edges of the boundary.
    int order_on_boundary(int v) const {
        const std::vector<Corner>& star = stars_[v];
        const std::optional<double> sum = turned(star, false);
        if (!sum) return 0;
        const double off =
            std::remainder(argument_next(star.front()), kPi) - std::remainder(argument_previous(star.back()), kPi);
        return static_cast<int>(std::lround((*sum + off - 2 * (kPi - whole_angle(star))) / kPi));
    }

    bool real_along(const std::vector<int>& loop) const {
        double sum = 0;
        for (const int v : loop) sum += std::abs(std::sin(argument_next(stars_[v].front())));
        return sum < most_imaginary_ * static_cast<double>(loop.size());
    }

    std::vector<int> half_turns_at_vertices() const {
        std::vector<int> result(stars_.size(), 0);
        for (std::size_t v = 0; v < stars_.size(); ++v)
            if (!source_.topology.on_boundary[v] && !stars_[v].empty())
                result[v] = 2 * order_inside(static_cast<int>(v));
        for (const std::vector<int>& loop : source_.topology.boundary_loops)
            if (real_along(loop))
                for (const int v : loop) result[v] = order_on_boundary(v);
        return result;
    }

    double mean_size(int v) const {
        double sum = 0;
        for (const Corner& corner : stars_[v])
            sum += std::abs(faces_[corner.face].phi) / static_cast<double>(stars_[v].size());
        return sum;
    }

    /// The vertex at which a group is to be seen: where φ is small for a zero, a pole that is known, or where φ is
    /// large. An odd number of half turns belongs to the boundary.
    int foremost(const Group& group, const std::vector<int>& half_turns) const {
        const bool zero = group.half_turns > 0, odd = group.half_turns % 2 != 0;
        int best = -1;
        std::tuple<bool, bool, bool, double> least;
        for (const int v : group.members) {
            const bool known = !zero && may_be_pole(v);
            const std::tuple key(odd && !source_.topology.on_boundary[v], !known, zero != (half_turns[v] > 0),
                                 zero ? mean_size(v) : -mean_size(v));
            if (best >= 0 && !(key < least)) continue;
            least = key;
            best = v;
        }
        return best;
    }

    /// Three corners of a face in the order of MeshPoint, the one at @p position first.
    MeshPoint corner_point(int face, std::array<int, 3> positions, std::array<double, 3> weights) const {
        const auto v = source_.mesh.faces[face];
        return {face, {v[positions[0]], v[positions[1]], v[positions[2]]}, weights};
    }

    MeshPoint at_vertex(const std::vector<Corner>& star) const {
        const auto lowest = std::min_element(star.begin(), star.end(),
                                             [](const Corner& a, const Corner& b) { return a.face < b.face; });
        const int n = source_.mesh.faces.degree(lowest->face), j = lowest->position;
        return corner_point(lowest->face, {j, (j + 1) % n, (j + n - 1) % n}, {1, 0, 0});
    }

    /// The zero of the linear function that fits φ at the middles of the faces around a vertex inside, in the
    /// coordinate w; nothing where it is not on these faces.
    std::optional<MeshPoint> linear_zero(const std::vector<Corner>& star) const {
        const double opening = 2 * kPi / whole_angle(star);
        std::vector<Complex> places, values;
        Complex mean_place = 0, mean_value = 0;
        double before = 0;
        for (const Corner& corner : star) {
            const std::vector<Complex>& q = faces_[corner.face].corners;
            Complex middle = 0;
            for (const Complex p : q) middle += p / static_cast<double>(q.size());
            const Complex from_vertex = (middle - q[corner.position]) / corner.along_next;
            const double angle = before + std::arg(from_vertex);
            places.push_back(std::polar(std::abs(from_vertex), opening * angle));
            values.push_back(faces_[corner.face].phi * corner.along_next * corner.along_next *
                             std::polar(1.0, -2 * (before + (opening - 1) * angle)));
            mean_place += places.back() / static_cast<double>(star.size());
            mean_value += values.back() / static_cast<double>(star.size());
            before += corner.angle;
        }
        Complex slope = 0;
        double spread = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            slope += std::conj(places[i] - mean_place) * (values[i] - mean_value);
            spread += std::norm(places[i] - mean_place);
        }
        const Complex zero = mean_place - mean_value * spread / slope;
        if (!std::isfinite(std::norm(zero))) return {};
        double angle = std::arg(zero) / opening;
        if (angle < 0) angle += whole_angle(star);
        before = 0;
        for (const Corner& corner : star) {
            if (angle < before + corner.angle)
                return point_of(corner, std::polar(std::abs(zero), angle - before) * corner.along_next);
            before += corner.angle;
        }
        return {};
    }

    /// The place that lies at @p offset from a corner of a face; nothing outside the face.
    std::optional<MeshPoint> point_of(const Corner& corner, Complex offset) const {
        const std::vector<Complex>& q = faces_[corner.face].corners;
        const Complex at = q[corner.position] + offset;
        std::vector<std::array<int, 3>> triangles{{0, 1, 2}};
        if (q.size() == 4) {
            std::array<Eigen::Vector3d, 4> points;
            for (int j = 0; j < 4; ++j) points[j] = {q[j].real(), q[j].imag(), 0};
            const auto halves = split_quad(points);
            triangles.assign(halves.begin(), halves.end());
        }
        for (const auto& t : triangles) {
            const auto weights = barycentric({q[t[0]], q[t[1]], q[t[2]]}, at);
            if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight >= 0; }))
                return corner_point(corner.face, t, weights);
        }
        return {};
    }

    const Surface& source_;
    const std::vector<int>& poles_;
    double most_imaginary_;
    std::vector<LaidOutFace> faces_;
    std::vector<std::vector<Corner>> stars_;  ///< of every vertex
};

}  // namespace

std::vector<CriticalPoint> zeros_and_poles_of_table(const Surface& source, const Eigen::VectorXcd& phi,
                                                    const std::vector<int>& poles, bool real) {
    return Table(source, phi, poles, real).search();
}

}  // namespace beltrami
