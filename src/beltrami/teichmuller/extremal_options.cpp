#include <beltrami/teichmuller/extremal_options.h>

#include <cmath>

#include <beltrami/base/error.h>

namespace beltrami {

void ExtremalOptions::validate() const {
    IterationOptions::validate();
    const auto demand = [](bool holds, const char* sentence) {
        if (!holds) throw Error(Cause::bad_option, sentence);
    };
    demand(growth > 0, "growth must be positive");
    demand(cluster_count >= 100, "cluster_count must be at least 100");
    demand(slack >= 0 && std::isfinite(slack), "slack must be finite and not negative");
    demand(target_edge_length >= 0 && std::isfinite(target_edge_length),
           "the target's edge length must be positive, or 0");
    for (const double turn : start_turns) demand(std::isfinite(turn), "a start turn is not a number");
}

const char* to_string(ExtremalOptions::Space space) {
    switch (space) {
        case ExtremalOptions::Space::automatic:
            return "automatic";
        case ExtremalOptions::Space::laurent:
            return "laurent";
        case ExtremalOptions::Space::projection:
            return "projection";
        case ExtremalOptions::Space::one_form_squares:
            return "one_form_squares";
    }
    return "";
}

}  // namespace beltrami
