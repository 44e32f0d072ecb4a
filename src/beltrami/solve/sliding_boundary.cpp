#include <beltrami/solve/sliding_boundary.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

/// A step leaves at least this part of an increment, and never less than that part of what the source's edge has.
constexpr double kLeastPart = 0.1, kFloorOfGaps = 1e-3;
/// Where no vertex of a loop is held, nor less than this part of what its length gives it among so many on either side;
/// next to held vertices increments may fall as fast as they like.
constexpr double kLeastOfNeighbours = 0.3;
constexpr int kAround = 1;
/// The largest increment, as part of a whole turn; where a loop or an arc has few vertices, this multiple of the mean
/// one.
constexpr double kMostOfTurn = 1 / std::numbers::pi, kMostOfMean = 1.5;
/// Corners that turn by more (radians) hold vertices.
constexpr double kSharp = 0.35;
/// Parameters nearer to a corner, as part of the length, are at it.
constexpr double kAtCorner = 1e-12;
/// What holds a vertex in a linear solve: far more than any diagonal entry, which is a sum of cotangents.
constexpr double kHold = 1e6;

/// Runs @p visit for the arcs between held vertices, (first, last) positions in order, last counted on beyond the
/// loop's size; one arc from 0 to its size if none is held.
template <typename Visit>
void for_arcs(const std::vector<char>& held, Visit visit) {
    const int n = static_cast<int>(held.size());
    const auto start = std::find(held.begin(), held.end(), 1);
    if (start == held.end()) {
        visit(0, n);
        return;
    }
    const int first = static_cast<int>(start - held.begin());
    for (int i = first; i < first + n;) {
        int j = i + 1;
        while (!held[j % n]) ++j;
        visit(i, j);
        i = j;
    }
}

/// What the increment at a position is at least, by its edge's length, of those around it: where the map has little to
/// go by, as at notches of an edge or two, steps would crush single edges.
double least_by_neighbours(const Surface& source, const SlidingLoop& loop, int position) {
    const std::vector<double>& lengths = source.boundary_edge_lengths[loop.loop];
    const int n = static_cast<int>(lengths.size());
    double length = 0, increments = 0;
    for (int away = -kAround; away <= kAround; ++away) {
        const int i = ((position + away) % n + n) % n;
        length += lengths[i];
        increments += loop.increment(i);
    }
    return kLeastOfNeighbours * increments / length * lengths[position];
}

}  // namespace

double SlidingLoop::increment(int i) const {
    const int n = static_cast<int>(parameters.size()), at = i % n;
    return at + 1 < n ? parameters[at + 1] - parameters[at] : parameters[0] + curve.length() - parameters[at];
}

std::vector<double> guarded_increments(std::vector<double> wanted, const std::vector<double>& least,
                                       const std::vector<double>& most) {
    double excess = 0, below = 0, above = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const double held = std::clamp(wanted[i], least[i], most[i]);
        excess += wanted[i] - held;
        wanted[i] = held;
        below += held - least[i];
        above += most[i] - held;
    }
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (excess < 0 && below > 0) wanted[i] += excess * (wanted[i] - least[i]) / below;
        if (excess > 0 && above > 0) wanted[i] += excess * (most[i] - wanted[i]) / above;
    }
    return wanted;
}

SlidingBoundary::SlidingBoundary(const Surface& source, std::vector<SlidingLoop> loops, BoundaryCondition prescribed)
    : source_(source), loops_(std::move(loops)), prescribed_(std::move(prescribed)) {
    validate(prescribed_, source);
    const auto& boundary = source.topology.boundary_loops;
    std::vector<char> seen(boundary.size(), 0);
    for (const SlidingLoop& l : loops_) {
        const std::string name = "boundary loop " + std::to_string(l.loop);
        if (l.loop < 0 || l.loop >= static_cast<int>(boundary.size()) || seen[l.loop])
            throw Error(Cause::bad_boundary, name + " does not exist or slides twice");
        seen[l.loop] = 1;
        const std::size_t n = boundary[l.loop].size();
        if (l.parameters.size() != n || l.held.size() != n)
            throw Error(Cause::bad_boundary, name + " has " + std::to_string(n) +
                                                 " vertices, parameters are given for " +
                                                 std::to_string(l.parameters.size()));
        for (std::size_t i = 0; i < n; ++i) {
            const double next = i + 1 < n ? l.parameters[i + 1] : l.parameters[0] + l.curve.length();
            if (!(next > l.parameters[i]))
                throw Error(Cause::bad_boundary,
                            name + ": the places of its vertices on the target curve do not follow each other",
                            "start from a map that keeps the order of the boundary vertices",
                            {Things::vertices, {boundary[l.loop][i]}});
        }
        Rim& rim = rims_.emplace_back();
        const auto& lengths = source.boundary_edge_lengths[l.loop];
        double whole = 0;
        for (const double length : lengths) whole += length;
        for (const double length : lengths) rim.floors.push_back(kFloorOfGaps * l.curve.length() * length / whole);
        rim.corners = l.curve.corners(kSharp);
        rim.stuck.assign(n, 0);
        rim.base.assign(n, 0.0);
        rim.directions.assign(n, 0.0);
    }
    require_whole_boundary(seen);
}

