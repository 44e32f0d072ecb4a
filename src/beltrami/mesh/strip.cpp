#include <beltrami/mesh/strip.h>

namespace beltrami {

namespace {

/// The search for a strip: breadth first over faces, from all along a loop.
class StripSearch {
  public:
    StripSearch(const Mesh& mesh, const Topology& topology, int from_loop, int to_loop)
        : faces_(mesh.faces),
          topology_(topology),
          entry_(faces_.size(), -1),
          corner_faces_(faces_.corner_count()),
          loop_of_(mesh.vertex_count(), 0) {
        for (const int v : topology.boundary_loops[from_loop]) loop_of_[v] = 1;
        for (const int v : topology.boundary_loops[to_loop]) loop_of_[v] = 2;
        for (int f = 0; f < faces_.size(); ++f)
            for (int c = faces_.first_corner(f); c < end_of(f); ++c) {
                corner_faces_[c] = f;
                if (entry_[f] < 0 && lies_on(c, 1)) {
                    entry_[f] = c;
                    queue_.push_back(f);
                }
            }
    }

    /// The corner whose edge leaves the strip through the other loop; the way back is that of entry().
    int last() {
        for (std::size_t i = 0; i < queue_.size(); ++i) {
            const int f = queue_[i];
            for (int c = faces_.first_corner(f); c < end_of(f); ++c) {
                if (c == entry_[f]) continue;
                if (lies_on(c, 2)) return c;
                const int g = across(c);
                if (g >= 0 && entry_[g] < 0) {
                    entry_[g] = corner_of(g, topology_.corner_edges[c]);
                    queue_.push_back(g);
                }
            }
        }
        return -1;
    }

    int face_of(int corner) const { return corner_faces_[corner]; }
    int entry(int face) const { return entry_[face]; }
    /// The same edge in the face beyond it, −1 beyond the boundary.
    int opposite(int corner) const {
        const int g = across(corner);
        return g < 0 ? -1 : corner_of(g, topology_.corner_edges[corner]);
    }

  private:
    int end_of(int face) const { return faces_.first_corner(face) + faces_.degree(face); }
    int across(int corner) const {
        const auto& sides = topology_.edge_faces[topology_.corner_edges[corner]];
        return sides[0] == corner_faces_[corner] ? sides[1] : sides[0];
    }
    int corner_of(int face, int edge) const {
        int c = faces_.first_corner(face);
        while (topology_.corner_edges[c] != edge) ++c;
        return c;
    }
    bool lies_on(int corner, int which) const {
        const auto& sides = topology_.edge_faces[topology_.corner_edges[corner]];
        return (sides[0] < 0 || sides[1] < 0) && loop_of_[faces_.vertices()[corner]] == which;
    }

    const FaceList& faces_;
    const Topology& topology_;
    std::vector<int> entry_;  // #F, the corner whose edge the search came in by
    std::vector<int> corner_faces_, loop_of_, queue_;
};

}  // namespace

std::vector<double> jumps_across_strip(const Mesh& mesh, const Topology& topology, int from_loop, int to_loop) {
    StripSearch search(mesh, topology, from_loop, to_loop);
    // Back along the strip: in each face, corners after the entry edge and up to the exit edge are 1 higher.
    std::vector<double> jumps(mesh.faces.corner_count(), 0.0);
    for (int exit = search.last(); exit >= 0;) {
        const int f = search.face_of(exit), first = mesh.faces.first_corner(f), degree = mesh.faces.degree(f),
                  entry = search.entry(f);
        for (int c = entry; c != exit;) {
            c = first + (c - first + 1) % degree;
            jumps[c] = 1;
        }
        exit = search.opposite(entry);
    }
    return jumps;
}

}  // namespace beltrami
