#include "phi_option.h"

#include <beltrami/io/atomic_file.h>
#include <beltrami/report/differential_file.h>

namespace beltrami::cli {

void PhiOption::add_to(CLI::App& app) {
    app.add_option("--phi", path_,
                   "write the quadratic differential of the extremal map to FILE as JSON: mu and phi of every face, in "
                   "the frame whose real axis is its first edge, and the zeros and poles of phi with their faces")
        ->type_name("FILE");
}

void PhiOption::write(const Surface& mapped, const MethodResult& result) const {
    if (given())
        write_atomically(path_, differential_json(mapped, result.distortion.mu, result.phi, result.differential));
}

}  // namespace beltrami::cli
