#include <cmath>

#include <fmt/format.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/locate/map_evaluation.h>
#include <beltrami/locate/point_at.h>
#include <beltrami/operators/distortion.h>

#include "command.h"
#include "place_file.h"

namespace beltrami::cli {

namespace {

/// Reads places of the source and points of its image, and writes both.
class PointFile {
  public:
    PointFile(const std::string& path, const Mesh& mesh, bool inverse)
        : path_(path),
          mesh_(mesh),
          rows_(read_number_rows(path, inverse ? 2 : 3, inverse ? 2 : 5,
                                 inverse ? "a point u v" : "a point x y z, or face and weights of its corners")) {}

    const std::vector<NumberRow>& rows() const { return rows_; }

    MeshPoint place(const NumberRow& row) const { return place_of_row(path_, row, mesh_); }

    Eigen::Vector3d point(const NumberRow& row) const {
        require_finite(row);
        return {row.numbers[0], row.numbers[1], row.numbers[2]};
    }

    Complex image(const NumberRow& row) const {
        require_finite(row);
        return {row.numbers[0], row.numbers[1]};
    }

    [[noreturn]] void fail(const NumberRow& row, const std::string& what, Cause cause = Cause::unreadable,
                           const std::string& next_step = "repair the line") const {
        fail_at_row(path_, row, what, cause, next_step);
    }

  private:
    void require_finite(const NumberRow& row) const {
        for (const double number : row.numbers)
            if (!std::isfinite(number)) fail(row, "a coordinate is not finite");
    }

    std::string path_;
    const Mesh& mesh_;
    std::vector<NumberRow> rows_;
};

class Apply final : public Command {
  public:
    explicit Apply(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand("apply", "a map, or its inverse, at any points: linear on triangles");
        app->add_option("MAP", map_, "a mesh whose texture coordinates are the map, as `map` writes it; seams allowed")
            ->required();
        app->add_option("POINTS", points_,
                        "a line each: `face b0 b1 b2` with weights of the face's corners (of a quad `b0 b1 b2 b3`, one "
                        "of them 0), or `x y z`, for which the nearest point of the surface is taken; with --inverse "
                        "`u v`")
            ->required();
        app->add_option(
               "-o,--output", output_,
               "lines `u v`; with --inverse `face b0 b1 b2` (of quads four weights), which can be POINTS again")
            ->required()
            ->type_name("OUT");
        app->add_flag("--inverse", inverse_, "from the plane back to the surface");
        app->add_flag("--positions", positions_, "with --inverse write `x y z` instead of faces and weights");
        app->add_flag("--quiet", quiet_, "print nothing but errors");
        app->footer(kExitCodes);
    }

    int run() override {
        if (positions_ && !inverse_)
            throw Error(Cause::bad_option, "--positions belongs to --inverse", "leave it out, or give --inverse");
        check_files({{"MAP", map_}, {"POINTS", points_}}, {{"-o", output_}});
        Warnings warnings;
        const Mesh mesh = load(map_, warnings);
        const Surface source(mesh);
        add_findings(source.findings, warnings);
        const Positions corners = texture_corners(mesh);
        if (const std::size_t folded = distortion_to_corners(mesh, corners).flipped.size(); folded && inverse_)
            warnings.push_back({WarningKind::flipped_faces,
                                counted(folded, "face is flipped", "faces are flipped") +
                                    ": where the image overlaps itself, the place on the first face is taken"});
        const MapEvaluation map = MapEvaluation::of_corners(mesh, corners);
        const PointFile points(points_, mesh, inverse_);
        write_atomically(output_, inverse_ ? places(map, mesh, points) : images(map, points));
        if (!quiet_) {
            fmt::print("{}", counted(points.rows().size(), "point", "points"));
            if (farthest_ > 0) fmt::print(", the farthest {:.3g} away from the surface", farthest_);
            fmt::print("\nwrote {}\n", output_);
            for (const Warning& warning : warnings) complain("warning: " + warning.sentence);
        }
        return 0;
    }

  private:
    std::string images(const MapEvaluation& map, const PointFile& points) {
        std::string text;
        for (const NumberRow& row : points.rows()) {
            MeshPoint place;
            if (row.numbers.size() == 3) {
                const MapEvaluation::Nearest nearest = map.nearest(points.point(row));
                farthest_ = std::max(farthest_, nearest.distance);
                place = nearest.place;
            } else {
                place = points.place(row);
            }
            const Complex image = map.image(place);
            text += fmt::format("{} {}\n", image.real(), image.imag());
        }
        return text;
    }

    std::string places(const MapEvaluation& map, const Mesh& mesh, const PointFile& points) const {
        std::vector<Complex> images;
        for (const NumberRow& row : points.rows()) images.push_back(points.image(row));
        std::vector<MeshPoint> found;
        try {
            found = map.preimages(images);
        } catch (const Error& error) {
            if (error.indices().empty()) throw;
            const std::size_t count = error.indices().size();
            points.fail(points.rows()[error.indices()[0]],
                        "the point lies outside the image of the map" +
                            (count > 1 ? fmt::format(", one of {} that do", count) : std::string()),
                        error.cause(), "only points of the image have a place on the surface");
        }
        std::string text;
        for (const MeshPoint& place : found) text += positions_ ? position(mesh, place) : line_of_place(mesh, place);
        return text;
    }

    static std::string position(const Mesh& mesh, const MeshPoint& place) {
        const Eigen::Vector3d p = point_at(mesh, place);
        return fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    }

    std::string map_, points_, output_;
    bool inverse_ = false, positions_ = false, quiet_ = false;
    double farthest_ = 0;
};

}  // namespace

std::unique_ptr<Command> make_apply(CLI::App& parent) {
    return std::make_unique<Apply>(parent);
}

}  // namespace beltrami::cli
