#include <fmt/format.h>

#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/report/dendrogram.h>
#include <beltrami/teichmuller/torus_map.h>

#include "command.h"
#include "marking_options.h"
#include "mesh_input.h"

namespace beltrami::cli {

namespace {

class DistanceCommand final : public Command {
  public:
    explicit DistanceCommand(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "distance", "Teichmueller's distance ½ log K* between shapes of one topology, with its bracket");
        app->add_option("MESH", meshes_, "two or more: OBJ, PLY, OFF or STL, of one genus with as many boundary loops")
            ->required()
            ->expected(2, 1 << 20);
        outer_option_ =
            app->add_option("--outer", outer_, "the boundary loop of every shape that goes to the others' outer one")
                ->check(CLI::NonNegativeNumber)
                ->capture_default_str()
                ->type_name("h");
        match_option_ =
            app->add_option("--match", match_,
                            "holes go to those nearest after the best Moebius map of the disk, or of like size")
                ->check(CLI::IsMember({"position", "size"}))
                ->capture_default_str();
        align_option_ = add_align_option(*app, align_);
        marking_option_ = add_marking_option(*app, marking_);
        marking_option_->default_str("search of tori, else closest");
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
                const Topology shape = topology(input.mesh);
                if (with_hyperbolic_metric(shape)) {
                    Warnings cut;
                    cut_into_triangles(input, cut);
                    for (const Warning& warning : cut) record.warnings.push_back(prefixed(mesh, warning));
                }
                surfaces.emplace_back(std::move(input.mesh));
            } catch (const Error& error) {
                throw Error(error.cause(), mesh + ": " + error.what(), {}, error.where());
            }
            Warnings findings;
            add_findings(surfaces.back().findings, findings);
            for (const Warning& finding : findings) record.warnings.push_back(prefixed(mesh, finding));
        }
        record.source = source_record(surfaces[0]);
        const Topology& first = surfaces[0].topology;
        record.distances = first.components == 1 && with_hyperbolic_metric(first) ? between_handles(surfaces)
                           : first.components != 1 || first.genus == 0            ? between_domains(surfaces)
                                                                                  : between_tori(surfaces);
        if (!picture_.empty())
            write_atomically(picture_,
                             render_dendrogram(names(), record.distances->matrix.distance, record.distances->merges));
        if (common_.may_print()) print(*record.distances);
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
    void refuse(std::initializer_list<const CLI::Option*> options, const char* why) const {
        for (const CLI::Option* option : options)
            if (option->count() > 0) throw Error(Cause::bad_option, option->get_name() + why, "leave it out");
    }

    /// Surfaces of genus 0 have their circle domains, unless a class of nearest points is asked for.
    bool with_hyperbolic_metric(const Topology& shape) const {
        const bool told = align_option_->count() + marking_option_->count() > 0;
        return 2 * shape.genus + static_cast<int>(shape.boundary_loops.size()) > 2 && (shape.genus > 0 || told);
    }

    DistancesRecord between_handles(const std::vector<Surface>& surfaces) {
        if (marking_ == "search") refuse({align_option_}, " is for nearest points, and the class is sought");
        refuse({outer_option_, match_option_},
               " is for surfaces of genus 0: with handles, boundary loops go to the nearest");
        DistanceMatrix matrix;
        {
            Progress progress(!common_.quiet);
            const auto show = [&](int done, int all) {
                progress.show(done, static_cast<double>(all), "of");
                return true;
            };
            std::optional<ClassSearchOptions> search;
            if (marking_ == "search") search.emplace();
            matrix = handle_distances(surfaces, alignment_of(align_), show, meshes_, search);
        }
        warn_of_unsettled(matrix);
        if (marking_ == "search")
            record_.warnings.push_back(
                {WarningKind::start, "classes were sought, and no optimum over all of them is proved", {}});
        return {meshes_, matrix, cluster_by_distance(matrix.distance)};
    }