/// @param slides of every loop
void SlidingBoundary::require_whole_boundary(const std::vector<char>& slides) const {
    std::vector<char> is_prescribed(source_.mesh.vertex_count(), 0);
    for (const int v : prescribed_.vertices) is_prescribed[v] = 1;
    for (std::size_t l = 0; l < slides.size(); ++l)
        for (const int v : source_.topology.boundary_loops[l])
            if (!slides[l] && !is_prescribed[v])
                throw Error(Cause::bad_boundary, "boundary loop " + std::to_string(l) + " has no target curve",
                            "give it one, or prescribe all of its vertices", {Things::vertices, {v}});
    for (const SlidingLoop& l : loops_) {
        const auto& vertices = source_.topology.boundary_loops[l.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (is_prescribed[vertices[i]] && !l.held[i])
                throw Error(Cause::bad_boundary,
                            "vertex " + std::to_string(vertices[i]) + " is prescribed and slides along its curve",
                            "hold it, or leave it out of what is prescribed", {Things::vertices, {vertices[i]}});
    }
}

std::vector<Freedom> SlidingBoundary::freedoms() const {
    std::vector<Freedom> result(source_.mesh.vertex_count(), Freedom::fixed);
    for (const int v : source_.mesh.faces.vertices()) result[v] = Freedom::free;
    for (const SlidingLoop& l : loops_) {
        const auto& vertices = source_.topology.boundary_loops[l.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i)
            result[vertices[i]] = l.held[i] ? Freedom::fixed : Freedom::sliding;
    }
    for (const int v : prescribed_.vertices) result[v] = Freedom::fixed;
    for (const auto& line : prescribed_.lines) result[line.vertex] = Freedom::sliding;
    return result;
}

void SlidingBoundary::place(Eigen::VectorXcd& map) const {
    for (const SlidingLoop& l : loops_) {
        const auto& vertices = source_.topology.boundary_loops[l.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i) map[vertices[i]] = l.curve.point(l.parameters[i]);
    }
    for (std::size_t i = 0; i < prescribed_.vertices.size(); ++i) map[prescribed_.vertices[i]] = prescribed_.images[i];
    for (const auto& line : prescribed_.lines) {
        const Complex along = line.direction / std::abs(line.direction);
        map[line.vertex] = line.point + along * std::real(std::conj(along) * (map[line.vertex] - line.point));
    }
}

SlidingBoundary::Linearized SlidingBoundary::linearized(const Eigen::VectorXcd& force) {
    Linearized result{Eigen::VectorXcd::Zero(source_.mesh.vertex_count()),
                      Eigen::VectorXd::Zero(source_.mesh.vertex_count())};
    for (std::size_t r = 0; r < loops_.size(); ++r) {
        const SlidingLoop& l = loops_[r];
        Rim& rim = rims_[r];
        const double at_corner = kAtCorner * l.curve.length();
        const auto& vertices = source_.topology.boundary_loops[l.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const int v = vertices[i];
            const double s = l.curve.wrap(l.parameters[i]);
            const CurvePlace place = l.curve.at(s);
            Complex tangent = place.tangent;
            rim.stuck[i] = 0;
            for (const double corner : rim.corners) {
                const double ahead = l.curve.ahead(corner, s);
                if (std::min(ahead, l.curve.length() - ahead) > at_corner) continue;
                // The energy falls along a side if its force points the other way.
                const Complex out = l.curve.tangent(corner), in = l.curve.tangent_before(corner);
                const double along_out = std::real(std::conj(force[v]) * out),
                             along_in = std::real(std::conj(force[v]) * in);
                if (along_out < 0 && -along_out >= along_in) {
                    tangent = out;
                } else if (along_in > 0) {
                    tangent = in;
                } else {
                    rim.stuck[i] = 1;
                }
            }
            rim.base[i] = place.point;
            rim.directions[i] = tangent;
            result.directions[v] = tangent;
            result.extra_diagonal[v] = rim.stuck[i] ? kHold : std::real(std::conj(force[v]) * place.curvature);
        }
    }
    for (const auto& line : prescribed_.lines)
        result.directions[line.vertex] = line.direction / std::abs(line.direction);
    return result;
}

double SlidingBoundary::advance(const Eigen::VectorXcd& moved) {
    double largest = 0;
    for (std::size_t r = 0; r < loops_.size(); ++r) {
        SlidingLoop& l = loops_[r];
        const Rim& rim = rims_[r];
        const auto& vertices = source_.topology.boundary_loops[l.loop];
        const int n = static_cast<int>(vertices.size());
        if (n == 0) continue;
        const double length = l.curve.length(), at_corner = kAtCorner * length;
        std::vector<double> step(n, 0.0);
        for (int i = 0; i < n; ++i) {
            if (l.held[i] || rim.stuck[i]) continue;
            double by = std::real(std::conj(rim.directions[i]) * (moved[vertices[i]] - rim.base[i]));
            // To the next sharp corner, and no farther.
            for (const double corner : rim.corners) {
                const double ahead = l.curve.ahead(l.parameters[i], corner), behind = length - ahead;
                if (by > ahead && ahead > at_corner && behind > at_corner) by = ahead;
                if (-by > behind && ahead > at_corner && behind > at_corner) by = -behind;
            }
            step[i] = by;
        }
        std::vector<double> next = l.parameters;
        for_arcs(l.held, [&](int first, int last) {
            const int count = last - first;
            const bool whole = !l.held[first % n];
            std::vector<double> wanted(count), least(count), most(count);
            double sum = 0, room = 0;
            for (int i = first; i < last; ++i) sum += l.increment(i);
            bool fine = true;
            for (int i = first; i < last; ++i) {
                const double present = l.increment(i);
                double& want = wanted[i - first];
                want = present + step[(i + 1) % n] - step[i % n];
                const double floor =
                    whole ? std::max(rim.floors[i % n], least_by_neighbours(source_, l, i % n)) : rim.floors[i % n];
                least[i - first] = std::max(kLeastPart * present, std::min(floor, present));
                most[i - first] = std::max({present, kMostOfTurn * length, kMostOfMean * sum / count});
                room += least[i - first];
                fine = fine && want >= least[i - first] && want <= most[i - first];
            }
            if (!fine && room < sum) {
                wanted = guarded_increments(std::move(wanted), least, most);
            } else if (!fine) {
                for (int i = first; i < last; ++i) wanted[i - first] = l.increment(i);
            }
            // Without a held vertex the mean movement is kept.
            double at = l.parameters[first % n];
            if (whole) {
                double mean = 0, drift = 0, run = 0;
                for (int i = 0; i < n; ++i) {
                    mean += step[i] / n;
                    drift += (run - (l.parameters[i] - l.parameters[0])) / n;
                    run += wanted[i];
                }
                at += fine ? step[0] : mean - drift;
            }
            double turns = 0;  // of the parameters at the loop's end
            for (int i = first; i < last; ++i) {
                if (!l.held[i % n]) next[i % n] = at - turns;
                at += wanted[i - first];
                if (i % n == n - 1) turns = length;
            }
        });
        for (int i = 0; i < n; ++i) largest = std::max(largest, std::abs(next[i] - l.parameters[i]) / length);
        l.parameters = std::move(next);
    }
    return largest;
}

void SlidingBoundary::move(BoundaryCondition prescribed, const std::vector<SlidingLoop>& places) {
    std::vector<char> moves(source_.mesh.vertex_count(), 0);
    for (std::size_t i = 0; i < prescribed.vertices.size(); ++i)
        moves[prescribed.vertices[i]] = prescribed.images[i] != prescribed_.images[i];
    prescribed_ = std::move(prescribed);
    for (SlidingLoop& l : loops_) {
        const auto& vertices = source_.topology.boundary_loops[l.loop];
        if (std::none_of(vertices.begin(), vertices.end(), [&](int v) { return moves[v]; })) continue;
        const SlidingLoop& to =
            *std::find_if(places.begin(), places.end(), [&](const SlidingLoop& at) { return at.loop == l.loop; });
        const int n = static_cast<int>(vertices.size());
        std::vector<double> next(n);
        for_arcs(to.held, [&](int first, int last) {
            double wanted = 0, present = 0;
            for (int i = first; i < last; ++i) {
                wanted += to.increment(i);
                present += l.increment(i);
            }
            double at = to.parameters[first % n], turns = 0;
            for (int i = first; i < last; ++i) {
                next[i % n] = at - turns;
                at += l.increment(i) * wanted / present;
                if (i % n == n - 1) turns = l.curve.length();
            }
        });
        l.parameters = std::move(next);
    }
}

BoundaryCondition SlidingBoundary::in_place() const {
    BoundaryCondition result = prescribed_;
    std::vector<char> is_prescribed(source_.mesh.vertex_count(), 0);
    for (const int v : prescribed_.vertices) is_prescribed[v] = 1;
    for (const SlidingLoop& l : loops_) {
        const auto& vertices = source_.topology.boundary_loops[l.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (!is_prescribed[vertices[i]]) result.pin(vertices[i], l.curve.point(l.parameters[i]));
    }
    return result;
}

void SlidingBoundary::adopt(const Eigen::VectorXcd& map) {
    for (SlidingLoop& l : loops_) {
        const auto& vertices = source_.topology.boundary_loops[l.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            if (l.held[i] || map[vertices[i]] == l.curve.point(l.parameters[i])) continue;
            const double s = l.curve.nearest(map[vertices[i]], l.parameters[i]);
            l.parameters[i] += std::remainder(s - l.parameters[i], l.curve.length());
        }
    }
}

double SlidingBoundary::least_increment() const {
    double least = std::numeric_limits<double>::infinity();
    for (const SlidingLoop& l : loops_) {
        const int n = static_cast<int>(l.parameters.size());
        for (int i = 0; i < n; ++i) least = std::min(least, l.increment(i) * n / l.curve.length());
    }
    return least;
}

}  // namespace beltrami
