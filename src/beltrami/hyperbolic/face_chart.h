#pragma once

#include <array>

#include <beltrami/plane/disk_isometry.h>

namespace beltrami {

/// A geodesic triangle in the disk with the mean of its corners at 0.
struct FaceChart {
    std::array<DiskIsometry, 3> frames;  ///< of the corners

    /// @param first from corner 0 to corner 1
    /// @param last  from corner 2 to corner 0
    FaceChart(const DiskIsometry& first, const DiskIsometry& last) : frames{DiskIsometry{}, first, last.inverse()} {
        for (int round = 0; round < 3; ++round) {
            const Complex mean = (place(0) + place(1) + place(2)) / 3.0;
            const double size = std::abs(mean);
            if (size == 0) return;
            const DiskIsometry centring = DiskIsometry::translation(-2 * std::atanh(size) / size * mean);
            for (DiskIsometry& frame : frames) frame = centring * frame;
        }
    }

    Complex place(std::size_t corner) const { return frames[corner].place(); }
    std::array<Complex, 3> places() const { return {place(0), place(1), place(2)}; }
};

}  // namespace beltrami
