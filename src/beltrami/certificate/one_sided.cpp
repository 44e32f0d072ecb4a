#include <beltrami/certificate/one_sided.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/linear/element_system.h>

namespace beltrami {

namespace {

constexpr int kSteps = 8;     // of one stage
constexpr int kDampings = 6;  // tried in a step
constexpr double kFirstDamping = 1e-2, kLeastDamping = 1e-9, kMoreDamping = 8, kLessDamping = 4;
constexpr double kShortest = 0.05;  // step of the line search
/// κ falls by so much of the excess in a stage, and the target of the squares lies so far inside.
constexpr double kStage = 0.6, kMargin = 0.15;
/// Where a stage gains too little the next ones ask for less, so often.
constexpr int kGentler = 2;
/// Unknowns of one sample: of six nodes.
constexpr std::size_t kMostUnknowns = 12;
/// Maps that fold begin here.
constexpr double kFromFolds = 0.95;

double largest_of(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
}

}  // namespace

OneSidedDescent::OneSidedDescent(const Surface& source, const QuadraticSpace& space, std::vector<char> held)
    : source_(source), space_(space), held_(std::move(held)), faces_at_(static_cast<std::size_t>(space.node_count())) {
    for (int n = 0; n < space.node_count(); ++n)
        if (space.idle()[n]) held_[n] = 1;
    for (int f = 0; f < source.mesh.face_count(); ++f)
        for (const int node : space.samples().stencil(space.first_sample(f))) faces_at_[node].push_back(f);
}

double OneSidedDescent::run(QuadraticMap& map, const Options& options) {
    std::vector<double> bounds = space_.bounds(map);
    double largest = largest_of(bounds);
    double step = kStage;
    int gentler = 0;
    for (int stage = 0; stage < options.most_stages && largest > options.wanted; ++stage) {
        const double start = std::min(largest, kFromFolds);
        if (!(start > options.least)) break;
        const double target = std::max(0.9997 * options.wanted, options.least + step * (start - options.least));
        const double inner = target - kMargin * std::max(0.0, target - options.least);
        QuadraticMap next = map;
        const bool moved = descend(next, bounds, target, inner, options.rings);
        if (!moved && gentler >= kGentler) break;
        std::vector<double> next_bounds = space_.bounds(next);
        const double reached = largest_of(next_bounds);
        const double gain = (largest - reached) / (largest - options.least);
        if (reached < largest || (std::isinf(largest) && !(reached > largest))) {
            map = std::move(next);
            bounds = std::move(next_bounds);
            largest = reached;
        }
        if (std::isfinite(largest) && !(gain >= options.least_gain)) {
            if (++gentler > kGentler) break;
            step = 0.5 * (1 + step);
        }
    }
    return largest;
}

bool OneSidedDescent::descend(QuadraticMap& map, const std::vector<double>& bounds, double target, double inner,
                              int rings) {
    const Operators& samples = space_.samples();
    // The triangles that are to change, and those around them.
    std::vector<char> chosen(bounds.size(), 0);
    for (std::size_t f = 0; f < bounds.size(); ++f) chosen[f] = !(bounds[f] <= inner);
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<char> wider = chosen;
        for (const auto& faces : faces_at_)
            if (std::any_of(faces.begin(), faces.end(), [&](int f) { return chosen[f]; }))
                for (const int f : faces) wider[f] = 1;
        chosen = std::move(wider);
    }
    std::vector<int> unknown(static_cast<std::size_t>(space_.node_count()), -1), faces;
    int count = 0;
    for (std::size_t n = 0; n < unknown.size(); ++n)
        if (!held_[n] && !faces_at_[n].empty() &&
            std::all_of(faces_at_[n].begin(), faces_at_[n].end(), [&](int f) { return chosen[f]; }))
            unknown[n] = count++;
    if (count == 0) return false;
    std::vector<int> offsets{0}, unknowns;
    for (std::size_t f = 0; f < chosen.size(); ++f) {
        const auto nodes = samples.stencil(space_.first_sample(static_cast<int>(f)));
        if (std::none_of(nodes.begin(), nodes.end(), [&](int n) { return unknown[n] >= 0; })) continue;
        faces.push_back(static_cast<int>(f));
        for (const int n : nodes) unknowns.push_back(unknown[n]);
        offsets.push_back(static_cast<int>(unknowns.size()));
    }
    ElementSystem system(std::move(offsets), std::move(unknowns), count, kSteps, 2);
    ElementSystem::Values squares(system), damping(system);
    Eigen::VectorXd force(2 * count);
    double mean = 0;
    for (const double weight : samples.weights) mean += weight / samples.sample_count();

