#pragma once

#include <array>
#include <variant>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/plane/segment_tree.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Lines in two perpendicular directions. Columns run along the first direction, rows along the second.
struct RectangularGrid {
    double spacing = 0.1;   ///< of the first direction, in the units of the plane
    double spacing_up = 0;  ///< of the second; 0 = spacing
    Complex origin = 0;     ///< a point where lines cross
    double angle = 0;       ///< radians from the real axis to the first direction
};

/// Circles of equal distance around a centre, and rays. Columns count the rays, rows the circles from the centre, where
/// the cells are triangles.
struct PolarGrid {
    Complex centre = 0;
    double spacing = 0.1;  ///< of the circles
    int sectors = 32;      ///< at least 3
    double angle = 0;      ///< radians, of ray 0
};

/// Circles whose radii grow by one factor, and rays: conformally a square grid. Columns count the rays, rows the
/// circles from inner_radius.
struct LogPolarGrid {
    Complex centre = 0;       ///< outside the image of the surface, for instance in a hole
    double inner_radius = 1;  ///< of one of the circles
    double outer_radius = 0;  ///< of another one, larger: the cells become nearly square; 0: exactly square
    int sectors = 32;         ///< at least 3
    double angle = 0;         ///< radians, of ray 0
};

using PlaneGrid = std::variant<RectangularGrid, PolarGrid, LogPolarGrid>;

/// @throw Error bad_option if a value is impossible
void validate(const PlaneGrid& grid);

/// The places (column, row) of a grid in a part of the plane.
class Lattice {
  public:
    /// All cells that may meet the inside of a boundary, and one more on every side.
    /// @throw Error bad_option as validate, or for more than ten million cells
    Lattice(const PlaneGrid& grid, const std::vector<Segment>& boundary);

    int vertex_count() const { return columns_ * (rows_ + 1); }
    int cell_count() const { return cell_columns_ * rows_; }
    Complex place(int vertex) const;
    /// False for those that stand for the centre of a polar grid beside the first one.
    bool is_used(int vertex) const { return !has_centre_ || vertex == 0 || vertex >= columns_; }
    /// Corners of a cell counter-clockwise, 4, or 3 at the centre of a polar grid.
    std::vector<int> corners(int cell) const;
    /// Column and row of a cell; negative ones are left of, or below, the origin.
    std::array<int, 2> index(int cell) const {
        return {first_column_ + cell % cell_columns_, first_row_ + cell / cell_columns_};
    }

  private:
    int vertex(int column, int row) const;

    PlaneGrid grid_;
    double factor_ = 0;  ///< of the radii of a log-polar grid
    int first_column_ = 0, first_row_ = 0;
    int columns_ = 0, cell_columns_ = 0, rows_ = 0;
    bool has_centre_ = false;
};

}  // namespace beltrami
