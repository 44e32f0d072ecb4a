#include "iteration_options.h"

#include <beltrami/base/error.h>

namespace beltrami::cli {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& why) {
    throw Error(Cause::bad_option, option + " " + why, "leave it out");
}

template <class Value>
void set(Value& value, const std::optional<Value>& given) {
    if (given) value = *given;
}

}  // namespace

void IterationOptions::add_to(CLI::App& app) {
    app.add_option("--tolerance", tolerance_,
                   "stop when an iteration changes the result by less: the extremal map k and the direction of phi "
                   "(default 1e-8, smooth phi 1e-5; with --onto 1e-6, k by a hundredth of it), --minimize max the "
                   "energy as Newton's method predicts it (1e-6), other methods the root of their energy's change "
                   "(1e-5; of alternation "
                   "this is epsilon)")
        ->type_name("T");
    app.add_option("--max-iterations", max_iterations_,
                   "at most so many: linear solves of the extremal map (default 60), Newton steps of --minimize max, "
                   "steps of other methods (1000)")
        ->check(CLI::PositiveNumber)
        ->type_name("N");
    app.add_option("--evening", evening_,
                   "even |mu| out after the iteration: where-needed, where boundary values are prescribed and the map "
                   "is still far "
                   "from constant |mu| (the default), always or never")
        ->check(CLI::IsMember({"where-needed", "always", "never"}));
    app.add_option("--p", power_,
                   "of --minimize max: the power mean of the last stage, at least 1 (default 128); a larger one comes "
                   "nearer to the least maximum")
        ->type_name("P");
}

void IterationOptions::check(const Use& use) const {
    const bool extremal = use.method == "extremal";
    if (use.method == "harmonic" || use.method == "lscm") {
        if (tolerance_) refuse("--tolerance", "says nothing about --method " + use.method + ", one linear solve");
        if (max_iterations_)
            refuse("--max-iterations", "says nothing about --method " + use.method + ", one linear solve");
    }
    if (evening_ && !extremal) refuse("--evening", "belongs to --method extremal");
    if (power_ && (!extremal || use.slides)) refuse("--p", "belongs to --minimize max");
    if (tolerance_ && !(*tolerance_ > 0 && *tolerance_ < 1))
        throw Error(Cause::bad_option, "--tolerance must lie between 0 and 1", "give a number such as 1e-6");
    if (power_ && !(*power_ >= 1 && *power_ <= 1e6))
        throw Error(Cause::bad_option, "--p must lie between 1 and 1e6", "give a number such as 128");
}

void IterationOptions::require_no_power() const {
    if (power_) refuse("--p", "belongs to --minimize max");
}

void IterationOptions::apply(ExtremalOptions& options) const {
    set(options.tolerance, tolerance_);
    set(options.max_iterations, max_iterations_);
    using Evening = ExtremalOptions::Evening;
    if (evening_)
        options.evening = *evening_ == "always"  ? Evening::always
                          : *evening_ == "never" ? Evening::never
                                                 : Evening::where_needed;
}

void IterationOptions::apply(LeastMaximumOptions& options) const {
    set(options.power, power_);
    set(options.tolerance, tolerance_);
    set(options.max_iterations, max_iterations_);
    IterationOptions start;
    start.evening_ = evening_;
    start.apply(options.extremal);
}

void IterationOptions::apply(BaselineOptions& options) const {
    set(options.tolerance, tolerance_);
    set(options.max_iterations, max_iterations_);
}

}  // namespace beltrami::cli
