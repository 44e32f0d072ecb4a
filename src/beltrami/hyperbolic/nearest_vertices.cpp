#include <beltrami/hyperbolic/nearest_vertices.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/locate/surface_locator.h>

namespace beltrami {

namespace {

/// For every boundary loop of the source the loop of the target that its points are nearest to on the mean, and for
/// every vertex of it the nearest vertex there.
void pair_loops(const std::vector<std::vector<int>>& of_source, const std::vector<std::vector<int>>& of_target,
                const Mesh& target, const Positions& points, std::vector<int>& images) {
    if (of_source.size() != of_target.size())
        throw Error(Cause::bad_mesh,
                    "the source has " + std::to_string(of_source.size()) + " boundary loops, the target " +
                        std::to_string(of_target.size()),
                    "take surfaces of one topology");
    std::vector<int> taken_by(of_target.size(), -1);
    for (std::size_t l = 0; l < of_source.size(); ++l) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t partner = 0;
        std::vector<int> nearest;
        for (std::size_t m = 0; m < of_target.size(); ++m) {
            double sum = 0;
            std::vector<int> there;
            for (const int v : of_source[l]) {
                double distance = std::numeric_limits<double>::infinity();
                int found = -1;
                for (const int w : of_target[m]) {
                    const double d = (points.row(v).transpose() - target.point(w)).norm();
                    if (d < distance) {
                        distance = d;
                        found = w;
                    }
                }
                sum += distance;
                there.push_back(found);
            }
            if (!(sum < least)) continue;
            least = sum;
            partner = m;
            nearest = std::move(there);
        }
        if (taken_by[partner] >= 0)
            throw Error(Cause::bad_option,
                        "boundary loops " + std::to_string(taken_by[partner]) + " and " + std::to_string(l) +
                            " of the source both lie nearest to loop " + std::to_string(partner) + " of the target",
                        "bring the source nearer to the target, or give a start");
        taken_by[partner] = static_cast<int>(l);
        for (std::size_t i = 0; i < nearest.size(); ++i) images[of_source[l][i]] = nearest[i];
    }
}

}  // namespace

std::vector<int> nearest_vertices(const Mesh& target, const FaceList& faces, const Positions& points) {
    std::vector<std::array<int, 3>> triangles;
    triangles.reserve(static_cast<std::size_t>(faces.size()));
    for (int t = 0; t < faces.size(); ++t) triangles.push_back({faces[t][0], faces[t][1], faces[t][2]});
    const SurfaceLocator locator(target.positions, triangles);
    std::vector<int> result;
    for (Eigen::Index p = 0; p < points.rows(); ++p) {
        const SurfaceLocator::Place place = locator.nearest(points.row(p).transpose());
        const auto largest = std::max_element(place.barycentric.begin(), place.barycentric.end());
        result.push_back(triangles[static_cast<std::size_t>(place.triangle)]
                                  [static_cast<std::size_t>(largest - place.barycentric.begin())]);
    }
    return result;
}

std::vector<int> nearest_vertices(const Topology& source, const Topology& of_target, const Mesh& target,
                                  const FaceList& triangles, const Positions& points) {
    std::vector<int> images = nearest_vertices(target, triangles, points);
    pair_loops(source.boundary_loops, of_target.boundary_loops, target, points, images);
    return images;
}

}  // namespace beltrami
