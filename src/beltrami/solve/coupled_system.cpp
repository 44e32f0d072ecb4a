#include <beltrami/solve/coupled_system.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <beltrami/base/disjoint_sets.h>

namespace beltrami {

namespace {

std::vector<int> places_of(const std::vector<Freedom>& freedoms) {
    std::vector<int> place(freedoms.size(), -1);
    int count = 0;
    for (std::size_t v = 0; v < freedoms.size(); ++v)
        if (freedoms[v] != Freedom::fixed) place[v] = count++;
    return place;
}

ElementSystem system_of(const Operators& operators, const std::vector<int>& place, int expected_factorizations) {
    std::vector<int> places;
    places.reserve(operators.vertices.size());
    for (const int v : operators.vertices) places.push_back(place[v]);
    const auto fixed = std::count(place.begin(), place.end(), -1);
    return {operators.offsets, std::move(places), static_cast<int>(static_cast<std::ptrdiff_t>(place.size()) - fixed),
            expected_factorizations, 2};
}

}  // namespace

CoupledSystem::CoupledSystem(const Operators& operators, const std::vector<Freedom>& freedoms,
                             int expected_factorizations)
    : place_(places_of(freedoms)),
      system_(system_of(operators, place_, expected_factorizations)),
      gradient_(Eigen::VectorXd::Zero(system_.unknown_count())) {}

void CoupledSystem::set_zero() {
    gradient_.setZero();
    system_.clear();
}

void CoupledSystem::add(int sample, const double* gradient, const double* hessian) {
    const auto places = system_.nodes(sample);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i] < 0) continue;
        gradient_[2 * places[i]] += gradient[2 * i];
        gradient_[2 * places[i] + 1] += gradient[2 * i + 1];
    }
    system_.add(sample, {hessian, places.size() * (2 * places.size() + 1)});
}

void CoupledSystem::scale_diagonal(double factor) {
    system_.scale_diagonal(factor);
}

CoupledSystem::Step CoupledSystem::solve() {
    system_.factorize();
    const Eigen::VectorXd solution = system_.solve(-gradient_);
    Step step{Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(place_.size())), gradient_.dot(solution)};
    for (std::size_t v = 0; v < place_.size(); ++v)
        if (place_[v] >= 0)
            step.direction[static_cast<Eigen::Index>(v)] = {solution[2 * place_[v]], solution[2 * place_[v] + 1]};
    return step;
}

void fix_similarity(const Surface& source, const Eigen::VectorXcd& map, std::vector<Freedom>& freedoms) {
    const FaceList& faces = source.mesh.faces;
    std::vector<char> referenced(freedoms.size(), 0);
    for (const int v : faces.vertices()) referenced[v] = 1;
    for (std::size_t v = 0; v < freedoms.size(); ++v)
        if (!referenced[v]) freedoms[v] = Freedom::fixed;
    DisjointSets sets(source.mesh.vertex_count());
    for (int f = 0; f < faces.size(); ++f)
        for (const int v : faces[f]) sets.join(faces[f][0], v);
    struct Component {
        int free = 0, fixed = 0, anchor = -1;
    };
    std::vector<Component> components(source.mesh.vertex_count());
    for (int v = 0; v < source.mesh.vertex_count(); ++v) {
        Component& c = components[sets.find(v)];
        if (freedoms[v] == Freedom::fixed) {
            ++c.fixed;
            c.anchor = v;
        } else {
            ++c.free;
        }
    }
    const auto hold_farthest = [&](int component, Complex from) {
        int best = -1;
        double most = -1;
        for (int v = 0; v < source.mesh.vertex_count(); ++v)
            if (freedoms[v] == Freedom::free && sets.find(v) == component && std::norm(map[v] - from) > most) {
                most = std::norm(map[v] - from);
                best = v;
            }
        if (best >= 0) freedoms[best] = Freedom::fixed;
        return best;
    };
    for (int c = 0; c < source.mesh.vertex_count(); ++c) {
        if (sets.find(c) != c || components[c].free == 0 || components[c].fixed >= 2) continue;
        int anchor = components[c].anchor;
        if (anchor < 0) anchor = hold_farthest(c, map[c]);
        if (anchor >= 0) hold_farthest(c, map[anchor]);
    }
}

}  // namespace beltrami
