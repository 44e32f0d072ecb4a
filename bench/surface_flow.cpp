// Seconds of a step of a flow along a surface against one harmonic map of the same mesh.
//
//     bench_surface_flow [NU]        default: 320, a torus of 320 × 160 cells, 102 400 triangles
//
// harmonic = operators, ordering, analysis, assembly, factorisation and solution, median of three, of the mesh less one
// face; step = assembly, factorisation, solution, retraction and line search, median of the steps after the first,
// which also orders and analyses; onto the first modified torus as a surface and as a mesh.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

#include <beltrami/beltrami.h>

#include "closed_harmonic.h"

namespace {

using namespace beltrami;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void measure(const char* name, const Surface& source, const Target& target, const TargetMap& start, double harmonic) {
    std::vector<double> seconds;
    double last = now();
    SurfaceFlowOptions options;
    options.max_iterations = 6;
    options.progress = [&](int, const SurfaceFlowIteration&, const TargetMap&) {
        seconds.push_back(now() - last);
        last = now();
        return true;
    };
    const SurfaceFlowMap flow = least_lp_map(source, target, {4, {}}, {}, start, options);
    const double first = seconds.front();
    std::sort(seconds.begin() + 1, seconds.end());
    const double median = seconds[(seconds.size() + 1) / 2];
    fmt::print("{:<8} first step {:.2f} s = {:.1f} harmonic maps, later ones {:.2f} s = {:.1f}; {} flips\n", name,
               first, first / harmonic, median, median / harmonic, flow.distortion.flipped.size());
}

}  // namespace

int main(int count, char** arguments) {
    const int nu = count > 1 ? std::atoi(arguments[1]) : 320, nv = nu / 2;
    const Surface source(torus(2, 1, nu, nv));
    const double harmonic = bench::closed_harmonic(source.mesh);
    fmt::print("{} triangles, harmonic map {:.2f} s\n", source.mesh.face_count(), harmonic);
    const ParametricTarget surface = first_modified_torus();
    TargetMap start;
    Mesh onto = source.mesh;
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) {
            start.points.push_back(surface.at(static_cast<double>(i) / nu, static_cast<double>(j) / nv));
            onto.positions.row(nv * i + j) = start.points.back().position;
        }
    measure("surface", source, surface, start, harmonic);
    const MeshTarget mesh(onto);
    measure("mesh", source, mesh, target_map(source, mesh, {}, onto.positions), harmonic);
}
