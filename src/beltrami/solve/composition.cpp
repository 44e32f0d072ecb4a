#include <beltrami/solve/composition.h>

#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami {

Eigen::VectorXcd compose_maps(const Eigen::VectorXcd& f, const Mesh& middle, const Eigen::VectorXcd& g,
                              double tolerance) {
    if (g.size() != middle.vertex_count())
        throw Error(Cause::bad_mesh, "the second map has " + std::to_string(g.size()) + " values, its mesh " +
                                         std::to_string(middle.vertex_count()) + " vertices");
    const PlanarLocator locator(middle);
    Eigen::VectorXcd points(middle.vertex_count());
    for (int v = 0; v < middle.vertex_count(); ++v) points[v] = {middle.positions(v, 0), middle.positions(v, 1)};
    Eigen::VectorXcd result(f.size());
    std::vector<char> outside(f.size(), 0);
    parallel_for(0, static_cast<int>(f.size()), [&](int first, int last) {
        for (int v = first; v < last; ++v) {
            const MeshPoint place = locator.nearest(f[v]);
            outside[v] = !(std::abs(place.interpolate(points) - f[v]) <= tolerance * locator.diameter());
            result[v] = place.interpolate(g);
        }
    });
    std::vector<int> far;
    for (int v = 0; v < static_cast<int>(f.size()); ++v)
        if (outside[v]) far.push_back(v);
    if (!far.empty()) {
        const std::string sentence =
            std::to_string(far.size()) +
            " points of the first map lie outside the mesh of the second, the first is vertex " +
            std::to_string(far[0]);
        throw Error(Cause::bad_boundary, sentence, "the first map's image must be the second's domain",
                    {Things::vertices, std::move(far)});
    }
    return result;
}

}  // namespace beltrami
