#include <algorithm>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/certificate/proved_bounds.h>
#include <beltrami/io/read_polygons.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/mesh/texture_map.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/space/corner_elements.h>
#include <beltrami/space/polygon_surface.h>

#include "command.h"
#include "mesh_input.h"
#include "page.h"
#include "reference_option.h"

namespace beltrami::cli {

namespace {

/// Defects that leave every face its shape, so that distortion is defined all the same.
bool is_topological(Defect defect) {
    switch (defect) {
        case Defect::non_manifold_edge:
        case Defect::non_manifold_vertex:
        case Defect::inconsistent_orientation:
        case Defect::not_orientable:
        case Defect::duplicate_face:
            return true;
        default:
            return false;
    }
}

/// The record of a mesh whose faces all have a shape; of a mesh without topology, with warnings instead of it.
/// @throw Error bad_mesh
SourceRecord examine(const Mesh& mesh, Warnings& warnings) {
    const std::vector<Finding> findings = diagnose(has_polygons(mesh) ? split_large_faces(mesh).mesh : mesh);
    bool sound = true;
    for (const Finding& finding : findings) {
        if (!finding.fatal) continue;
        if (!is_topological(finding.defect))
            throw Error(Cause::bad_mesh, finding.sentence, finding.next_step, finding.where());
        sound = false;
    }
    add_findings(findings, warnings);
    return sound ? source_record(mesh, topology(mesh)) : source_record(mesh);
}

class Measure final : public Command {
  public:
    explicit Measure(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "measure", "distortion of any map: to a second mesh, or to SOURCE's own texture coordinates");
        app->add_option("SOURCE", source_, "OBJ, PLY, OFF or STL")->required();
        app->add_option("IMAGE", image_,
                        "a mesh with the same faces; without it, the vt of SOURCE (per corner, seams allowed)");
        app->add_flag("--certify", certify_,
                      "prove how much any map of SOURCE, a disk, with the same boundary values stretches at least, "
                      "beside what this one attains");
        reference_.add_to(*app);
        options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        std::vector<NamedFile> inputs = reference_.inputs();
        inputs.insert(inputs.end(), {{"SOURCE", source_}, {"IMAGE", image_}});
        common_.check_files(inputs);
        if (reference_.given() && (certify_ || !image_.empty()))
            throw Error(Cause::bad_option, "--reference measures the faces of SOURCE itself, not a map of it",
                        "leave out IMAGE and --certify, or --reference");
        Record& record = record_;
        record.command = "measure";
        const bool polygons = reference_.given() || (!image_.empty() && !certify_);
        input_ = polygons ? options_.load_polygons(source_, record.warnings) : options_.load(source_, record.warnings);
        const Mesh& source = input_.mesh;
        record.source = examine(source, record.warnings);
        const Distortion d = reference_.given() ? against_reference(source)
                             : image_.empty()   ? to_texture(source)
                                                : to_mesh(source, record.warnings);
        record.map = map_record(d);
        if (certify_) add_bounds(source, *record.map);
        if (!d.flipped.empty() && static_cast<int>(d.flipped.size()) == source.face_count()) {
            record.warnings.push_back({WarningKind::flipped_faces,
                                       source.face_count() == 1 ? "the only face is flipped: the image is mirrored"
                                                                : "every face is flipped: the image is mirrored",
                                       {Things::faces, d.flipped}});
        } else {
            const std::vector<int> other = image_.empty() && !reference_.given()
                                               ? without_mirrored_charts(source, d.flipped, record.warnings)
                                               : d.flipped;
            warn_of(WarningKind::flipped_faces, other, "face is flipped", "faces are flipped", record.warnings);
        }
        warn_of(WarningKind::degenerate_faces, d.degenerate, "face collapses", "faces collapse", record.warnings);
        write_page(common_, page_mesh_ ? *page_mesh_ : source, {{"measured", image_positions_, d.face_abs_mu}}, {},
                   record, source_);
        finish(record, common_, "measured", {common_.json, common_.report});
        return 0;
    }

    std::string hint(const Error& error) const override { return options_.hint(error, source_); }

  private:
    /// Says of which charts of the texture every face is flipped; returns the flipped faces of the others.
    static std::vector<int> without_mirrored_charts(const Mesh& source, const std::vector<int>& flipped,
                                                    Warnings& warnings) {
        std::vector<char> is_flipped(static_cast<std::size_t>(source.face_count()), 0);
        for (const int f : flipped) is_flipped[f] = 1;
        std::vector<int> mirrored;
        std::size_t charts = 0;
        for (const std::vector<int>& chart : texture_charts(source)) {
            if (!std::all_of(chart.begin(), chart.end(), [&](int f) { return is_flipped[f] != 0; })) continue;
            ++charts;
            for (const int f : chart) {
                mirrored.push_back(f);
                is_flipped[f] = 0;
            }
        }
        std::sort(mirrored.begin(), mirrored.end());
        if (charts > 0)
            warnings.push_back(
                {WarningKind::flipped_faces,
                 "every face is flipped of " + counted(charts, "chart of the texture", "charts of the texture") + " (" +
                     counted(mirrored.size(), "face", "faces") + ", the first is face " + std::to_string(mirrored[0]) +
                     (charts == 1 ? "): its image is mirrored" : "): their images are mirrored"),
                 {Things::faces, mirrored}});
        std::vector<int> other;
        for (const int f : flipped)
            if (is_flipped[f]) other.push_back(f);
        return other;
    }

