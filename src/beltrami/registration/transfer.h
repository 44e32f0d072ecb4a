#pragma once

#include <memory>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami BELTRAMI_PUBLIC {

class DrawnSurface;

/// A one-to-one map between two surfaces of genus 0 and its inverse, at any points. Closed surfaces both lie on the
/// sphere, where their geodesic triangles are overlaid; surfaces with boundary both lie in the target's circle domain,
/// and boundary edges of each are bent at the boundary vertices of the other, so that boundaries go to boundaries.
///
///     const SurfaceCorrespondence f(source.mesh, target.mesh, target_sphere.positions, registration.places);
///     f.forward(f.back(place));   // place
class SurfaceCorrespondence {
  public:
    /// Closed surfaces.
    /// @param target_sphere #V×3 of the target: its map to the unit sphere, without flipped faces
    /// @param places        #V of the source, on the target's faces
    /// @throw Error bad_option if sizes differ; bad_mesh naming faces that the map flips
    SurfaceCorrespondence(const Mesh& source, const Mesh& target, const Positions& target_sphere,
                          std::span<const MeshPoint> places);
    /// Surfaces with boundary.
    /// @param circles the target's circle domain, with the outer loop of the registration
    /// @param places  #V of the source, on the target's faces
    /// @throw Error bad_option, bad_mesh as above
    SurfaceCorrespondence(const Surface& source, const Surface& target, const CircleDomainChart& circles,
                          std::span<const MeshPoint> places);
    ~SurfaceCorrespondence();
    SurfaceCorrespondence(SurfaceCorrespondence&&) noexcept;
    SurfaceCorrespondence& operator=(SurfaceCorrespondence&&) noexcept;

    /// Places of the source on the target, on all threads.
    std::vector<MeshPoint> forward(std::span<const MeshPoint> places) const;
    /// Places of the target on the source.
    std::vector<MeshPoint> back(std::span<const MeshPoint> places) const;

    const DrawnSurface& on_source() const { return *on_source_; }
    const DrawnSurface& on_target() const { return *on_target_; }
    /// Vertices of on_target() that are the same points as those of on_source(), −1 for others.
    const std::vector<int>& partners() const { return partners_; }
    const Mesh& source() const { return source_; }
    const Mesh& target() const { return target_; }

  private:
    void require_upright() const;

    Mesh source_, target_;
    std::unique_ptr<DrawnSurface> on_source_, on_target_;
    std::vector<int> partners_;
};

/// From the source to the target, or back.
enum class TransferWay { to_target, to_source };

/// Values of the vertices of one surface (#V×any) at those of the other: linear on the first one's triangles.
/// @throw Error bad_option if there are not #V of them
Positions transferred_vertex_values(const SurfaceCorrespondence& map, const Positions& values,
                                    TransferWay way = TransferWay::to_target);

/// Values of the faces of one surface (#F×any) as means over the other's faces, exactly (overlay.h): the sum of values
/// times areas of the parts that faces cover is the same. A face that none of the others covers has the value at its
/// middle.
/// @throw Error bad_option if there are not #F of them
Positions transferred_face_values(const SurfaceCorrespondence& map, const Positions& values,
                                  TransferWay way = TransferWay::to_target);

/// The texture coordinates of one surface on the other, a point for each corner, which looks a little inwards: seams
/// may cross faces, whose corners then lie on both sides.
/// @throw Error bad_mesh if the surface has none, or not at every corner
TextureCoordinates transferred_texture(const SurfaceCorrespondence& map, TransferWay way = TransferWay::to_target);

/// The texture point at a place of a mesh.
/// @pre the mesh has a texture
/// @throw Error bad_mesh naming a face of which a corner has no texture point
Eigen::RowVector2d texture_at(const Mesh& mesh, const MeshPoint& place);

/// The place of every vertex of a mesh that has a face; face −1 for others.
std::vector<MeshPoint> places_of_vertices(const Mesh& mesh);

}  // namespace beltrami
