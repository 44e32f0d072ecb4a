#include <beltrami/maps/coupled_system.h>

#include <beltrami/mesh/disjoint_sets.h>

namespace beltrami {

CoupledSystem::CoupledSystem(const Operators& operators, const std::vector<Freedom>& freedoms,
                             int expected_factorizations)
    : first_(freedoms.size(), -1) {
    for (std::size_t v = 0; v < freedoms.size(); ++v) {
        if (freedoms[v] == Freedom::fixed) continue;
        first_[v] = count_;
        count_ += 2;
    }
    std::vector<int> offsets{0}, unknowns;
    for (int s = 0; s < operators.sample_count(); ++s) {
        for (const int v : operators.stencil(s)) {
            unknowns.push_back(first_[v]);
            unknowns.push_back(first_[v] < 0 ? -1 : first_[v] + 1);
        }
        offsets.push_back(static_cast<int>(unknowns.size()));
    }
    assembly_ = std::make_unique<ElementAssembly>(std::move(offsets), std::move(unknowns), count_);
    solver_ = std::make_unique<SymmetricSolver>(assembly_->pattern(), expected_factorizations);
    gradient_ = Eigen::VectorXd::Zero(count_);
}

void CoupledSystem::set_zero() {
    gradient_.setZero();
    solver_->matrix().coeffs().setZero();
}

void CoupledSystem::add(int sample, const double* gradient, const double* hessian) {
    const auto unknowns = assembly_->unknowns(sample);
    const auto slots = assembly_->slots(sample);
    double* values = solver_->matrix().valuePtr();
    for (std::size_t i = 0; i < unknowns.size(); ++i)
        if (unknowns[i] >= 0) gradient_[unknowns[i]] += gradient[i];
    for (std::size_t k = 0; k < slots.size(); ++k)
        if (slots[k] >= 0) values[slots[k]] += hessian[k];
}

void CoupledSystem::scale_diagonal(double factor) {
    auto& matrix = solver_->matrix();
    // The diagonal is the first entry of every column of a lower triangle.
    for (int c = 0; c < count_; ++c) matrix.valuePtr()[matrix.outerIndexPtr()[c]] *= factor;
}

CoupledSystem::Step CoupledSystem::solve() {
    solver_->factorize();
    const Eigen::VectorXd solution = solver_->solve(-gradient_);
    Step step{Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(first_.size())), gradient_.dot(solution)};
    for (std::size_t v = 0; v < first_.size(); ++v)
        if (first_[v] >= 0)
            step.direction[static_cast<Eigen::Index>(v)] = {solution[first_[v]], solution[first_[v] + 1]};
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