    DistancesRecord between_tori(const std::vector<Surface>& surfaces) const {
        refuse({outer_option_, match_option_}, " is for boundary loops, and tori have none");
        if (marking_ != "closest")
            refuse({align_option_}, " is for nearest points (--marking closest), and of tori all classes are tried");
        TorusDistances found = torus_distances(surfaces, meshes_);
        if (marking_ == "closest") take_nearest_points(surfaces, found);
        return {meshes_, found.matrix, cluster_by_distance(found.matrix.distance), found.tau, found.markings};
    }

    /// The distances of tori in the classes of nearest points.
    void take_nearest_points(const std::vector<Surface>& surfaces, TorusDistances& found) const {
        HandleMarking marking;
        marking.alignment = alignment_of(align_);
        const auto half_log = [](double K) { return 0.5 * std::log(std::max(1.0, K)); };
        for (TorusDistances::Pair& pair : found.markings) {
            const auto &from = surfaces[static_cast<std::size_t>(pair.from)],
                       &to = surfaces[static_cast<std::size_t>(pair.to)];
            try {
                const TorusMap map = register_tori(from, to, marking);
                pair.marking = map.marking;
                const auto set = [&](Eigen::MatrixXd& matrix, double K) {
                    matrix(pair.from, pair.to) = matrix(pair.to, pair.from) = half_log(K);
                };
                set(found.matrix.distance, map.K);
                set(found.matrix.lower, map.K_lower);
                set(found.matrix.upper, map.K_upper);
            } catch (const Error& error) {
                throw Error(error.cause(), meshes_[pair.from] + " and " + meshes_[pair.to] + ": " + error.what(), {},
                            {Things::shapes, {pair.from, pair.to}});
            }
        }
    }

    DistancesRecord between_domains(const std::vector<Surface>& surfaces) {
        refuse({align_option_, marking_option_},
               " is for surfaces with handles, or with three boundary loops and more");
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
        warn_of_unsettled(matrix);
        return {meshes_, matrix, cluster_by_distance(matrix.distance)};
    }

    void warn_of_unsettled(const DistanceMatrix& matrix) {
        for (const auto& [i, j] : matrix.unsettled)
            record_.warnings.push_back({WarningKind::distance,
                                        meshes_[i] + " and " + meshes_[j] +
                                            ": a map has not converged, has folds or is below what the meshes resolve; "
                                            "their distance is an estimate",
                                        {Things::shapes, {i, j}}});
    }

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

    void print(const DistancesRecord& found) const {
        const DistanceMatrix& matrix = found.matrix;
        for (std::size_t i = 0; i < found.tau.size(); ++i)
            fmt::print("{}: tau = {:.8f}{:+.8f}i\n", meshes_[i], found.tau[i].real() + 0.0, found.tau[i].imag());
        const auto where = [](const TorusDistances::Pair& pair, int column) {
            return fmt::format("{:+d}a{:+d}b", pair.marking(0, column), pair.marking(1, column));
        };
        std::size_t next = 0;  // of the markings, which come in this order
        for (Eigen::Index i = 0; i < matrix.distance.rows(); ++i)
            for (Eigen::Index j = i + 1; j < matrix.distance.cols(); ++j) {
                std::string marking;
                if (!found.markings.empty()) {
                    const TorusDistances::Pair& pair = found.markings[next++];
                    marking =
                        fmt::format("; {} marking sends a to {} and b to {}",
                                    marking_ == "closest" ? "this" : "the nearest", where(pair, 0), where(pair, 1));
                }
                fmt::print("{} {}: {:.6f} (between {:.6f} and {:.6f}), K = {:.6f}{}\n", meshes_[i], meshes_[j],
                           matrix.distance(i, j), matrix.lower(i, j), matrix.upper(i, j),
                           std::exp(2 * matrix.distance(i, j)), marking);
            }
    }

    std::vector<std::string> meshes_;
    std::string match_ = "position", picture_;
    int outer_ = 0;
    std::string align_ = "none", marking_;
    CLI::Option *outer_option_ = nullptr, *match_option_ = nullptr, *align_option_ = nullptr,
                *marking_option_ = nullptr;
    MeshInputOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_distance(CLI::App& parent) {
    return std::make_unique<DistanceCommand>(parent);
}

}  // namespace beltrami::cli
