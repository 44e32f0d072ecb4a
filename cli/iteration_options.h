#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

#include <beltrami/baselines/baseline.h>
#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/least_maximum.h>

namespace beltrami::cli {

/// --tolerance, --max-iterations, --evening and --p: when an iteration stops and what comes after it. What is not given
/// is as the method has it.
class IterationOptions {
  public:
    void add_to(CLI::App& app);
    /// What the command line asks of these options.
    struct Use {
        std::string method;  ///< "extremal" or that of --method
        bool slides;         ///< the boundary, with --onto
    };
    /// @throw Error bad_option naming an option that the method has not
    void check(const Use& use) const;
    /// --p where nothing is minimised but K after all. @throw Error bad_option
    void require_no_power() const;

    void apply(ExtremalOptions& options) const;
    /// The extremal map's own tolerance is left alone: it is where the map of least maximum begins.
    void apply(LeastMaximumOptions& options) const;
    void apply(BaselineOptions& options) const;

  private:
    std::optional<double> tolerance_, power_;
    std::optional<int> max_iterations_;
    std::optional<std::string> evening_;
};

}  // namespace beltrami::cli
