#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami::bench {

/// The flat torus of the unit square, its height stretched to s, less the rectangle [¼, ¾] × [⅜, ⅝] (likewise): genus 1
/// with one boundary loop. Stretching is extremal with K = s among maps that slide along the loop, exactly: dz² is
/// holomorphic and real along it.
struct SlitTorus {
    Surface surface;
    Eigen::MatrixX2d places;  ///< #V×2 in the unit square
};

/// @param cells along both sides, a multiple of 8; inner vertices are moved by up to a fifth of a cell, diagonals are
///              at random
/// @param refinements how often every face is then cut into four: meshes of one family, whose errors are not random
SlitTorus slit_torus(int cells, double stretch, unsigned seed, int refinements = 0);

/// The vertices of one nearest to where those of another are in the square, boundary vertices to boundary vertices.
std::vector<int> same_places(const SlitTorus& from, const SlitTorus& to);

}  // namespace beltrami::bench
