#pragma once

#include <array>
#include <vector>

namespace beltrami::test {

/// The parallel v = 0 and the meridian u = 0 of torus() of generate/grids.h.
inline std::array<std::vector<int>, 2> parallel_and_meridian(int nu, int nv) {
    std::array<std::vector<int>, 2> paths;
    for (int i = 0; i < nu; ++i) paths[0].push_back(i * nv);
    for (int j = 0; j < nv; ++j) paths[1].push_back(j);
    return paths;
}

/// Along the parallel, and then along the meridian or back along it.
inline std::vector<int> parallel_then_meridian(int nu, int nv, bool back) {
    auto [path, meridian] = parallel_and_meridian(nu, nv);
    path.push_back(0);
    for (int j = 1; j < nv; ++j) path.push_back(meridian[back ? nv - j : j]);
    return path;
}

}  // namespace beltrami::test
