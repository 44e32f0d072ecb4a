#include <fmt/format.h>

#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/report/dendrogram.h>

#include "command.h"
#include "mesh_input.h"

namespace beltrami::cli {

namespace {

class DistanceCommand final : public Command {
  public:
    explicit DistanceCommand(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "distance", "Teichmueller's distance ½ log K* between shapes of one topology, with its bracket");
        app->add_option("MESH", meshes_, "two or more: OBJ, PLY, OFF or STL, of genus 0 with as many boundary loops")
            ->required()
            ->expected(2, 1 << 20);
        app->add_option("--outer", outer_, "the boundary loop of every shape that goes to the others' outer one")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str()
            ->type_name("h");
        app->add_option("--match", match_,
                        "holes go to those nearest after the best Moebius map of the disk, or of like size")
            ->check(CLI::IsMember({"position", "size"}))
            ->capture_default_str();
        app->add_option("--picture", picture_, "the matrix and the tree of its clusters, as SVG")
            ->type_name("FILE.svg");
        options_.add_to(*app);
        common_.add_to(*app, false);
        app->footer(kExitCodes);
    }

    int run() override {
        std::vector<NamedFile> inputs;
        inputs.reserve(meshes_.size());
        for (const std::string& mesh : meshes_) inputs.push_back({"MESH", mesh});
        common_.check_files(inputs, {{"--picture", picture_}});
        Record& record = record_;
        record.command = "distance";
        std::vector<Surface> surfaces;
        for (const std::string& mesh : meshes_) {
            MeshInput input = options_.load(mesh, record.warnings);
            try {
                surfaces.emplace_back(std::move(input.mesh));
            } catch (const Error& error) {
                throw Error(error.cause(), mesh + ": " + error.what(), {}, error.where());
            }
            Warnings findings;
            add_findings(surfaces.back().findings, findings);
            for (const Warning& finding : findings) record.warnings.push_back(prefixed(mesh, finding));
        }
        record.source = source_record(surfaces[0]);
        Correspondence wanted;
        wanted.outer_loop = outer_;
        wanted.match_by = match_ == "size" ? MatchBy::size : MatchBy::position;
        DistanceMatrix matrix;
        {
            Progress progress(!common_.quiet);
            const auto show = [&](int done, int all) {
                progress.show(done, static_cast<double>(all), "of");
                return true;
            };
            matrix = distance_matrix(surfaces, wanted, {}, show, meshes_);
        }
        for (const auto& [i, j] : matrix.unsettled)
            record.warnings.push_back({WarningKind::distance,
                                       meshes_[i] + " and " + meshes_[j] +
                                           ": a map has not converged or has folds, their distance is an estimate",
                                       {Things::shapes, {i, j}}});
        record.distances = {meshes_, matrix, cluster_by_distance(matrix.distance)};
        if (!picture_.empty())
            write_atomically(picture_, render_dendrogram(names(), matrix.distance, record.distances->merges));
        if (common_.may_print()) print(matrix);
        finish(record, common_, {}, {common_.json, picture_});
        return 0;
    }

    std::string hint(const Error& error) const override {
        if (error.cause() != Cause::bad_mesh) return cli::hint(error);
        for (const std::string& mesh : meshes_)
            if (const std::string hint = options_.hint(mesh); !hint.empty()) return mesh + ": " + hint;
        return {};
    }

  private:
    /// File names without their folders and extensions.
    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const std::string& mesh : meshes_) {
            const std::size_t slash = mesh.find_last_of('/');
            const std::string file = slash == std::string::npos ? mesh : mesh.substr(slash + 1);
            result.push_back(file.substr(0, file.find_last_of('.')));
        }
        return result;
    }

    void print(const DistanceMatrix& matrix) const {
        for (Eigen::Index i = 0; i < matrix.distance.rows(); ++i)
            for (Eigen::Index j = i + 1; j < matrix.distance.cols(); ++j)
                fmt::print("{} {}: {:.6f} (between {:.6f} and {:.6f}), K = {:.6f}\n", meshes_[i], meshes_[j],
                           matrix.distance(i, j), matrix.lower(i, j), matrix.upper(i, j),
                           std::exp(2 * matrix.distance(i, j)));
    }

    std::vector<std::string> meshes_;
    std::string match_ = "position", picture_;
    int outer_ = 0;
    MeshInputOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_distance(CLI::App& parent) {
    return std::make_unique<DistanceCommand>(parent);
}

}  // namespace beltrami::cli
