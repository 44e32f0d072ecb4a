#pragma once

#include <memory>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami BELTRAMI_PUBLIC {

class SphereLocator;

/// A one-to-one map between two closed surfaces of genus 0 and its inverse, at any points: both surfaces lie on the
/// sphere, where their geodesic triangles are overlaid.
///
///     const SurfaceCorrespondence f(source.mesh, target.mesh, target_sphere.positions, registration.places);
///     f.forward(f.back(place));   // place
class SurfaceCorrespondence {
  public:
    /// @param target_sphere #V×3 of the target: its map to the unit sphere, without flipped faces
    /// @param places        #V of the source, on the target's faces
    /// @throw Error bad_option if sizes differ; bad_mesh naming faces that the map flips
    SurfaceCorrespondence(const Mesh& source, const Mesh& target, const Positions& target_sphere,
                          std::span<const MeshPoint> places);
    ~SurfaceCorrespondence();
    SurfaceCorrespondence(SurfaceCorrespondence&&) noexcept;
    SurfaceCorrespondence& operator=(SurfaceCorrespondence&&) noexcept;

    /// Places of the source on the target, on all threads.
    std::vector<MeshPoint> forward(std::span<const MeshPoint> places) const;
    /// Places of the target on the source.
    std::vector<MeshPoint> back(std::span<const MeshPoint> places) const;

    const SphereLocator& on_source() const { return *on_source_; }
    const SphereLocator& on_target() const { return *on_target_; }
    const Mesh& source() const { return source_; }
    const Mesh& target() const { return target_; }

  private:
    Mesh source_, target_;
    Positions source_sphere_, target_sphere_;
    std::unique_ptr<SphereLocator> on_source_, on_target_;
};

/// From the source to the target, or back.
enum class TransferWay { to_target, to_source };

/// Values of the vertices of one surface (#V×any) at those of the other: linear on the first one's triangles.
/// @throw Error bad_option if there are not #V of them
Positions transferred_vertex_values(const SurfaceCorrespondence& map, const Positions& values,
                                    TransferWay way = TransferWay::to_target);

/// Values of the faces of one surface (#F×any) as means over the other's faces, exactly (overlay.h): the sum of values
/// times areas of the parts that faces cover is the same.
/// @throw Error bad_option if there are not #F of them
Positions transferred_face_values(const SurfaceCorrespondence& map, const Positions& values,
                                  TransferWay way = TransferWay::to_target);

/// The texture coordinates of one surface on the other, a point for each corner, which looks a little inwards: seams
/// may cross faces, whose corners then lie on both sides.
/// @throw Error bad_mesh if the surface has none, or not at every corner
TextureCoordinates transferred_texture(const SurfaceCorrespondence& map, TransferWay way = TransferWay::to_target);

/// The place of every vertex of a mesh that has a face; face −1 for others.
std::vector<MeshPoint> places_of_vertices(const Mesh& mesh);

}  // namespace beltrami
