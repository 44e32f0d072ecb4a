#pragma once

#include <array>
#include <vector>

#include <beltrami/mesh/mesh.h>
#include <beltrami/targets/target.h>

namespace beltrami {

/// Where a mesh and its image on a target are farther apart than allowed, both ways: the mesh (its vertices, the
/// middles of its edges and triangles) from the image, and the image (the same middles) from the target. What was near
/// a triangle when it was last asked is looked for there first, so that asking again takes little. Quads are cut as
/// their shape asks for, those of the image anew each time.
class SurfaceGap {
  public:
    /// @param start  kept by reference, as the target is
    SurfaceGap(const Mesh& start, const Target& target);

    /// @param image #V×3
    /// @return vertices next to which something is farther away than @p distance, ascending
    std::vector<int> strayed(const Positions& image, double distance);

  private:
    using Triangles = std::vector<std::array<int, 3>>;
    /// The middle of one to three vertices, and the vertices that are to blame.
    struct Sample {
        std::array<int, 3> of{-1, -1, -1};
        std::array<int, 4> around{-1, -1, -1, -1};
    };
    using Samples = std::vector<Sample>;

    static Samples middles_of(const Triangles& triangles);
    static Eigen::Vector3d point_of(const Sample& sample, const Positions& positions);
    void from_start(const Positions& image, const Triangles& triangles, double distance, std::vector<char>& far);
    void from_image(const Positions& image, const Samples& samples, double distance, std::vector<char>& far);

    const FaceList& faces_;
    const Target& target_;
    Positions start_;  // #V×3
    bool only_triangles_ = true;
    Triangles triangles_;
    Samples of_start_, middles_;          // of the start; those of its middles alone
    std::vector<int> near_image_;         // of_start_: the triangle of the image that was nearest
    std::vector<MeshPoint> near_target_;  // of the image's middles: the place that was, if the target is a mesh
};

}  // namespace beltrami
