#pragma once

#include <vector>

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/evening/dilatation_spread.h>
#include <beltrami/solve/vertex_samples.h>

namespace beltrami {

/// Gauss-Seidel sweeps on the spread of |μ|: one vertex after the other takes a 2×2 Gauss-Newton step, shortened until
/// its part of the energy falls and no sample is newly folded. Vertices of one colour share no sample and are moved at
/// once.
class DilatationSweeps {
  public:
    /// Colours the vertices that are free, in their order, each with the first colour that no neighbour has.
    DilatationSweeps(const Operators& operators, const VertexSamples& around, const std::vector<Freedom>& freedoms);

    /// @param spread in: of @p f, out: of the moved f
    void run(DilatationSpread& spread, Eigen::VectorXcd& f, int sweeps, double outlier_penalty) const;

    int colour_count() const { return static_cast<int>(colours_.size()) - 1; }

  private:
    struct Incidence {
        double h_re, h_im;  // half gradient of the vertex in the sample
        int sample;
    };
    std::vector<int> colours_;   // of the lists below: colour c is [colours_[c], colours_[c+1])
    std::vector<int> vertices_;  // free ones, colour after colour
    std::vector<int> offsets_;   // of incidences_, beside vertices_
    std::vector<Incidence> incidences_;
};

}  // namespace beltrami