    static void warn_of(WarningKind kind, const std::vector<int>& faces, const char* one, const char* many,
                        Warnings& warnings) {
        if (faces.empty()) return;
        warnings.push_back({kind,
                            counted(faces.size(), one, many) + (faces.size() == 1 ? ": " : ", the first is ") +
                                "face " + std::to_string(faces[0]),
                            {Things::faces, faces}});
    }

    void add_bounds(const Mesh& source, MapRecord& record) const {
        const ProvedBounds proved = bounds_of_map(Surface(source), map_);
        record.bounds = proved.bounds;
        record.K_lower = record.K_lower_proved = proved.K();
        for (const Bound& bound : proved.bounds)
            if (bound.kind == Bound::Kind::attained) record.K_max = bound.K;
    }

    /// Images of the vertices in the plane, seen from the side from which a planar source is.
    static Eigen::VectorXcd per_vertex(const Mesh& source, const Positions& corners) {
        const bool below = is_planar(source) && seen_from_below(source);
        Eigen::VectorXcd map = Eigen::VectorXcd::Zero(source.vertex_count());
        std::vector<char> known(static_cast<std::size_t>(source.vertex_count()), 0);
        for (int c = 0; c < source.faces.corner_count(); ++c) {
            const int v = source.faces.vertices()[c];
            const Complex image(corners(c, 0), below ? -corners(c, 1) : corners(c, 1));
            if (known[v] && map[v] != image)
                throw Error(Cause::bad_mesh, "the texture coordinates have a seam at vertex " + std::to_string(v),
                            "cut SOURCE along the seam", {Things::vertices, {v}});
            known[v] = 1;
            map[v] = image;
        }
        return map;
    }

    Distortion to_texture(const Mesh& source) {
        Positions corners = texture_corners(source);
        corners /= unit_of(extent_of(corners));
        if (certify_) map_ = per_vertex(source, corners);
        if (!common_.report.empty()) split_at_corners(source, corners);
        return distortion_to_corners(source, corners);
    }

    /// The faces' own shapes against those that they ought to have.
    Distortion against_reference(const Mesh& source) {
        const CornerElements elements = corner_elements(source, reference_.shapes(input_));
        image_positions_.resize(source.vertex_count(), 3);
        for (int v = 0; v < source.vertex_count(); ++v) image_positions_.row(v) = source.point(v);
        return distortion(elements.operators, image_positions_, vertex_normals(source));
    }

    /// For drawing, a map with seams needs one vertex per corner.
    void split_at_corners(const Mesh& mesh, const Positions& corners) {
        page_mesh_.emplace();
        page_mesh_->positions.resize(mesh.faces.corner_count(), 3);
        std::vector<int> face;
        for (int f = 0; f < mesh.face_count(); ++f) {
            face.clear();
            for (int c = mesh.faces.offsets()[f]; c < mesh.faces.offsets()[f + 1]; ++c) {
                page_mesh_->positions.row(c) = mesh.point(mesh.faces.vertices()[c]).transpose();
                face.push_back(c);
            }
            page_mesh_->faces.add(face);
        }
        image_positions_ = corners;
    }

    Distortion to_mesh(const Mesh& source, Warnings& warnings) {
        const LoadedMesh read = certify_ ? read_mesh(image_) : read_polygons(image_);
        const FaceList& faces = input_.file_faces ? *input_.file_faces : source.faces;
        append(warnings, read.warnings);
        if (read.mesh.vertex_count() != static_cast<int>(input_.numbers.size()) || read.mesh.faces != faces)
            throw Error(Cause::bad_mesh, "SOURCE and IMAGE do not have the same vertices and faces in the same order",
                        "write both from one program without reordering");
        if (!read.mesh.positions.allFinite()) throw Error(Cause::bad_mesh, "IMAGE has coordinates that are not finite");
        Mesh image;  // mended as the source was
        image.faces = source.faces;
        image.positions.resize(source.vertex_count(), read.mesh.positions.cols());
        for (int v = 0; v < source.vertex_count(); ++v)
            image.positions.row(v) = read.mesh.positions.row(input_.vertices[v]);
        image.positions /= unit_of(extent_of(image.positions));
        if (certify_) {
            if (!is_planar(image))
                throw Error(Cause::bad_mesh, "IMAGE does not lie in the plane",
                            "bounds are known for maps to the plane");
            map_ = per_vertex(source, corner_positions(image));
        }
        image_positions_ = is_planar(image) ? Positions(image.positions.leftCols(2)) : image.positions;
        return has_polygons(source) ? of_polygons(source, image) : distortion_to(source, image);
    }

    /// As distortion_to() by the polygons' corner triangles.
    static Distortion of_polygons(const Mesh& source, const Mesh& image) {
        const Operators operators = corner_elements(source).operators;
        if (!is_planar(image)) return distortion(operators, image.positions, vertex_normals(image));
        Positions seen = image.positions.leftCols(2);
        if (is_planar(source) && seen_from_below(source)) seen.col(1) *= -1;
        return distortion(operators, seen);
    }

    static double extent_of(const Positions& points) {
        if (points.rows() == 0) return 0;
        return (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
    }

    std::string source_, image_;
    bool certify_ = false;
    Eigen::VectorXcd map_;  ///< #V, for certify_
    ReferenceOption reference_;
    MeshInputOptions options_;
    MeshInput input_;
    CommonOptions common_;
    Positions image_positions_;
    std::optional<Mesh> page_mesh_;
};

}  // namespace

std::unique_ptr<Command> make_measure(CLI::App& parent) {
    return std::make_unique<Measure>(parent);
}

}  // namespace beltrami::cli
