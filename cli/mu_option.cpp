#include "mu_option.h"

#include <map>

#include <beltrami/io/coefficient_file.h>

namespace beltrami::cli {

namespace {

const std::map<std::string, CoefficientFrame>& frames() {
    static const std::map<std::string, CoefficientFrame> names{{"samples", CoefficientFrame::samples},
                                                               {"first-edge", CoefficientFrame::first_edge},
                                                               {"plane", CoefficientFrame::plane},
                                                               {"stereographic", CoefficientFrame::stereographic}};
    return names;
}

}  // namespace

CLI::Option* MuOption::add_to(CLI::App& app, const std::string& what) {
    app.add_option(
           "--mu-frame", frame_,
           "the frame of --mu: first-edge, whose real axis is the face's first edge; plane, that of a planar "
           "mesh; stereographic, that of (x + iy)/(1 + z) on the unit sphere; samples, plane for a planar mesh and "
           "else first-edge, as PLY files are written")
        ->check(CLI::IsMember({"samples", "first-edge", "plane", "stereographic"}))
        ->capture_default_str();
    return app
        .add_option("--mu", path_,
                    what + ": a PLY with mu_re and mu_im of every face, as `map` writes it, or lines `face re im`")
        ->type_name("FILE");
}

Eigen::VectorXcd MuOption::values(const Surface& source) const {
    return mu_at_samples(source, read_coefficient(path_, source.mesh.face_count()), frames().at(frame_));
}

}  // namespace beltrami::cli
