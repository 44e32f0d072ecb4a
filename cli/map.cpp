#include <map>

#include <beltrami/baselines/baseline.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/maps/timing.h>
#include <beltrami/mesh/error.h>

#include "boundary_options.h"
#include "command.h"
#include "output.h"
#include "page.h"

namespace beltrami::cli {

namespace {

using Baseline = BaselineMap (*)(const Surface&, const BoundaryCondition&, const BaselineOptions&);

const std::map<std::string, Baseline>& baselines() {
    static const std::map<std::string, Baseline> methods{{"harmonic", harmonic_baseline},
                                                         {"lscm", lscm_baseline},
                                                         {"arap", arap_baseline},
                                                         {"mips", mips_baseline},
                                                         {"alternation", alternation_baseline},
                                                         {"qc", qc_iteration_baseline}};
    return methods;
}

class Map final : public Command {
  public:
    explicit Map(CLI::App& parent) {
        CLI::App* app =
            parent.add_subcommand("map", "map a surface to the plane; by default the map of least dilatation");
        app->add_option("SOURCE", source_, "OBJ, PLY, OFF or STL; a disk: one component, one boundary loop, genus 0")
            ->required();
        output_.add_to(*app);
        app->add_option(
               "--method", method_,
               "lscm, arap and mips can leave the boundary free; the others need every boundary vertex prescribed")
            ->check(CLI::IsMember({"extremal", "harmonic", "lscm", "arap", "mips", "alternation", "qc"}))
            ->capture_default_str();
        boundary_.add_to(*app);
        app->add_option("--metric", metric_,
                        "the metric of the source: FILE with a line `i j length` per edge, or vt for the edge lengths "
                        "of SOURCE's own vt")
            ->type_name("FILE|vt");
        app->add_option(
               "--compare", compare_,
               "further methods to set beside the map, on the same boundary values (lscm on its own free boundary)")
            ->delimiter(',')
            ->check(CLI::IsMember({"harmonic", "lscm", "arap", "mips", "alternation", "qc"}))
            ->type_name("METHOD,...");
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        check();
        Record record;
        record.command = "map";
        Mesh mesh = load(source_, record.warnings);
        boundary_.load(mesh);
        const std::vector<EdgeLength> lengths = load_metric(mesh);
        const double start = seconds();
        const Surface source = with_metric(std::move(mesh), lengths);
        add_findings(source.findings, record.warnings);
        record.source = source_record(source);
        const BoundaryCondition boundary = boundary_.values(source);

        std::vector<PageMap> maps;
        std::vector<Iteration> history;
        Distortion distortion;
        Eigen::VectorXcd map;
        if (method_ == "extremal") {
            ExtremalMap result = extremal(source, boundary);
            record.solve = solve_record(result, seconds() - start);
            record.map = map_record(result);
            record.warnings.insert(record.warnings.end(), result.warnings.begin(), result.warnings.end());
            history = std::move(result.history);
            maps.push_back({"extremal", positions_of(result.map), result.distortion.face_abs_mu});
            maps.push_back({"harmonic", positions_of(result.harmonic),
                            beltrami::distortion(source.operators, result.harmonic).face_abs_mu});
            map = std::move(result.map);
            distortion = std::move(result.distortion);
        } else {
            MethodRecord main = run_baseline(source, boundary, method_, start, maps, map, distortion, record.warnings);
            record.map = std::move(main.map);
            record.solve = std::move(main.solve);
        }
        for (const std::string& other : compare_) {
            if (other == method_) continue;
            Eigen::VectorXcd unused_map;
            Distortion unused;
            if (method_ == "extremal" && other == "harmonic") maps.pop_back();  // it comes again, with its record
            record.comparison.push_back(run_baseline(source, other == "lscm" ? BoundaryCondition() : boundary, other,
                                                     seconds(), maps, unused_map, unused, record.warnings));
        }
        if (common_.wants_record() && unprescribed_boundary(boundary, source).empty() &&
            !source.topology.boundary_loops.empty())
            record.solve->seconds_harmonic = harmonic_seconds(source, boundary);

        output_.write(source.mesh, map, distortion);
        write_page(common_.report, source.mesh, std::move(maps), history, record, source_);
        finish(record, common_, method_, {output_.path(), common_.json, common_.report});
        return 0;
    }

  private:
    void check() const {
        output_.check();
        std::vector<NamedFile> inputs = boundary_.inputs();
        inputs.push_back({"SOURCE", source_});
        if (metric_ != "vt") inputs.push_back({"--metric", metric_});
        common_.check_files(inputs, {{"-o", output_.path()}});
    }

    std::vector<EdgeLength> load_metric(const Mesh& mesh) const {
        std::vector<EdgeLength> lengths;
        if (metric_.empty() || metric_ == "vt") return lengths;
        const IndexedRows rows = read_indexed_rows(metric_, 2, mesh.vertex_count(), 1, "an edge of the metric");
        for (Eigen::Index i = 0; i < rows.indices.rows(); ++i)
            lengths.push_back({rows.indices(i, 0), rows.indices(i, 1), rows.values(i, 0)});
        return lengths;
    }

    Surface with_metric(Mesh mesh, const std::vector<EdgeLength>& lengths) const {
        if (metric_.empty()) return Surface(std::move(mesh));
        require_sound(mesh);
        Positions corners = metric_ == "vt" ? texture_corners(mesh) : corners_from_lengths(mesh, lengths);
        return Surface(std::move(mesh), std::move(corners));
    }

    ExtremalMap extremal(const Surface& source, const BoundaryCondition& boundary) const {
        Progress progress(!common_.quiet);  // gone before anything else is printed
        ExtremalOptions options;
        options.progress = [&](int iteration, double k) {
            progress.show(iteration, k);
            return true;
        };
        return extremal_map(source, boundary, options);
    }

    static MethodRecord run_baseline(const Surface& source, const BoundaryCondition& boundary,
                                     const std::string& method, double start, std::vector<PageMap>& maps,
                                     Eigen::VectorXcd& map, Distortion& distortion,
                                     std::vector<std::string>& warnings) {
        BaselineMap result = baselines().at(method)(source, boundary, {});
        MethodRecord record;
        record.method = method;
        record.solve.seconds_total = seconds() - start;
        record.solve.iterations = result.iterations;
        record.solve.factorizations = result.factorizations;
        record.solve.termination = result.converged ? "converged" : "iteration_limit";
        distortion = beltrami::distortion(source.operators, result.map);
        record.map = map_record(distortion);
        for (const std::string& warning : result.warnings) warnings.push_back(method + ": " + warning);
        maps.push_back({method, positions_of(result.map), distortion.face_abs_mu});
        map = std::move(result.map);
        return record;
    }

    std::string source_, method_ = "extremal", metric_;
    std::vector<std::string> compare_;
    OutputOptions output_;
    BoundaryOptions boundary_;
    CommonOptions common_;
};

}  // namespace

std::unique_ptr<Command> make_map(CLI::App& parent) {
    return std::make_unique<Map>(parent);
}

}  // namespace beltrami::cli
