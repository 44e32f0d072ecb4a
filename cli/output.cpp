#include "output.h"

#include <beltrami/io/extension.h>
#include <beltrami/io/write_mesh.h>
#include <beltrami/mesh/error.h>

#include "page.h"

namespace beltrami::cli {

void OutputOptions::add_to(CLI::App& app) {
    app.add_option("-o,--output", path_,
                   "OBJ (the map as vt), PLY (the map as u, v and per face mu_re, mu_im, abs_mu, K) or OFF")
        ->required()
        ->type_name("OUT");
    app.add_flag("--as-positions", as_positions_, "write the map as vertex positions (z = 0) instead of vt");
}

void OutputOptions::check() const {
    const std::string extension = lower_case_extension(path_);
    if (extension != ".obj" && extension != ".ply" && extension != ".off")
        throw Error(Cause::bad_option,
                    "-o " + path_ + ": the extension '" + extension + "' is none of .obj, .ply, .off",
                    "name the output with one of these extensions");
}

void OutputOptions::write(const Mesh& source, const Eigen::VectorXcd& map, const Distortion& distortion) const {
    const Eigen::VectorXd K = distortion.face_abs_mu.unaryExpr([](double abs_mu) { return dilatation(abs_mu); });
    const std::vector<Column> columns{{"mu_re", distortion.face_mu.real()},
                                      {"mu_im", distortion.face_mu.imag()},
                                      {"abs_mu", distortion.face_abs_mu},
                                      {"K", K}};
    if (!as_positions_) {
        write_mesh(path_, {source, positions_of(map), columns});
        return;
    }
    Mesh image;
    image.positions = Positions::Zero(map.size(), 3);
    image.positions.leftCols(2) = positions_of(map);
    image.faces = source.faces;
    write_mesh(path_, {image, {}, columns});
}

}  // namespace beltrami::cli
