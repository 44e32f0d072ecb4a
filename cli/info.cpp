#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/quality.h>

#include "command.h"
#include "mesh_input.h"

namespace beltrami::cli {

namespace {

class Info final : public Command {
  public:
    explicit Info(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand("info", "what a mesh is: size, topology, quality, defects");
        app->add_option("MESH", mesh_, "OBJ, PLY, OFF or STL")->required();
        options_.add_to(*app);
        common_.add_to(*app, false);
        app->footer(kExitCodes);
    }

    int run() override {
        common_.check_files({{"MESH", mesh_}});
        Record& record = record_;
        record.command = "info";
        MeshInput input = options_.load(mesh_, record.warnings);
        const Mesh& mesh = input.mesh;
        const std::vector<Finding> findings = diagnose(mesh);
        add_findings(findings, record.warnings);
        bool fatal = false, has_topology = true;
        for (const Finding& finding : findings) {
            fatal = fatal || finding.fatal;
            has_topology = has_topology && !spoils_topology(finding.defect);
        }
        record.source = has_topology ? source_record(mesh, topology(mesh), input.unit) : source_record(mesh);
        const bool mendable = std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
            return finding.defect == Defect::inconsistent_orientation || finding.defect == Defect::several_components;
        });
        if (mendable)
            if (const std::string hint = options_.hint(mesh_); !hint.empty())
                record.warnings.push_back({WarningKind::hint, "hint: " + hint});
        if (common_.may_print()) print(mesh, record.source, input.unit);
        finish(record, common_, {}, {});
        return fatal ? exit_code(Cause::bad_mesh) : 0;
    }

  private:
    void print(const Mesh& mesh, const SourceRecord& source, double unit) const {
        int quads = 0;
        for (int f = 0; f < mesh.face_count(); ++f) quads += mesh.faces.degree(f) == 4;
        fmt::print("{}\n  {}, {} ({}, {}){}{}\n", mesh_, counted(source.vertices, "vertex", "vertices"),
                   counted(source.faces, "face", "faces"), counted(source.faces - quads, "triangle", "triangles"),
                   counted(quads, "quad", "quads"), is_planar(mesh) ? ", planar" : "",
                   mesh.texture ? ", with texture coordinates" : "");
        if (!source.shape) return;
        fmt::print("  {}, genus {}, {}\n", counted(source.shape->components, "component", "components"),
                   source.shape->genus,
                   counted(source.shape->boundary_loops.size(), "boundary loop", "boundary loops"));
        for (std::size_t l = 0; l < source.shape->boundary_loops.size(); ++l)
            fmt::print("  loop {}: length {:.6g}, {}, the first is {}\n", l, source.shape->boundary_loops[l].length,
                       counted(source.shape->boundary_loops[l].vertices, "vertex", "vertices"),
                       source.shape->boundary_loops[l].first_vertex);
        const MeshQuality q = quality(mesh);
        fmt::print("  smallest angle {:.2f} degrees, edges from {:.4g} to {:.4g}\n",
                   q.min_angle * 180 / std::numbers::pi, unit * q.min_edge, unit * q.max_edge);
    }

    std::string mesh_;
    MeshInputOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_info(CLI::App& parent) {
    return std::make_unique<Info>(parent);
}

}  // namespace beltrami::cli
