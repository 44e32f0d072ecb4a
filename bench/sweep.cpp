// Extremal maps of random problems, checked against what is known of each.
//
//     bench_sweep [FIRST_SEED [COUNT]]        default: 0 200
//
// A problem has a witness (random_problem.h): a piecewise linear map of the same mesh without flips and with these
// boundary values. So the map must have no flips, K_lower must not exceed the witness' largest K nor the map's own, and
// the boundary must be obeyed. Prints every seed that breaks one of these, then counts; the exit code is 1 if there was
// one.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <beltrami/beltrami.h>

#include "arguments.h"
#include "problems/feasibility.h"
#include "problems/random_problem.h"

int main(int argc, char** argv) {
    using namespace beltrami;
    const std::vector<int> given = bench::numbers_of(argc, argv, 0, {0}, "bench_sweep [FIRST_SEED [COUNT]]");
    const int first = given[0], count = given.size() > 1 ? given[1] : 200;
    std::map<std::string, int> refused;
    int solved = 0, broken = 0, flipped = 0, unfinished = 0, below_bound = 0, other_class = 0;
    double seconds = 0;
    for (int seed = first; seed < first + count; ++seed) {
        const bench::Problem problem = bench::random_problem(seed);
        const double K_witness = dilatation(bench::map_quality(problem, *problem.witness).max_mu);
        const auto start = std::chrono::steady_clock::now();
        try {
            const ExtremalMap found = extremal_map(problem.mesh, problem.boundary);
            seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            ++solved;
            const bench::MapQuality quality = bench::map_quality(problem, found.map);
            // Of the mesh that was mapped, on which no edge between prescribed vertices is left.
            const std::size_t flips = found.distortion.flipped.size() + found.distortion.degenerate.size();
            flipped += flips > 0;
            unfinished += found.termination == Termination::iteration_limit;
            below_bound += found.termination == Termination::below_bound;
            const auto turns = flips > 0 ? std::vector<int>{}
                                         : bench::relative_turns(problem, found.map.head(problem.mesh.vertex_count()),
                                                                 *problem.witness);
            const bool turned = std::any_of(turns.begin(), turns.end(), [](int t) { return t != 0; });
            other_class += turned;
            const bool above = found.K_lower > std::min(found.K_max, turned ? found.K_max : K_witness) * (1 + 1e-6);
            const bool bad = flips > 0 || above || quality.pin_error > 1e-9;
            broken += bad;
            if (bad)
                fmt::print(
                    "{}: {} flips of {}, K_lower {:.4f}, K {:.4f}, K_max {:.4f}, witness {:.4f}, residual {:.1e} "
                    "({})\n",
                    problem.name, flips, problem.mesh.face_count(), found.K_lower, found.K, found.K_max, K_witness,
                    quality.pin_error, problem.statement);
        } catch (const Error& error) {
            // Numbers differ from case to case: the words before the first one name the reason.
            const std::string sentence = error.what();
            ++refused[sentence.substr(0, sentence.find_first_of("0123456789:"))];
        }
        std::fflush(stdout);
    }
    fmt::print(
        "{} problems: {} solved in {:.1f} s, {} broken, {} with flips, {} at the iteration limit, {} below a proved "
        "bound, {} with other "
        "turns than the witness\n",
        count, solved, seconds, broken, flipped, unfinished, below_bound, other_class);
    for (const auto& [reason, times] : refused) fmt::print("refused {} times: {}\n", times, reason);
    return broken > 0 ? 1 : 0;
}
