#include <beltrami/flow/slid_map.h>

#include <beltrami/base/error.h>
#include <beltrami/starts/sliding_loops.h>

namespace beltrami {

void require_start_of(const Surface& source, const SlidingStart& start) {
    if (start.map.size() != source.mesh.vertex_count() || start.curves.size() != source.topology.boundary_loops.size())
        throw Error(Cause::bad_option, "the start belongs to another source", "make it with flow_start");
}

void record_map(const Surface& source, const SlidingStart& start, const SlidingBoundary& boundary, SlidMap& result) {
    result.factorizations += start.factorizations;
    result.distortion = distortion(source.operators, result.map);
    result.loops = loops_onto(source, boundary, start.curves, result.map);
}

}  // namespace beltrami
