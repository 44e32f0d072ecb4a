#pragma once

#include <optional>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/locate/surface_locator.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A map of a mesh to the plane, known at its vertices or face corners, and its inverse at any points: both linear on
/// triangles. A quad is two triangles, along the diagonal that lies inside its image (of two the one from its first
/// corner), so that the map and its inverse belong together.
///
///     const MapEvaluation f(surface.mesh, result.map);
///     const std::optional<MeshPoint> z = f.preimage(w);   // f.image(*z) is w
class MapEvaluation {
  public:
    /// @param map #V images of the vertices
    /// @throw Error bad_mesh if there is no face; bad_option if the map has another size or is not finite
    MapEvaluation(const Mesh& source, const Eigen::VectorXcd& map);
    /// A map with seams.
    /// @param corner_images #corners×2, such as texture_corners(source)
    /// @throw Error as above
    static MapEvaluation of_corners(const Mesh& source, const Positions& corner_images);

    /// Where a place of the source goes: the mean of the images of its vertices, which are corners of its face, with
    /// its barycentric coordinates.
    Complex image(const MeshPoint& place) const;
    /// A place of the source that goes to a point. Of several (on an edge, or where the image overlaps itself) the one
    /// on the first face; nothing outside the image.
    /// @param tolerance how far outside the image, as part of its diameter, a point may lie to be taken for the nearest
    ///                  point of its boundary
    std::optional<MeshPoint> preimage(Complex point, double tolerance = kTolerance) const;
    /// The same of many points, on all threads.
    /// @throw Error bad_boundary naming the points that lie outside
    std::vector<MeshPoint> preimages(std::span<const Complex> points, double tolerance = kTolerance) const;

    /// The place of the source that is nearest to a point of space, and its distance.
    struct Nearest {
        MeshPoint place;
        double distance;
    };
    Nearest nearest(const Eigen::Vector3d& point) const;

    static constexpr double kTolerance = 1e-9;

  private:
    explicit MapEvaluation(const Mesh& source) : source_(source) {}
    void take(const Positions& corner_images);
    void number_images(const Positions& corner_images);
    void divide();
    MeshPoint place(int triangle, const std::array<double, 3>& barycentric) const;

    Mesh source_;
    std::vector<int> image_of_corner_;           ///< #corners
    std::vector<Complex> images_;                ///< several of a vertex on a seam
    std::vector<int> face_of_triangle_;          ///< #triangles
    std::vector<std::array<int, 3>> triangles_;  ///< vertices of the source
    std::optional<PlanarLocator> in_image_;
    std::optional<SurfaceLocator> on_source_;
};

}  // namespace beltrami
