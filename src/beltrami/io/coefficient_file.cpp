#include <beltrami/io/coefficient_file.h>

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/io/extension.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/io/read_mesh.h>

namespace beltrami {

namespace {

Eigen::VectorXcd from_mesh(const std::filesystem::path& path, int face_count) {
    const LoadedMesh loaded = read_mesh(path);
    if (!loaded.face_mu)
        throw Error(Cause::unreadable, fmt::format("{}: the faces have no properties mu_re and mu_im", path.string()),
                    "give a PLY that a map was written to, or lines `face re im`");
    if (loaded.face_mu->size() != face_count)
        throw Error(Cause::unreadable,
                    fmt::format("{} has coefficients of {} faces, the mesh has {}", path.string(),
                                loaded.face_mu->size(), face_count),
                    "give one for each face");
    return *loaded.face_mu;
}

Eigen::VectorXcd from_lines(const std::filesystem::path& path, int face_count) {
    const IndexedRows rows = read_indexed_rows(path, 1, face_count, 2, "a coefficient of a face");
    Eigen::VectorXcd mu(face_count);
    std::vector<char> given(static_cast<std::size_t>(face_count), 0);
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i) {
        const int face = rows.indices(i, 0);
        if (given[face])
            throw Error(Cause::unreadable, fmt::format("{} names face {} twice", path.string(), face),
                        "give one coefficient for each face", {Things::faces, {face}});
        given[face] = 1;
        mu[face] = {rows.values(i, 0), rows.values(i, 1)};
    }
    for (int face = 0; face < face_count; ++face)
        if (!given[face])
            throw Error(Cause::unreadable, fmt::format("{} has no coefficient of face {}", path.string(), face),
                        "give one for each face, 0 where the map is to be conformal", {Things::faces, {face}});
    return mu;
}

}  // namespace

Eigen::VectorXcd read_coefficient(const std::filesystem::path& path, int face_count) {
    Eigen::VectorXcd mu =
        lower_case_extension(path) == ".ply" ? from_mesh(path, face_count) : from_lines(path, face_count);
    for (int face = 0; face < face_count; ++face)
        if (!(std::abs(mu[face]) < 1))
            throw Error(
                Cause::unreadable,
                fmt::format("{}: the coefficient of face {} has |μ| = {}", path.string(), face, std::abs(mu[face])),
                "maps that keep orientation have |μ| < 1", {Things::faces, {face}});
    return mu;
}

}  // namespace beltrami
