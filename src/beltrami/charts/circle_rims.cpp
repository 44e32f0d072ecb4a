#include <beltrami/charts/circle_rims.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <beltrami/base/constants.h>

namespace beltrami {

namespace {

constexpr double kLeastShare = 0.2;        // of an increment in proportion to the edge's length
constexpr int kNearby = 4;                 // edges on either side with which one is compared
constexpr double kLeastLength = 1e-4;      // of an edge against those nearby
constexpr double kLeastIncrement = 0.1;    // of the old increment
constexpr double kAtLeast = 1.01;          // of the least increment: as good as it
constexpr double kLargestIncrement = 2.0;  // radians
constexpr double kShortIncrement = 0.02;   // of the mean one: vertices beside such are not held

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

/// For every edge of a rim a part of the angle that is its due by length among the edges nearby. The conformal map
/// gives a long bay little of the circle, but a spike of one or two edges no less than that here: nearby, since along
/// the walls of a slot increments are 1e-12 of the mean one, and are right.
std::vector<double> least_increments(const std::vector<double>& lengths, const std::vector<double>& increments) {
    const int n = static_cast<int>(lengths.size());
    std::vector<double> least(n);
    for (int i = 0; i < n; ++i) {
        double length = lengths[i], angle = increments[i];
        for (int away = 1; 2 * away < n && (away <= kNearby || !(angle > 0)); ++away)
            for (const int k : {(i + away) % n, (i + n - away) % n}) {
                length += lengths[k];
                angle += increments[k];
            }
        least[i] = kLeastShare * angle / length * std::max(lengths[i], kLeastLength * length);
    }
    return least;
}

/// The vertex @p first, or where edges are very short there, as meshes graded to a boundary point have them, the one of
/// the next few between the longest edges. The polygon has less area than the circle, by the cubes of its edges, so the
/// energy pulls on the vertices that are held: neighbours much nearer than the pull is strong would be crushed.
/// @param until angle, last index before which that is
int sturdy(const CircleRim& rim, int first, double until, int last) {
    const auto shorter = [&](int i) {
        return std::min(rim.increment(i), rim.increment(i > 0 ? i - 1 : rim.size() - 1));
    };
    if (shorter(first) >= kShortIncrement * 2 * kPi / rim.size()) return first;
    int best = first;
    for (int i = first; i < last && rim.angles[i] < until; ++i)
        if (shorter(i) > shorter(best)) best = i;
    return best;
}

}  // namespace

double CircleRim::increment(int i) const {
    return i + 1 < size() ? angles[i + 1] - angles[i] : angles[0] + 2 * kPi - angles[i];
}

std::vector<CircleRim> rims_of(const Surface& surface, int outer_loop, const std::vector<RoundHole>& holes) {
    std::vector<CircleRim> rims;
    int hole = 0, first = 0;
    for (int l = 0; l < static_cast<int>(surface.topology.boundary_loops.size()); ++l) {
        CircleRim rim;
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

void read_angles(CircleRim& rim, const Eigen::VectorXcd& z) {
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

void choose_angles(CircleRim& rim, const Eigen::VectorXcd& z) {
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

Eigen::VectorXcd rim_positions(const std::vector<CircleRim>& rims, Eigen::Index vertices) {
    Eigen::VectorXcd z = Eigen::VectorXcd::Zero(vertices);
    for (const CircleRim& rim : rims)
        for (int i = 0; i < rim.size(); ++i) z[rim.vertices[i]] = rim.position(i);
    return z;
}

std::vector<RoundHole> holes_of(const std::vector<CircleRim>& rims, int outer_loop) {
    std::vector<RoundHole> holes;
    for (int l = 0; l < static_cast<int>(rims.size()); ++l)
        if (l != outer_loop) holes.push_back({l, rims[l].centre, rims[l].radius});
    return holes;
}

void hold_three(CircleRim& outer) {
    const double third = 2 * kPi / 3;
    int held = 0;
    for (int i = 0; i < outer.size() && held < 3; ++i) {
        if (outer.angles[i] - outer.angles[0] < held * third - 1e-12 && outer.size() - i > 3 - held) continue;
        ++held;
        i = sturdy(outer, i, outer.angles[0] + held * third, outer.size() - (3 - held));
        outer.held[i] = 1;
    }
}

void project(const std::vector<CircleRim>& rims, Eigen::VectorXd& unknowns) {
    for (const CircleRim& rim : rims) {
        const int n = rim.size();
        if (n == 0) continue;
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

std::vector<CircleRim> moved(std::vector<CircleRim> rims, const Eigen::VectorXd& step, double length) {
    const int circles = rims.back().first + rims.back().size();
    for (CircleRim& rim : rims) {
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

int release(std::vector<CircleRim>& rims, const Eigen::VectorXcd& force) {
    int count = 0;
    for (CircleRim& rim : rims) {
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

}  // namespace beltrami
