#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A picture of rows from top to bottom, four numbers a pixel: red, green, blue and opacity, 0 to 255, in sRGB.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  ///< width · height · 4

    const std::uint8_t* at(int column, int row) const {
        return rgba.data() +
               4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column));
    }
};

/// A rectangle of the plane with its sides along the axes.
struct Box {
    Complex low, high;
};

struct PictureOptions {
    Box place;        ///< where the picture lies on the source's plane
    int width = 800;  ///< of the result, pixels; its height follows
    /// The inverse map between the vertices: smooth, by a polynomial of degree 2 fitted around every vertex inside,
    /// which neither bends at edges nor follows what single vertices do; or linear on the triangles.
    bool smooth = true;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// A picture that lies on a surface in the plane, deformed with it: every pixel of the result is the mean over its area
/// of what the picture has at its preimages, outside the image nothing. Colours are averaged as light.
/// @param source in the plane, with holes or without
/// @param map    #V images in the plane; where it folds the first face that covers a pixel counts
/// @throw Error bad_mesh unless the source lies in a plane z = const; bad_option
Picture deformed_picture(const Picture& picture, const Surface& source, const Eigen::VectorXcd& map,
                         const PictureOptions& options);

}  // namespace beltrami
