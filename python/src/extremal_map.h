#pragma once

#include <beltrami/teichmuller/extremal_map.h>

#include "constraints.h"
#include "planar_map.h"

namespace beltrami::python {

/// An extremal map with the surface it is of.
class ExtremalObject final : public PlanarMap {
  public:
    /// @param seconds that it took
    ExtremalObject(const SurfacePtr& source, ExtremalMap result, double seconds);

    const Eigen::VectorXcd& map() const override { return result_.map; }
    const Distortion& distortion() const override { return result_.distortion; }
    const Warnings& warnings() const override { return result_.warnings; }
    std::string method() const override { return "extremal"; }
    Record record() const override;
    std::vector<PageMap> other_pages() const override;
    std::optional<PageDifferential> differential() const override;
    std::vector<Iteration> history() const override { return result_.history; }
    std::string summary() const override;
    const ExtremalMap& result() const { return result_; }
    double seconds() const { return seconds_; }

  private:
    ExtremalMap result_;
    double seconds_;
};
using ExtremalPtr = std::shared_ptr<ExtremalObject>;

/// The fields of ExtremalOptions by their names.
/// @param sources surfaces whose charts are asked for
void take_extremal(Keywords& keywords, Interruption& interruption, std::vector<const SurfaceObject*> surfaces,
                   ExtremalOptions& options);
extern const char* const kExtremalOptions;

/// Seconds since some fixed moment.
double seconds();

py::list warnings_list(const Warnings& warnings);

}  // namespace beltrami::python