    struct State {
        double energy = 0, largest = 0;
        int upright = 0;
        State operator+(const State& other) const {
            return {energy + other.energy, std::max(largest, other.largest), upright + other.upright};
        }
        State& operator+=(const State& other) { return *this = *this + other; }
    };
    // scale: |∂f|² + |∂̄f|² at the beginning of a step, by sample.
    std::vector<double> scale(static_cast<std::size_t>(samples.sample_count()), 1.0);
    const auto look = [&](const QuadraticMap& at) {
        return parallel_sum(
            static_cast<int>(faces.size()), State{},
            [&](int first, int last) {
                State state;
                for (int i = first; i < last; ++i)
                    for (int s = space_.first_sample(faces[i]); s < space_.first_sample(faces[i] + 1); ++s) {
                        const auto [dz, dzbar] = samples.derivatives(s, at);
                        const double a = std::abs(dz), b = std::abs(dzbar), over = std::max(0.0, b - inner * a);
                        state.energy += samples.weights[s] / mean * over * over / scale[s];
                        state.largest = std::max(state.largest, b / std::max(a, 1e-300));
                        state.upright += a > b;
                    }
                return state;
            },
            1024);
    };
    double lambda = kFirstDamping;
    bool moved = false;
    for (int step = 0; step < kSteps; ++step) {
        squares.clear();
        damping.clear();
        force.setZero();
        State before;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const auto own = system.nodes(static_cast<int>(i));
            for (int s = space_.first_sample(faces[i]); s < space_.first_sample(faces[i] + 1); ++s) {
                const auto [dz, dzbar] = samples.derivatives(s, map);
                const auto g = samples.gradient(s);
                const double a = std::abs(dz), b = std::abs(dzbar), weight = samples.weights[s] / mean;
                scale[s] = std::norm(dz) + std::norm(dzbar);
                const double over = std::max(0.0, b - inner * a);
                before.energy += weight * over * over / scale[s];
                before.largest = std::max(before.largest, b / std::max(a, 1e-300));
                before.upright += a > b;
                const int n = static_cast<int>(g.size());
                std::array<double, kMostUnknowns> row{};
                if (over > 0) {
                    const Complex to_b = std::conj(dzbar) / b, to_a = a > 0 ? std::conj(dz) / a : Complex(0);
                    const double root = std::sqrt(scale[s]);
                    for (int j = 0; j < n; ++j) {
                        const Complex c = 0.5 * (to_b * g[j] - inner * to_a * std::conj(g[j])) / root;
                        row[2 * j] = c.real();
                        row[2 * j + 1] = -c.imag();
                        if (own[j] >= 0)
                            for (int part = 0; part < 2; ++part)
                                force[2 * own[j] + part] += weight * row[2 * j + part] * over / root;
                    }
                }
                const double stiff = 0.5 * weight / scale[s];
                std::array<double, kMostUnknowns*(kMostUnknowns + 1) / 2> square, damp;
                std::size_t entries = 0;
                for (int j = 0; j < 2 * n; ++j)
                    for (int l = 0; l <= j; ++l, ++entries) {
                        square[entries] = weight * row[j] * row[l];
                        damp[entries] = j % 2 == l % 2 ? stiff * std::real(std::conj(g[j / 2]) * g[l / 2]) : 0.0;
                    }
                if (over > 0) system.add(static_cast<int>(i), {square.data(), entries}, squares);
                system.add(static_cast<int>(i), {damp.data(), entries}, damping);
            }
        }
        if (before.largest <= target || !(before.energy > 0) || !std::isfinite(before.energy)) break;
        bool found = false;
        QuadraticMap next;
        for (int trial = 0; trial < kDampings && !found; ++trial) {
            system.set(squares, lambda, damping);
            Eigen::VectorXd direction;
            try {
                system.factorize();
                ++factorizations_;
                direction = -system.solve(force);
            } catch (const Error&) {
                lambda *= kMoreDamping;
                continue;
            }
            for (double t = 1; t > kShortest && !found; t /= 2) {
                next = map;
                for (std::size_t n = 0; n < unknown.size(); ++n)
                    if (unknown[n] >= 0)
                        next[n] += t * Complex(direction[2 * unknown[n]], direction[2 * unknown[n] + 1]);
                const State after = look(next);
                found = after.upright >= before.upright && after.energy < before.energy * (1 - 0.1 * t);
            }
            if (!found) lambda *= kMoreDamping;
        }
        if (!found) break;
        map = std::move(next);
        moved = true;
        lambda = std::max(lambda / kLessDamping, kLeastDamping);
    }
    return moved;
}

}  // namespace beltrami
