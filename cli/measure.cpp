#include <beltrami/mesh/error.h>

#include "command.h"
#include "page.h"

namespace beltrami::cli {

namespace {

class Measure final : public Command {
  public:
    explicit Measure(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "measure", "distortion of any map: to a second mesh, or to SOURCE's own texture coordinates");
        app->add_option("SOURCE", source_, "OBJ, PLY, OFF or STL")->required();
        app->add_option("IMAGE", image_,
                        "a mesh with the same faces; without it, the vt of SOURCE (per corner, seams allowed)");
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        Record record;
        record.command = "measure";
        const Surface source(load(source_, record.warnings));
        add_findings(source.findings, record.warnings);
        record.source = source_record(source);
        const Distortion d = image_.empty() ? to_texture(source) : to_mesh(source, record.warnings);
        record.map = map_record(d);
        if (!d.flipped.empty())
            record.warnings.push_back(std::to_string(d.flipped.size()) + " faces are flipped, the first is face " +
                                      std::to_string(d.flipped[0]));
        if (!d.degenerate.empty())
            record.warnings.push_back(std::to_string(d.degenerate.size()) + " faces collapse, the first is face " +
                                      std::to_string(d.degenerate[0]));
        write_page(common_.report, page_mesh_ ? *page_mesh_ : source.mesh,
                   {{"measured", image_positions_, d.face_abs_mu}}, {}, record, source_);
        finish(record, common_, "measured", {common_.json, common_.report});
        return 0;
    }

  private:
    Distortion to_texture(const Surface& source) {
        const Positions corners = texture_corners(source.mesh);
        if (!common_.report.empty()) split_at_corners(source.mesh, corners);
        return distortion(per_corner(source.operators, source.mesh.faces), corners);
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

    Distortion to_mesh(const Surface& source, std::vector<std::string>& warnings) {
        const Mesh image = load(image_, warnings);
        if (image.vertex_count() != source.mesh.vertex_count() || image.faces != source.mesh.faces)
            throw Error(Cause::bad_mesh, "SOURCE and IMAGE do not have the same vertices and faces in the same order",
                        "write both from one program without reordering");
        if (!image.positions.allFinite()) throw Error(Cause::bad_mesh, "IMAGE has coordinates that are not finite");
        image_positions_ = is_planar(image) ? Positions(image.positions.leftCols(2)) : image.positions;
        return distortion(source.operators, image_positions_,
                          image_positions_.cols() > 2 ? vertex_normals(image) : Positions());
    }

    std::string source_, image_;
    CommonOptions common_;
    Positions image_positions_;
    std::optional<Mesh> page_mesh_;
};

}  // namespace

std::unique_ptr<Command> make_measure(CLI::App& parent) {
    return std::make_unique<Measure>(parent);
}

}  // namespace beltrami::cli
