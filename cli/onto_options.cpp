#include "onto_options.h"

#include <limits>

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/io/extension.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/io/target_file.h>

#include "command.h"
#include "parse.h"
#include "space_target.h"

namespace beltrami::cli {

void OntoTarget::add_to(CLI::App& app, Kinds kinds) {
    kinds_ = kinds;
    const bool meshes = kinds != Kinds::domains;
    const std::string source = meshes ? "SOURCE" : "SURFACE",
                      domain =
                          "a domain in JSON: {\"outer\": LOOP, \"holes\": [LOOP, ...]}, LOOP one of "
                          "{\"circle\": [x,y,r]}, {\"polygon\": [[x,y],...]}, {\"spline\": [[x,y],...]}";
    app.add_option("--onto", path_,
                   "the boundary slides: every boundary loop of " + source + " goes onto its partner of TARGET, " +
                       (meshes ? "a mesh with as many boundary loops, or " : "") + domain +
                       (kinds == Kinds::meshes_and_domains
                            ? std::string("; or the map goes along a surface in space: ") + kNamedSurfaces +
                                  ", or any mesh that is closed or has --boundary, --curves or --minimize-lp beside it"
                            : ""))
        ->type_name("TARGET");
    app.add_option("--loops", pair_specs_,
                   "pairs of boundary loops, " + source +
                       "'s as `beltrami info` prints them and TARGET's (of a domain: 0 the outer curve, then the "
                       "holes from 1); default: matched, see --match")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("0:0,1:2,...");
    app.add_option("--match", match_,
                   "without --loops, holes go to those nearest after the best Moebius map of the disk, or of like size")
        ->check(CLI::IsMember({"position", "size"}))
        ->capture_default_str();
    app.add_option("--marks", marks_file_,
                   "boundary vertices of " + source +
                       " with their places on the curves of a domain: a line `source_vertex x y` each, the nearest "
                       "point of the nearest curve is meant")
        ->type_name("FILE");
    if (!meshes) return;
    app.add_option("--mark-vertices", mark_vertices_file_,
                   "the same with vertices of a mesh TARGET: a line `source_vertex target_vertex` each")
        ->type_name("FILE");
    if (kinds == Kinds::prescribed_too)
        app.add_option("--correspondence", correspondence_file_,
                       "the boundary does not slide but is prescribed on that of a mesh TARGET: a line `source_vertex "
                       "target_vertex` for one or more vertices of every boundary loop; between them it runs by arc "
                       "length")
            ->type_name("FILE");
    app.add_option("--places", places_,
                   "where on a mesh TARGET every vertex goes: a line `vertex face a b c wa wb wc` each, the face's "
                   "vertices a b c with their barycentric weights")
        ->type_name("FILE");
}

std::string OntoTarget::stray() const {
    if (!pair_specs_.empty()) return "--loops";
    if (!marks_file_.empty()) return "--marks";
    if (!mark_vertices_file_.empty()) return "--mark-vertices";
    if (!correspondence_file_.empty()) return "--correspondence";
    if (!places_.empty()) return "--places";
    return match_ == "position" ? "" : "--match";
}

std::vector<NamedFile> OntoTarget::inputs() const {
    return {{"--onto", path_},
            {"--marks", marks_file_},
            {"--mark-vertices", mark_vertices_file_},
            {"--correspondence", correspondence_file_}};
}

void OntoTarget::load(const MeshInput& input, Warnings& warnings) {
    if (lower_case_extension(path_) == ".json") {
        domain_ = read_target_domain(path_);
    } else if (kinds_ == Kinds::domains) {
        throw Error(Cause::bad_option, "--onto " + path_ + " is no domain in JSON",
                    "the name of a domain ends in .json; see --help");
    } else {
        surface_.emplace(cli::load(path_, warnings));
        add_findings(surface_->findings, warnings);
    }
    for (const std::string& spec : pair_specs_) {
        const std::size_t colon = spec.find(':');
        const auto loop = whole_number(spec.substr(0, colon)),
                   partner = colon == std::string::npos ? std::nullopt : whole_number(spec.substr(colon + 1));
        if (!loop || !partner || *loop < 0 || *partner < 0)
            throw Error(Cause::bad_option, "--loops " + spec + " is not a pair s:t of loops",
                        "`beltrami info` prints the loops' numbers");
        pairs_.push_back({*loop, *partner});
    }
    read_marks(input, warnings);
    if (!places_.empty() && domain_)
        throw Error(Cause::bad_option, "--places is about the faces of a mesh, TARGET is a domain", "leave it out");
}

void OntoTarget::read_marks(const MeshInput& input, Warnings& warnings) {
    if (!marks_file_.empty()) {
        if (!domain_)
            throw Error(Cause::bad_option, "--marks is about the curves of a domain, TARGET is a mesh",
                        "give --mark-vertices");
        const IndexedRows rows = read_indexed_rows(marks_file_, 1, static_cast<int>(input.numbers.size()), 2,
                                                   "a marked vertex with its place");
        for (Eigen::Index i = 0; i < rows.indices.rows(); ++i) {
            marks_.push_back(
                {input.number_of(rows.indices(i, 0), "a marked one"), Complex(rows.values(i, 0), rows.values(i, 1))});
            const auto& [vertex, place] = marks_.back();
            const Mark mark = nearest_mark(*domain_, vertex, place);
            const double part = distance_from(*domain_, mark, place);
            if (part > kFarMark)
                warnings.push_back(
                    {WarningKind::marks,
                     fmt::format("the place of the marked vertex {} is {:.2g} % of the length of {} away "
                                 "from that curve, the nearest one; its nearest point is taken",
                                 vertex, 100 * part, curve_name(on_curve(mark).curve)),
                     {Things::vertices, {vertex}}});
        }
    }
    const auto read_pairs = [&](const std::string& option, const std::string& file, const char* instead) {
        std::vector<std::array<int, 2>> pairs;
        if (file.empty()) return pairs;
        if (!surface_)
            throw Error(Cause::bad_option, option + " is about the vertices of a mesh, TARGET is a domain", instead);
        const IndexedRows rows =
            read_indexed_rows(file, 2, std::numeric_limits<int>::max(), 0, "a vertex with its partner");
        for (Eigen::Index i = 0; i < rows.indices.rows(); ++i)
            pairs.push_back({input.number_of(rows.indices(i, 0), "one with a partner"), rows.indices(i, 1)});
        return pairs;
    };
    mark_vertices_ = read_pairs("--mark-vertices", mark_vertices_file_, "give --marks");
    correspondence_ = read_pairs("--correspondence", correspondence_file_, "give --boundary, --hole or --pin");
}

void OntoTarget::apply(Correspondence& wanted) const {
    wanted.loops = pairs_;
    wanted.match_by = match_ == "size" ? MatchBy::size : MatchBy::position;
    for (const auto& [vertex, to] : mark_vertices_) wanted.marks.emplace_back(vertex, TargetVertex{to});
    for (const PlaceMark& mark : marks_) wanted.marks.push_back(nearest_mark(*domain_, mark.vertex, mark.place));
}

void OntoTarget::apply(Constraints& constraints) const {
    apply(constraints.correspondence);
    if (domain_) {
        constraints.target = *domain_;
    } else {
        constraints.target = SurfaceTarget{&*surface_};
    }
}

void OntoTarget::write_places(const std::vector<MeshPoint>& places) const {
    if (!places_.empty()) cli::write_places(places_, places);
}

void write_places(const std::string& path, const std::vector<MeshPoint>& places) {
    std::string text = "# vertex face a b c weight_a weight_b weight_c\n";
    for (std::size_t v = 0; v < places.size(); ++v) {
        const MeshPoint& p = places[v];
        text += fmt::format("{} {} {} {} {} {:.17g} {:.17g} {:.17g}\n", v, p.face, p.vertices[0], p.vertices[1],
                            p.vertices[2], p.barycentric[0], p.barycentric[1], p.barycentric[2]);
    }
    write_atomically(path, text);
}

}  // namespace beltrami::cli
