#include "output.h"

#include <beltrami/base/error.h>
#include <beltrami/io/extension.h>
#include <beltrami/io/write_mesh.h>

#include "page.h"

namespace beltrami::cli {

void OutputOptions::add_to(CLI::App& app) {
    app.add_option("-o,--output", path_,
                   "OBJ (the map as vt), PLY (the map as u, v and per face mu_re, mu_im, abs_mu, K) or OFF")
        ->required()
        ->type_name("OUT");
    app.add_flag("--as-positions", as_positions_, "write the map as vertex positions (z = 0) instead of vt");
}

void require_mesh_format(const std::string& path) {
    const std::string extension = lower_case_extension(path);
    if (extension != ".obj" && extension != ".ply" && extension != ".off")
        throw Error(Cause::bad_option, "-o " + path + ": the extension '" + extension + "' is none of .obj, .ply, .off",
                    "name the output with one of these extensions");
}

void OutputOptions::check() const {
    require_mesh_format(path_);
}

namespace {

std::vector<Column> columns_of(const Distortion& distortion) {
    const Eigen::VectorXd K = distortion.face_abs_mu.unaryExpr([](double abs_mu) { return dilatation(abs_mu); });
    return {{"mu_re", distortion.face_mu.real()},
            {"mu_im", distortion.face_mu.imag()},
            {"abs_mu", distortion.face_abs_mu},
            {"K", K}};
}

Mesh mesh_at(const Positions& positions, const FaceList& faces) {
    Mesh image;
    image.positions = Positions::Zero(positions.rows(), 3);
    image.positions.leftCols(positions.cols()) = positions;
    image.faces = faces;
    return image;
}

}  // namespace

void OutputOptions::write(const Mesh& source, const Eigen::VectorXcd& map, const Distortion& distortion) const {
    if (!as_positions_) {
        write_mesh(path_, {source, positions_of(map), columns_of(distortion)});
        return;
    }
    write_mesh(path_, {mesh_at(positions_of(map), source.faces), {}, columns_of(distortion)});
}

void OutputOptions::write(const Mesh& source, const Positions& images, const Eigen::VectorXcd& map,
                          const Distortion& distortion) const {
    write_mesh(path_, {mesh_at(images, source.faces), positions_of(map), columns_of(distortion)});
}

}  // namespace beltrami::cli
