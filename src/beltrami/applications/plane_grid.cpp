#include <beltrami/applications/plane_grid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>

namespace beltrami {

namespace {

bool finite(Complex z) {
    return std::isfinite(z.real()) && std::isfinite(z.imag());
}

void require(bool good, const std::string& what, const std::string& wanted) {
    if (!good) throw Error(Cause::bad_option, what, wanted);
}

struct Validator {
    void operator()(const RectangularGrid& grid) const {
        require(
            grid.spacing > 0 && std::isfinite(grid.spacing) && grid.spacing_up >= 0 && std::isfinite(grid.spacing_up),
            "the spacing of the grid is not positive", "give positive lengths");
        require(finite(grid.origin) && std::isfinite(grid.angle), "the origin or angle of the grid is not finite",
                "give finite numbers");
    }
    void operator()(const PolarGrid& grid) const {
        require(grid.spacing > 0 && std::isfinite(grid.spacing), "the spacing of the grid is not positive",
                "give a positive length");
        round(grid.centre, grid.sectors, grid.angle);
    }
    void operator()(const LogPolarGrid& grid) const {
        require(grid.inner_radius > 0 && std::isfinite(grid.inner_radius) && std::isfinite(grid.outer_radius) &&
                    (grid.outer_radius == 0 || grid.outer_radius > grid.inner_radius),
                "the radii of the grid are impossible", "give 0 < inner_radius < outer_radius");
        round(grid.centre, grid.sectors, grid.angle);
    }

  private:
    static void round(Complex centre, int sectors, double angle) {
        require(sectors >= 3, "the grid has " + std::to_string(sectors) + " sectors", "give at least 3");
        require(finite(centre) && std::isfinite(angle), "the centre or angle of the grid is not finite",
                "give finite numbers");
    }
};

/// Fractional column and row of a point; the column only where a grid is not round.
struct Coordinates {
    Complex point;
    double factor;
    std::array<double, 2> operator()(const RectangularGrid& grid) const {
        const Complex z = (point - grid.origin) * std::polar(1.0, -grid.angle);
        return {z.real() / grid.spacing, z.imag() / (grid.spacing_up > 0 ? grid.spacing_up : grid.spacing)};
    }
    std::array<double, 2> operator()(const PolarGrid& grid) const {
        return {0, std::abs(point - grid.centre) / grid.spacing};
    }
    std::array<double, 2> operator()(const LogPolarGrid& grid) const {
        return {0, std::log(std::abs(point - grid.centre) / grid.inner_radius) / std::log(factor)};
    }
};

struct Place {
    int column, row;
    double factor;
    Complex operator()(const RectangularGrid& grid) const {
        const double up = grid.spacing_up > 0 ? grid.spacing_up : grid.spacing;
        return grid.origin + std::polar(1.0, grid.angle) * Complex(column * grid.spacing, row * up);
    }
    Complex operator()(const PolarGrid& grid) const {
        return grid.centre + std::polar(row * grid.spacing, grid.angle + kTurn * column / grid.sectors);
    }
    Complex operator()(const LogPolarGrid& grid) const {
        return grid.centre +
               std::polar(grid.inner_radius * std::pow(factor, row), grid.angle + kTurn * column / grid.sectors);
    }
};

Complex nearest_point(const Segment& segment, Complex p) {
    const Complex along = segment.b - segment.a;
    if (along == 0.0) return segment.a;
    return segment.a + std::clamp(std::real(std::conj(along) * (p - segment.a)) / std::norm(along), 0.0, 1.0) * along;
}

double radius_factor(const LogPolarGrid& grid) {
    if (grid.outer_radius == 0) return std::exp(kTurn / grid.sectors);
    const double whole = std::log(grid.outer_radius / grid.inner_radius);
    return std::exp(whole / std::max(1.0, std::round(whole * grid.sectors / kTurn)));
}

}  // namespace

void validate(const PlaneGrid& grid) {
    std::visit(Validator{}, grid);
}

Lattice::Lattice(const PlaneGrid& grid, const std::vector<Segment>& boundary) : grid_(grid) {
    validate(grid);
    const auto* log_polar = std::get_if<LogPolarGrid>(&grid);
    const auto* polar = std::get_if<PolarGrid>(&grid);
    if (log_polar) factor_ = radius_factor(*log_polar);
    double low[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    double high[2] = {-low[0], -low[1]};
    const auto include = [&](Complex p) {
        const std::array<double, 2> at = std::visit(Coordinates{p, factor_}, grid);
        for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    };
    for (const Segment& segment : boundary) {
        include(segment.a);
        if (log_polar) include(nearest_point(segment, log_polar->centre));
    }
    if (polar) low[1] = 0;
    const int sectors = log_polar ? log_polar->sectors : polar ? polar->sectors : 0;
    const double across = sectors > 0 ? sectors : high[0] - low[0] + 3, up = high[1] - low[1] + 3;
    constexpr double kMost = 1e7;
    if (!(across * up <= kMost && std::max({-low[0], high[0], -low[1], high[1]}) < 1e9))
        throw Error(Cause::bad_option, "the grid has more than ten million cells",
                    "give a larger spacing, or an origin near the image");
    first_row_ = static_cast<int>(std::floor(low[1])) - 1;
    rows_ = static_cast<int>(std::ceil(high[1])) + 1 - first_row_;
    if (polar) {
        rows_ += first_row_;
        first_row_ = 0;
        has_centre_ = true;
    }
    if (sectors > 0) {
        columns_ = cell_columns_ = sectors;
    } else {
        first_column_ = static_cast<int>(std::floor(low[0])) - 1;
        cell_columns_ = static_cast<int>(std::ceil(high[0])) + 1 - first_column_;
        columns_ = cell_columns_ + 1;
    }
}

int Lattice::vertex(int column, int row) const {
    return has_centre_ && row == 0 ? 0 : row * columns_ + (columns_ == cell_columns_ ? column % columns_ : column);
}

Complex Lattice::place(int vertex) const {
    return std::visit(Place{first_column_ + vertex % columns_, first_row_ + vertex / columns_, factor_}, grid_);
}

std::vector<int> Lattice::corners(int cell) const {
    const int column = cell % cell_columns_, row = cell / cell_columns_;
    std::vector<int> around;
    if (columns_ == cell_columns_) {  // outwards, then around
        around = {vertex(column, row), vertex(column, row + 1), vertex(column + 1, row + 1), vertex(column + 1, row)};
        if (around.front() == around.back()) around.pop_back();
    } else {
        around = {vertex(column, row), vertex(column + 1, row), vertex(column + 1, row + 1), vertex(column, row + 1)};
    }
    return around;
}

}  // namespace beltrami
