#pragma once

#include <beltrami/operators/distortion.h>
#include <beltrami/report/page.h>
#include <beltrami/report/record.h>
#include <beltrami/solve/map_result.h>
#include <beltrami/teichmuller/carried_surface.h>

#include "surface.h"

namespace beltrami::python {

/// A map of a surface into space, along a target or onto another surface: what all such results share.
class SpaceMap {
  public:
    /// @param method "registration", "remeshed" …
    /// @param positions #V×3, or #V×2 onto a surface of the plane
    SpaceMap(SurfacePtr source, std::string method, Positions positions, Distortion distortion, Record record)
        : source_(std::move(source)),
          method_(std::move(method)),
          positions_(std::move(positions)),
          distortion_(std::move(distortion)),
          record_(std::move(record)) {}
    virtual ~SpaceMap() = default;

    const SurfacePtr& source() const { return source_; }
    const std::string& method() const { return method_; }
    const Positions& positions() const { return positions_; }
    const Distortion& distortion() const { return distortion_; }
    /// As docs/json.md describes it, with the warnings.
    const Record& record() const { return record_; }
    std::string summary() const;
    /// The page of the map.
    std::string page(const std::string& title) const;

  private:
    SurfacePtr source_;
    std::string method_;
    Positions positions_;
    Distortion distortion_;
    Record record_;
};

/// A surface on the faces of another one.
class CarriedObject : public SpaceMap {
  public:
    CarriedObject(SurfacePtr source, std::string method, const CarriedSurface& carried, Distortion distortion,
                  Record record)
        : SpaceMap(std::move(source), std::move(method), carried.positions, std::move(distortion), std::move(record)),
          places_{carried.places},
          in_space_(carried.in_space),
          unresolved_(carried.unresolved),
          largest_distance_(carried.largest_distance) {}
    const Places& places() const { return places_; }
    const Distortion& in_space() const { return in_space_; }
    const std::vector<int>& unresolved() const { return unresolved_; }
    const std::optional<double>& largest_distance() const { return largest_distance_; }

  private:
    Places places_;
    Distortion in_space_;
    std::vector<int> unresolved_;
    std::optional<double> largest_distance_;
};

/// A record of a command with what was read, the numbers of a map and its warnings.
Record space_record(const SurfacePtr& source, const std::string& command, MapRecord map, Warnings warnings);
/// How it was found, by direct solves.
SolveRecord solve_of(int iterations, int factorizations, Termination termination, double seconds);

}  // namespace beltrami::python
