#include "output.h"

#include <beltrami/base/error.h>
#include <beltrami/io/extension.h>
#include <beltrami/io/write_mesh.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/sphere/stereographic_charts.h>

#include "page.h"

namespace beltrami::cli {

void OutputOptions::add_to(CLI::App& app) {
    app.add_option("-o,--output", path_,
                   "OBJ (the map as vt), PLY (the map as u, v and per face mu_re, mu_im, abs_mu, K) or OFF")
        ->required()
        ->type_name("OUT");
    fit_.add_to(app);
    app.add_flag("--as-positions", as_positions_, "write the map as vertex positions (z = 0) instead of vt");
}

void FitOption::add_to(CLI::App& app) {
    app.add_option("--fit", fit_,
                   "unit: the texture coordinates are moved and scaled, uniformly, into the square [0,1] x [0,1]")
        ->check(CLI::IsMember({"none", "unit"}))
        ->capture_default_str();
}

Positions FitOption::fitted(const Positions& points) const {
    return fit_ == "unit" ? fitted_to_unit_square(points) : points;
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

/// Normals are those of other positions.
FileAttributes without_normals(FileAttributes attributes) {
    std::erase_if(attributes.vertex_columns, [](const FileColumn& column) {
        return column.name == "nx" || column.name == "ny" || column.name == "nz";
    });
    return attributes;
}

}  // namespace

void write_at(const std::string& path, const FaceList& faces, const Positions& positions, const Distortion& distortion,
              const FileAttributes& attributes) {
    write_mesh(path, {mesh_at(positions, faces), {}, columns_of(distortion), {}, without_normals(attributes)});
}

void write_with_texture(const std::string& path, const Mesh& mesh, double unit, const Distortion& distortion,
                        const FileAttributes& attributes) {
    const bool has_corners = lower_case_extension(path) != ".off";
    const Mesh whole = mesh_at(unit * mesh.positions, mesh.faces);
    MeshOutput output{whole, {}, columns_of(distortion), {}, without_normals(attributes)};
    if (has_corners) output.corner_map = mesh.texture;
    write_mesh(path, output);
}

void OutputOptions::write(const Mesh& source, const Eigen::VectorXcd& map, const Distortion& distortion,
                          const FileAttributes& attributes, double unit) const {
    const Positions points = fit_.fitted(positions_of(map));
    if (as_positions_) {
        write_at(path_, source.faces, points, distortion, attributes);
    } else if (unit == 1) {
        write_mesh(path_, {source, points, columns_of(distortion), {}, attributes});
    } else {
        write_mesh(path_,
                   {mesh_at(unit * source.positions, source.faces), points, columns_of(distortion), {}, attributes});
    }
}

void OutputOptions::check_seams() const {
    if (!as_positions_ && lower_case_extension(path_) == ".off")
        throw Error(Cause::bad_option, "-o " + path_ + ": OFF has one texture point a vertex, and this map has seams",
                    "write an OBJ or a PLY, or positions with --as-positions");
}

void OutputOptions::check_layout() const {
    if (as_positions_)
        throw Error(Cause::bad_option,
                    "--as-positions: a closed surface is cut open, and a vertex on the cut has "
                    "several places in the plane",
                    "leave it out: OUT then has them as vt");
    check_seams();
}

void OutputOptions::write_sphere(const Mesh& source, const Positions& points, const Distortion& distortion,
                                 const FileAttributes& attributes, double unit) const {
    if (as_positions_) {
        write_at(path_, source.faces, points, distortion, attributes);
        return;
    }
    write_layout(source, stereographic_charts(source.faces, points), distortion, attributes, unit);
}

void OutputOptions::write_layout(const Mesh& source, TextureCoordinates layout, const Distortion& distortion,
                                 const FileAttributes& attributes, double unit) const {
    layout.points = fit_.fitted(layout.points);
    const Mesh whole = unit == 1 ? source : mesh_at(unit * source.positions, source.faces);
    write_mesh(path_, {whole, {}, columns_of(distortion), {}, attributes, std::move(layout)});
}

void OutputOptions::write(const Mesh& source, const Positions& images, const Eigen::VectorXcd& map,
                          const Distortion& distortion, const FileAttributes& attributes) const {
    write_mesh(path_, {mesh_at(images, source.faces),
                       fit_.fitted(positions_of(map)),
                       columns_of(distortion),
                       {},
                       without_normals(attributes)});
}

}  // namespace beltrami::cli
