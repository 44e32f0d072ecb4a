#include <beltrami/applications/deform.h>

#include <beltrami/base/error.h>

namespace beltrami {

const char* to_string(DeformedSurface surface) {
    switch (surface) {
        case DeformedSurface::automatic:
            return "automatic";
        case DeformedSurface::thin_plate:
            return "thin-plate";
        case DeformedSurface::rigid:
            return "rigid";
        case DeformedSurface::uniform:
            return "uniform";
        case DeformedSurface::given:
            return "given";
    }
    return "";
}

const char* to_string(DeformGoal goal) {
    switch (goal) {
        case DeformGoal::dilatation:
            return "K";
        case DeformGoal::largest:
            return "max";
        case DeformGoal::spread:
            return "spread";
    }
    return "";
}

void DeformOptions::validate() const {
    if (!(last_power >= 2 && last_power <= 64)) throw Error(Cause::bad_option, "the power is not between 2 and 64");
    if (steps_of_power < 0) throw Error(Cause::bad_option, "the number of steps is negative");
    if (!(tolerance >= 0)) throw Error(Cause::bad_option, "the tolerance is negative");
}

}  // namespace beltrami
