#include <beltrami/unfold/branch_points.h>

#include <cmath>
#include <numbers>

namespace beltrami {

std::vector<int> branch_points(const Surface& source, const Eigen::VectorXcd& map) {
    const FaceList& faces = source.mesh.faces;
    // Angles at the corners, counter-clockwise, as far as the faces are not flipped.
    std::vector<double> angles(static_cast<std::size_t>(map.size()), 0.0);
    for (int f = 0; f < faces.size(); ++f) {
        const auto face = faces[f];
        const std::size_t n = face.size();
        for (std::size_t i = 0; i < n; ++i) {
            const Complex here = map[face[i]], next = map[face[(i + 1) % n]] - here,
                          last = map[face[(i + n - 1) % n]] - here;
            angles[face[i]] += std::arg(last * std::conj(next));
        }
    }
    std::vector<int> result;
    for (std::size_t v = 0; v < angles.size(); ++v)
        if (!source.topology.on_boundary[v] && angles[v] > 3 * std::numbers::pi) result.push_back(static_cast<int>(v));
    return result;
}

}  // namespace beltrami
