#include <beltrami/solve/coupled_system.h>

#include <algorithm>

#include <beltrami/base/disjoint_sets.h>

namespace beltrami {

namespace {

/// The pattern with two unknowns in place of every one.
SymmetricSolver::Matrix doubled(const SymmetricSolver::Matrix& pattern) {
    const int count = static_cast<int>(pattern.cols());
    SymmetricSolver::Matrix result(2 * count, 2 * count);
    result.makeCompressed();
    result.resizeNonZeros(4 * pattern.nonZeros() - count);
    int *begins = result.outerIndexPtr(), *row = result.innerIndexPtr(), at = 0;
    for (int c = 0; c < count; ++c)
        for (int part = 0; part < 2; ++part) {
            *begins++ = at;
            for (SymmetricSolver::Matrix::InnerIterator entry(pattern, c); entry; ++entry)
                for (int i = entry.row() == c ? part : 0; i < 2; ++i, ++at)
                    *row++ = 2 * static_cast<int>(entry.row()) + i;
        }
    *begins = at;
    result.coeffs().setZero();
    return result;
}

}  // namespace

CoupledSystem::CoupledSystem(const Operators& operators, const std::vector<Freedom>& freedoms,
                             int expected_factorizations)
    : place_(freedoms.size(), -1) {
    int moving = 0;
    for (std::size_t v = 0; v < freedoms.size(); ++v)
        if (freedoms[v] != Freedom::fixed) place_[v] = moving++;
    count_ = 2 * moving;
    std::vector<int> offsets{0}, places;
    for (int s = 0; s < operators.sample_count(); ++s) {
        for (const int v : operators.stencil(s)) places.push_back(place_[v]);
        offsets.push_back(static_cast<int>(places.size()));
    }
    assembly_ = std::make_unique<ElementAssembly>(std::move(offsets), std::move(places), moving);
    const SymmetricSolver::Matrix pattern = assembly_->pattern();
    begins_.assign(pattern.outerIndexPtr(), pattern.outerIndexPtr() + moving + 1);
    solver_ = std::make_unique<SymmetricSolver>(doubled(pattern), expected_factorizations, 2);
    gradient_ = Eigen::VectorXd::Zero(count_);
}

CoupledSystem::Block CoupledSystem::block_at(int slot, int column) const {
    const int begin = 4 * begins_[column] - column, row = 2 * (slot - begins_[column]);
    return {begin + row, begin + 2 * (begins_[column + 1] - begins_[column]) + row - 1};
}

void CoupledSystem::set_zero() {
    gradient_.setZero();
    solver_->matrix().coeffs().setZero();
}

void CoupledSystem::add(int sample, const double* gradient, const double* hessian) {
    const auto places = assembly_->unknowns(sample);
    const int* slot = assembly_->slots(sample).data();
    double* values = solver_->matrix().valuePtr();
    for (std::size_t i = 0; i < places.size(); ++i) {
        // Rows 2i and 2i+1 of the Hessian's lower triangle.
        const double *real = hessian + i * (2 * i + 1), *imaginary = real + 2 * i + 1;
        if (places[i] >= 0) {
            gradient_[2 * places[i]] += gradient[2 * i];
            gradient_[2 * places[i] + 1] += gradient[2 * i + 1];
        }
        for (std::size_t j = 0; j < i; ++j, ++slot) {
            if (*slot < 0) continue;
            const Block at = block_at(*slot, std::min(places[i], places[j]));
            const bool below = places[i] > places[j];
            values[at.first] += real[2 * j];
            values[at.first + 1] += below ? imaginary[2 * j] : real[2 * j + 1];
            values[at.second] += below ? real[2 * j + 1] : imaginary[2 * j];
            values[at.second + 1] += imaginary[2 * j + 1];
        }
        if (*slot >= 0) {
            const Block at = block_at(*slot, places[i]);
            values[at.first] += real[2 * i];
            values[at.first + 1] += imaginary[2 * i];
            values[at.second + 1] += imaginary[2 * i + 1];
        }
        ++slot;
    }
}

void CoupledSystem::scale_diagonal(double factor) {
    auto& matrix = solver_->matrix();
    // The diagonal is the first entry of every column of a lower triangle.
    for (int c = 0; c < count_; ++c) matrix.valuePtr()[matrix.outerIndexPtr()[c]] *= factor;
}

CoupledSystem::Step CoupledSystem::solve() {
    solver_->factorize();
    const Eigen::VectorXd solution = solver_->solve(-gradient_);
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
