#include <beltrami/report/differential_file.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include <beltrami/differentials/zeros_and_poles.h>
#include <beltrami/locate/corner_weights.h>
#include <beltrami/operators/frames.h>

namespace beltrami {

namespace {

using Json = nlohmann::ordered_json;

/// [re, im] of each; JSON has no NaN and no infinity.
Json pairs(const Eigen::VectorXcd& values) {
    Json result = Json::array();
    for (const Complex value : values) {
        const bool finite = std::isfinite(value.real()) && std::isfinite(value.imag());
        result.push_back(finite ? Json{value.real(), value.imag()} : Json{nullptr, nullptr});
    }
    return result;
}

double mean_size(const Operators& operators, const Eigen::VectorXcd& phi) {
    double sum = 0;
    for (Eigen::Index s = 0; s < phi.size(); ++s) sum += operators.weights[s] * std::abs(phi[s]);
    return sum / operators.area();
}

}  // namespace

std::string differential_json(const Surface& mapped, const Eigen::VectorXcd& mu, const Eigen::VectorXcd& phi,
                              const QuadraticDifferential& differential) {
    const double size = mean_size(mapped.operators, phi);
    Json points = Json::array();
    for (const CriticalPoint& point : zeros_and_poles(mapped, differential))
        points.push_back({{"face", point.place.face},
                          {"weights", corner_weights(mapped.mesh, point.place)},
                          {"order", point.order},
                          {"on_boundary", point.on_boundary}});
    const Json file{{"schema", 1},
                    {"vertices", mapped.mesh.vertex_count()},
                    {"faces", mapped.mesh.face_count()},
                    {"frame", "first-edge"},
                    {"tabulated", differential.tabulated()},
                    {"zeros_and_poles", std::move(points)},
                    {"sample_faces", mapped.operators.faces},
                    {"mu", pairs(mu_along_first_edge(mapped, mu))},
                    {"phi", pairs(phi_along_first_edge(mapped, size > 0 ? Eigen::VectorXcd(phi / size) : phi))}};
    std::string text = "{";  // a line for each key: samples are many
    for (const auto& [key, value] : file.items())
        text += (text.size() > 1 ? ",\n \"" : "\n \"") + key + "\": " + value.dump();
    return text + "\n}\n";
}

}  // namespace beltrami
