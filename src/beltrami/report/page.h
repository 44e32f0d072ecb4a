#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/report/page_differential.h>

namespace beltrami BELTRAMI_PUBLIC {

/// One map of the source mesh, to be shown on the page.
struct PageMap {
    std::string name;        ///< "extremal", "harmonic", …
    Positions map;           ///< #V×2 image of every vertex, or #V×3 for an image in space; NaN where undefined
    Eigen::VectorXd abs_mu;  ///< #F values of |μ|: above 1 where a face is flipped, NaN where undefined
    std::optional<PageDifferential> differential = {};  ///< of an extremal map: trajectories, zeros and poles
    /// A picture of the source itself, cut open in the plane: |μ|, ellipses, trajectories and zeros are those of the
    /// first map. abs_mu and differential stay empty. Not on a page whose mesh is coarsened.
    bool of_source = false;
    std::vector<Positions> outline = {};  ///< curves in the plane of the image, as of a fundamental polygon: #×2 each
};

/// Everything a page shows.
struct PageContent {
    const Mesh& source;
    std::vector<PageMap> maps;            ///< at least one; the first is the main one
    std::vector<double> history_k;        ///< k after each iteration; may be empty
    std::vector<double> history_change;   ///< change of each iteration; may be empty
    std::vector<double> history_largest;  ///< largest |μ| after each iteration; may be empty
    std::string record_json;              ///< the command's record, a JSON object ("{}" if there is none)
    std::string title;
    /// #V of a source that was cut open: equal numbers for the copies of a vertex. Lines go on across the cut, which
    /// the source's figure shows. Empty: none was cut.
    std::vector<int> joined = {};
    std::string texture = {};   ///< bytes of an image (PNG, JPEG, WebP or GIF) that lies in the plane; may be empty
    int drawn_faces = 400'000;  ///< a mesh of more triangles is coarsened, for drawing only; the page says so
};

/// @throw Error bad_option unless the bytes are those of a PNG, JPEG, WebP or GIF
void require_texture(const std::string& bytes);

/// One self-contained HTML file (UTF-8, nothing is fetched): the surface and its images coloured by |μ|, the histogram
/// of |μ|, the convergence, the bounds on K, the comparison and the record; ellipses and lines of largest and least
/// stretch, or the trajectories of φ with its zeros and poles. Every text is escaped. The figures want a browser with
/// WebGL 2.
/// @throw Error bad_option if there is no map, a size disagrees with the mesh, the texture is no image of these kinds,
///        or the record is not a JSON object.
std::string render_page(const PageContent& content);

}  // namespace beltrami
