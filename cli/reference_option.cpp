#include "reference_option.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/space/reference_shapes.h>

#include "place_file.h"

namespace beltrami::cli {

namespace {

constexpr int kMostCorners = 1000;  // of a face with angles in a file

}  // namespace

CLI::Option* ReferenceOption::add_to(CLI::App& app) {
    return app
        .add_option_function<std::string>(
            "--reference",
            [this](const std::string& value) {
                reference_ = value;
                given_ = true;
            },
            "the shapes that faces ought to have: equilateral, or square, regular polygons; valence, by how many faces "
            "meet at their vertices; original, as they are; FILE with lines `face angle angle angle [angle]` in "
            "degrees for every face")
        ->type_name("NAME|FILE");
}

bool ReferenceOption::is_file() const {
    const auto names = {"equilateral", "square", "valence", "original"};
    return std::find(names.begin(), names.end(), reference_) == names.end();
}

std::vector<NamedFile> ReferenceOption::inputs() const {
    if (!is_file()) return {};
    return {{"--reference", reference_}};
}

Positions ReferenceOption::shapes(const MeshInput& input) const {
    if (is_file()) return from_file(input);
    if (reference_ == "valence") return valence_shapes(input.mesh);
    if (reference_ == "original") return corner_positions(input.mesh);
    return regular_shapes(input.mesh.faces);
}

Positions ReferenceOption::from_file(const MeshInput& input) const {
    const Mesh& mesh = input.mesh;
    Eigen::VectorXd angles = Eigen::VectorXd::Constant(mesh.faces.corner_count(), -1);
    for (const NumberRow& row : read_number_rows(reference_, 4, kMostCorners + 1, "a face and its angles")) {
        const std::vector<double>& n = row.numbers;
        const auto at = std::find_if(input.faces.begin(), input.faces.end(),
                                     [&](int face) { return static_cast<double>(face) == n[0]; });
        if (at == input.faces.end()) fail_at_row(reference_, row, fmt::format("{} is no face of the mesh", n[0]));
        const int face = static_cast<int>(at - input.faces.begin());
        if (static_cast<int>(n.size()) != mesh.faces.degree(face) + 1)
            fail_at_row(reference_, row,
                        fmt::format("the face has {} corners, not {}", mesh.faces.degree(face), n.size() - 1));
        for (int j = 0; j < mesh.faces.degree(face); ++j)
            angles[mesh.faces.first_corner(face) + j] = n[j + 1] * std::numbers::pi / 180;
    }
    for (int f = 0; f < mesh.face_count(); ++f)
        if (angles[mesh.faces.first_corner(f)] < 0)
            throw Error(Cause::unreadable, fmt::format("{} has no line for face {}", reference_, input.faces[f]),
                        "give the angles of every face", {Things::faces, {f}});
    return shapes_from_angles(mesh.faces, angles);
}

}  // namespace beltrami::cli
