#pragma once

#include <mutex>

#include <beltrami/locate/map_evaluation.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/report/page.h>
#include <beltrami/report/record.h>

#include "surface.h"

namespace beltrami::python {

/// A map of a surface to the plane, however it was found: what all results of solvers share.
class PlanarMap {
  public:
    PlanarMap(SurfacePtr source, SurfacePtr mapped) : source_(std::move(source)), surface_(std::move(mapped)) {}
    virtual ~PlanarMap() = default;

    const SurfacePtr& source() const { return source_; }
    /// Whose vertices the map has: the source, or what it became where edges had to be split.
    const SurfacePtr& surface() const { return surface_; }
    virtual const Eigen::VectorXcd& map() const = 0;
    virtual const Distortion& distortion() const = 0;
    virtual const Warnings& warnings() const = 0;
    /// "extremal", "lscm" …
    virtual std::string method() const = 0;
    /// As docs/json.md describes it.
    virtual Record record() const = 0;
    /// Other maps of the page, beside this one.
    virtual std::vector<PageMap> other_pages() const { return {}; }
    /// What the page draws of φ; nothing where there is none.
    virtual std::optional<PageDifferential> differential() const { return {}; }
    virtual std::vector<Iteration> history() const { return {}; }
    virtual std::string summary() const;

    /// The page of the map.
    std::string page(const std::string& title) const;
    const MapEvaluation& evaluation() const;

  private:
    SurfacePtr source_, surface_;
    mutable std::once_flag evaluated_;
    mutable std::optional<MapEvaluation> evaluation_;
};

/// #V×2 for a map.
Positions plane_positions(const Eigen::VectorXcd& map);

/// A record with what was read and the warnings.
Record record_of(const PlanarMap& map, const std::string& command);

}  // namespace beltrami::python
