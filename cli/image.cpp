#include <array>

#include <fmt/format.h>

#include <beltrami/applications/deformed_picture.h>
#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/io/extension.h>
#include <beltrami/mesh/texture_map.h>
#include <beltrami/operators/distortion.h>

#include "command.h"
#include "parse.h"
#include "png_file.h"

namespace beltrami::cli {

namespace {

/// A picture that lies on a mesh of the plane, deformed by its map.
class Image final : public Command {
  public:
    explicit Image(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand("image", "a picture in the plane deformed by a map");
        app->add_option("MAP", map_,
                        "a mesh in the plane whose texture coordinates are the map, as `map` writes it; with its "
                        "--evening never the picture is smoothest")
            ->required();
        app->add_option("PICTURE", picture_,
                        "a PNG, which lies on MAP's mesh: over the box around it, or as --place says")
            ->required();
        app->add_option("-o,--output", output_, "the deformed picture, a PNG; transparent where no image is")
            ->required()
            ->type_name("OUT.png");
        app->add_option("--place", place_, "the lower left and the upper right corner of PICTURE, in MAP's units")
            ->type_name("X0,Y0,X1,Y1");
        app->add_option("--width", options_.width,
                        "of OUT, in pixels; its height follows from the box around the image")
            ->check(CLI::Range(1, 100000))
            ->capture_default_str();
        app->add_option("--between", between_,
                        "vertices: smooth, by polynomials fitted around them, without bends at edges; linear on the "
                        "triangles, as the map itself")
            ->check(CLI::IsMember({"smooth", "linear"}))
            ->capture_default_str();
        app->add_flag("--quiet", common_.quiet, "print nothing but errors");
        app->add_option_function<int>(
               "--threads", [](int count) { set_thread_count(count); },
               "use N threads; the result does not depend on it")
            ->type_name("N")
            ->check(CLI::Range(1, 1024));
        app->footer(kExitCodes);
    }

    int run() override {
        if (lower_case_extension(output_) != ".png")
            throw Error(Cause::bad_option, "-o " + output_ + ": pictures are written as PNG alone",
                        "name the output with the extension .png");
        check_files({{"MAP", map_}, {"PICTURE", picture_}}, {{"-o", output_}});
        const Surface source(load(map_, record_.warnings));
        add_findings(source.findings, record_.warnings);
        if (!source.in_plane())
            throw Error(Cause::bad_mesh, "MAP does not lie in a plane z = const, on which a picture could lie",
                        "give the map of a mesh in the plane");
        const Eigen::VectorXcd map = texture_map(source.mesh);
        if (const std::size_t flipped = distortion(source.operators, map).flipped.size(); flipped > 0)
            record_.warnings.push_back({WarningKind::flipped_faces,
                                        counted(flipped, "face is flipped", "faces are flipped") +
                                            ": where the image overlaps itself, the first face is seen",
                                        {}});
        options_.place = place_.empty() ? box_around(source.mesh) : box_of(place_);
        options_.smooth = between_ == "smooth";
        const Picture result = deformed_picture(read_png(picture_), source, map, options_);
        write_png(output_, result);
        if (!common_.quiet) {
            fmt::print("{} x {} pixels\nwrote {}\n", result.width, result.height, output_);
            for (const Warning& warning : record_.warnings) complain("warning: " + warning.sentence);
        }
        return 0;
    }

  private:
    static Box box_around(const Mesh& mesh) {
        const Eigen::RowVectorXd low = mesh.positions.colwise().minCoeff(), high = mesh.positions.colwise().maxCoeff();
        return {{low[0], low[1]}, {high[0], high[1]}};
    }

    static Box box_of(const std::string& text) {
        const auto n = number_list(text);
        if (!n || n->size() != 4)
            throw Error(Cause::bad_option, "--place " + text + " is no box", "give four numbers: x0,y0,x1,y1");
        return {{(*n)[0], (*n)[1]}, {(*n)[2], (*n)[3]}};
    }

    std::string map_, picture_, output_, place_, between_ = "smooth";
    PictureOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_image(CLI::App& parent) {
    return std::make_unique<Image>(parent);
}

}  // namespace beltrami::cli
