#include "sphere_option.h"

namespace beltrami::cli {

void SphereMethodOption::add_to(CLI::App& app) {
    app.add_option("--method", name_,
                   "of a closed surface: equivalence (the default; conformal equivalence), distortion (least mean "
                   "distortion on this mesh) or tutte (means of neighbours, not conformal)")
        ->check(CLI::IsMember({"equivalence", "distortion", "tutte"}));
}

SphereMapOptions SphereMethodOption::options() const {
    SphereMapOptions options;
    if (name_ == "distortion") options.method = SphereMethod::least_distortion;
    if (name_ == "tutte") options.method = SphereMethod::tutte;
    return options;
}

}  // namespace beltrami::cli
