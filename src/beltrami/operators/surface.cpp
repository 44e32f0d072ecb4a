#include <beltrami/operators/surface.h>

namespace beltrami {

Surface::Surface(Mesh m)
    : mesh(std::move(m)),
      findings(require_sound(mesh)),
      topology(beltrami::topology(mesh)),
      operators(beltrami::operators(mesh)),
      planar_metric(is_planar(mesh)) {}

Surface::Surface(Mesh m, Operators metric)
    : mesh(std::move(m)),
      findings(require_sound(mesh)),
      topology(beltrami::topology(mesh)),
      operators(std::move(metric)),
      planar_metric(false) {}

}  // namespace beltrami
