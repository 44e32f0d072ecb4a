#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/iteration_options.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// A map of a surface onto a mesh with the same faces.
struct HeldMap {
    Positions positions;                  ///< #V×3 on the mesh
    std::optional<ExtremalMap> extremal;  ///< to the plane, or to the mesh's circle domain; see HeldMaps::extremal
    int steps = 0, factorizations = 0;
    bool settled = false;
    Warnings warnings;
};

/// Maps of a surface onto other positions of its own vertices, where its whole boundary and some vertices inside are
/// held at theirs: the problems of a surface of genus 0 whose quadratic differentials are known. A mesh in a plane
/// z = const is taken as it is, folded or not, since only the places of the vertices that are held count; one in space
/// by its circle domain, so that it must not fold. The chart of the source is kept from call to call, and the last
/// extremal map is where the next one begins.
class HeldMaps {
  public:
    /// @param source kept by reference
    /// @param held   different vertices
    HeldMaps(const Surface& source, std::vector<int> held);
    ~HeldMaps();

    /// Why there are no such maps, as "the surface has genus 1"; empty if there are.
    const std::string& refusal() const { return refusal_; }

    /// The extremal map (extremal_map.h) with its bounds, which are estimates where the mesh lies in space.
    /// @throw Error as extremal_map_between
    HeldMap extremal(const Mesh& image, const Progress& progress);
    /// The QC iteration (qc_iteration_baseline). Folds are not excluded.
    /// @throw Error as it does
    HeldMap uniform(const Mesh& image, int max_iterations, const Progress& progress);

  private:
    struct Plane;
    Plane plane_of(const Mesh& image) const;
    Positions positions_of(const Mesh& image, const Plane& plane, const Eigen::VectorXcd& map);

    const Surface& source_;
    std::vector<int> held_;
    std::string refusal_;
    std::unique_ptr<Shape> shape_;
    struct Last;
    std::unique_ptr<Last> last_;  // what a further extremal map begins with
};

}  // namespace beltrami
