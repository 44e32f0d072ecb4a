#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <beltrami/generate/grids.h>

namespace beltrami::test {

/// The parallel v = 0 and the meridian u = 0 of torus() of generate/grids.h.
inline std::array<std::vector<int>, 2> parallel_and_meridian(int nu, int nv) {
    std::array<std::vector<int>, 2> paths;
    for (int i = 0; i < nu; ++i) paths[0].push_back(i * nv);
    for (int j = 0; j < nv; ++j) paths[1].push_back(j);
    return paths;
}

/// u − v: around and back once along the grid; crosses the parallel and the meridian once.
inline std::vector<int> twisted(int nu, int nv, int turns) {
    std::vector<int> path;
    int j = 0;
    for (int i = 0; i < nu; ++i) {
        path.push_back(i * nv + j);
        // The turns are shared out; each is a step along the meridian.
        const int wanted = turns * nv * (i + 1) / nu;
        const int before = turns * nv * i / nu;
        const int next = (i + 1) % nu;
        const int sign = turns > 0 ? 1 : -1;
        for (int s = before; s != wanted; s += sign) {
            if (s == before) path.push_back(next * nv + j);
            j = (j + sign + nv) % nv;
            if (s + sign != wanted) path.push_back(next * nv + j);
        }
    }
    return path;
}

}  // namespace beltrami::test
