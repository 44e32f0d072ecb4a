#include "space_method.h"

#include <fmt/format.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/io/coefficient_file.h>
#include <beltrami/space/uniform_map.h>

#include "output.h"
#include "page.h"
#include "space_input.h"

namespace beltrami::cli {

void SpaceMethod::add_to(CLI::App& app) {
    app.add_option("--in-space", places_, "of --method lsqc: the prescribed places, lines `vertex x y z`")
        ->type_name("FILE");
    app.add_option("--preserve", preserve_,
                   "of --method lsqc: vertices move in their tangent planes, or the area stays to first order")
        ->check(CLI::IsMember({"normals", "area"}));
    app.add_flag("--uniform", uniform_, "of --method lsqc: equal |mu| by the QC iteration of Gruber and Aulisa");
    app.add_option("--mu", mu_,
                   "of --method lsqc: the coefficient that the map ought to have, without it 0; a PLY with mu_re and "
                   "mu_im of every face in the frame of its element, as this method writes it, or lines `face re im`")
        ->type_name("FILE");
    reference_.add_to(app);
}

std::string SpaceMethod::stray() const {
    if (!places_.empty()) return "--in-space";
    if (!preserve_.empty()) return "--preserve";
    if (uniform_) return "--uniform";
    if (!mu_.empty()) return "--mu";
    return reference_.given() ? "--reference" : "";
}

std::vector<NamedFile> SpaceMethod::inputs() const {
    std::vector<NamedFile> files = reference_.inputs();
    files.insert(files.end(), {{"--in-space", places_}, {"--mu", mu_}});
    return files;
}

/// #S, |μ| < 1.
Eigen::VectorXcd SpaceMethod::coefficient(const Operators& operators) const {
    if (mu_.empty()) return Eigen::VectorXcd::Zero(operators.sample_count());
    const Eigen::VectorXcd faces = read_coefficient(mu_, operators.face_count);
    for (int f = 0; f < operators.face_count; ++f)
        if (!(std::abs(faces[f]) < 1))
            throw Error(Cause::bad_option, fmt::format("{}: |mu| of face {} is not below 1", mu_, f),
                        "there is no such map", {Things::faces, {f}});
    return face_values_at_samples(operators, faces);
}

void SpaceMethod::run(const MeshInputOptions& options, const std::string& source, const std::string& output,
                      const CommonOptions& common, Record& record) const {
    if (uniform_ && !mu_.empty())
        throw Error(Cause::bad_option, "--uniform finds a coefficient, --mu gives one", "leave one of them out");
    const double start = seconds();
    MeshInput input;
    const Surface surface = surface_in_space(options, source, input, record);
    const Mesh& mesh = surface.mesh;
    const CornerElements elements =
        reference_.given() ? corner_elements(mesh, reference_.shapes(input)) : corner_elements(mesh);
    Positions places = Positions::Zero(mesh.vertex_count(), 3);
    std::vector<char> fixed(static_cast<std::size_t>(mesh.vertex_count()), 0);
    if (!places_.empty()) {
        const PlacesInSpace given = places_in_space(places_, input, "a place");
        for (std::size_t i = 0; i < given.vertices.size(); ++i) {
            fixed[given.vertices[i]] = 1;
            places.row(given.vertices[i]) = given.places.row(static_cast<Eigen::Index>(i));
        }
    }
    LeastSquaresMap problem(mesh, elements, std::move(places), std::move(fixed),
                            preserve_ == "normals" ? Preserve::normals
                            : preserve_ == "area"  ? Preserve::area
                                                   : Preserve::nothing);
    SolveRecord solve;
    Mesh image = mesh;
    if (uniform_) {
        const UniformMap map = uniform_map(problem, mesh);
        image.positions = map.map;
        solve.iterations = map.solves;
        solve.termination = to_string(map.converged ? Termination::converged : Termination::iteration_limit);
    } else {
        image.positions = problem.solve(coefficient(elements.operators));
        solve.iterations = 1;
        solve.termination = to_string(Termination::converged);
    }
    solve.factorizations = problem.factorization_count();
    solve.seconds_total = seconds() - start;
    record.solve = solve;
    const Distortion d = distortion(elements.operators, image.positions, vertex_normals(image));
    record.map = map_record(d);
    if (!d.flipped.empty())
        record.warnings.push_back({WarningKind::flipped_faces,
                                   counted(d.flipped.size(), "face is flipped", "faces are flipped") +
                                       ", the first is face " + std::to_string(d.flipped[0]),
                                   {Things::faces, d.flipped}});
    write_with_texture(output, image, input.unit, d, input.attributes);
    write_page(common, mesh, {{kName, image.positions, d.face_abs_mu}}, {}, record, source);
    finish(record, common, kName, {output, common.json, common.report});
}

}  // namespace beltrami::cli
