#include <beltrami/locate/corner_weights.h>

namespace beltrami {

std::vector<double> corner_weights(const Mesh& mesh, const MeshPoint& place) {
    std::vector<double> result;
    for (const int v : mesh.faces[place.face]) {
        double weight = 0;
        for (int j = 0; j < 3; ++j)
            if (place.vertices[j] == v) weight = place.barycentric[j];
        result.push_back(weight);
    }
    return result;
}

}  // namespace beltrami
