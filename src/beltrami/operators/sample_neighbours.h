#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// Samples beside each other, with the factors that turn a neighbour's coefficient into a sample's frame: e^{−2iθ}
/// across their common edge, so that surfaces need no flattening. A quad's samples are neighbours of each other.
class SampleNeighbours {
  public:
    /// @param source kept by reference
    explicit SampleNeighbours(const Surface& source);

    /// One Jacobi step of smoothing the arguments of complex numbers, which keep no size: every argument goes by this
    /// part of the way to those of the neighbours, an edge without a neighbour counting as one that agrees. Differences
    /// are taken in (−π, π], so that no branch of the argument matters.
    /// @param phase    #S, in the samples' frames
    /// @param smoothed #S of modulus 1
    void smooth(const Eigen::VectorXcd& phase, double part, Eigen::VectorXcd& smoothed) const;

  private:
    struct Pair {
        int a, b;
        Complex b_to_a;
    };
    struct End {
        int sample;
        Complex across;  // normal to the edge in the sample's frame
    };
    struct Side {
        End start, end;
    };

    Side side(const FaceList& faces, int face, int corner) const;
    static Pair join(const End& a, const End& b, bool one_frame);

    const Operators& operators_;
    std::vector<int> first_sample_;  // #F
    std::vector<int> offsets_, samples_;
    std::vector<Complex> turns_;
};

}  // namespace beltrami
