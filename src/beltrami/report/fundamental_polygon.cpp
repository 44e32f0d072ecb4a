#include <beltrami/report/fundamental_polygon.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>

#include <beltrami/plane/klein.h>

namespace beltrami {

namespace {

constexpr double kSame = 1e-7;        // of isometries, and of areas as part of the whole
constexpr double kBeyond = 1e-7;      // by which a corner must be nearer to another image of 0 to be cut off
constexpr double kShrunk = 1e-6;      // half the length of a side that is none
constexpr int kMostRounds = 30;       // of products
constexpr std::size_t kMost = 20000;  // isometries

/// An image of 0 in the hyperboloid: (cosh d, sinh d · direction).
Eigen::Vector3d on_hyperboloid(const DiskIsometry& isometry) {
    const Complex b = 2.0 * isometry.a * isometry.b;
    return {1 + 2 * std::norm(isometry.b), b.real(), b.imag()};
}

/// The polygon in Klein's model, where geodesics are straight: its corners, and the isometry behind each side, −1 of
/// the square that holds the disk.
class KleinPolygon {
  public:
    KleinPolygon() : corners_{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}, sides_(4, -1) {}

    /// Whether the bisector between 0 and the image cuts something off.
    bool is_cut_by(const Eigen::Vector3d& image) const {
        return std::any_of(corners_.begin(), corners_.end(),
                           [&](const Eigen::Vector2d& corner) { return beyond(corner, image) > kBeyond; });
    }
    void cut(const Eigen::Vector3d& image, int side) {
        std::vector<Eigen::Vector2d> corners;
        std::vector<int> sides;
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const std::size_t next = (i + 1) % corners_.size();
            const double here = beyond(corners_[i], image), there = beyond(corners_[next], image);
            if (here <= 0) {
                corners.push_back(corners_[i]);
                sides.push_back(sides_[i]);
            }
            if ((here <= 0) == (there <= 0)) continue;
            corners.push_back(corners_[i] + here / (here - there) * (corners_[next] - corners_[i]));
            sides.push_back(here <= 0 ? side : sides_[i]);
        }
        corners_ = std::move(corners);
        sides_ = std::move(sides);
    }
    const std::vector<Eigen::Vector2d>& corners() const { return corners_; }
    const std::vector<int>& sides() const { return sides_; }

  private:
    /// Above 0 where a point is nearer to the image than to 0; about the difference of the distances there.
    static double beyond(const Eigen::Vector2d& point, const Eigen::Vector3d& image) {
        return (point.dot(image.tail<2>()) - (image[0] - 1)) / image[0];
    }

    std::vector<Eigen::Vector2d> corners_;
    std::vector<int> sides_;
};

/// Between two sides, from the normals of their planes in Minkowski's space.
double angle_between(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
    const auto normal = [](const Eigen::Vector3d& image) { return Eigen::Vector3d(image[0] - 1, image[1], image[2]); };
    const auto product = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return a[1] * b[1] + a[2] * b[2] - a[0] * b[0];
    };
    const Eigen::Vector3d m = normal(first), n = normal(second);
    return std::acos(std::clamp(-product(m, n) / std::sqrt(product(m, m) * product(n, n)), -1.0, 1.0));
}

/// The polygon and the isometries that it has been cut by.
struct Search {
    KleinPolygon polygon;
    std::vector<DiskIsometry> isometries;
    std::vector<Eigen::Vector3d> images;

    /// @return whether it cut something off
    bool add(const DiskIsometry& isometry) {
        const Eigen::Vector3d image = on_hyperboloid(isometry);
        if (image[0] < 1 + kSame || !polygon.is_cut_by(image)) return false;
        polygon.cut(image, static_cast<int>(images.size()));
        isometries.push_back(isometry);
        images.push_back(image);
        return true;
    }
    /// The isometries that have a side.
    std::vector<DiskIsometry> neighbours() const {
        std::vector<DiskIsometry> result;
        for (const int side : polygon.sides())
            if (side >= 0) result.push_back(isometries[static_cast<std::size_t>(side)]);
        return result;
    }
    /// Infinite where a corner is not in the disk.
    double area() const {
        const std::vector<int>& sides = polygon.sides();
        const std::size_t n = sides.size();
        double sum = (static_cast<double>(n) - 2) * std::numbers::pi;
        for (std::size_t i = 0; i < n; ++i) {
            if (sides[i] < 0 || !(polygon.corners()[i].squaredNorm() < 1))
                return std::numeric_limits<double>::infinity();
            sum -= angle_between(images[static_cast<std::size_t>(sides[(i + n - 1) % n])],
                                 images[static_cast<std::size_t>(sides[i])]);
        }
        return sum;
    }
};

Complex corner_place(const Eigen::Vector2d& corner) {
    return {corner.x(), corner.y()};
}

/// Without sides that have shrunk to a corner, where more than three copies of the polygon meet.
HyperbolicPolygon in_disk(const Search& search, double area) {
    const std::vector<Eigen::Vector2d>& corners = search.polygon.corners();
    HyperbolicPolygon result;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Complex from = from_klein(corner_place(corners[i])),
                      to = from_klein(corner_place(corners[(i + 1) % corners.size()]));
        if (std::abs((to - from) / (1.0 - std::conj(from) * to)) < kShrunk) continue;
        result.corners.push_back(from);
        result.sides.push_back(search.isometries[static_cast<std::size_t>(search.polygon.sides()[i])]);
    }
    result.area = area;
    return result;
}

}  // namespace

std::vector<Complex> HyperbolicPolygon::points_of_side(std::size_t side, int pieces) const {
    const Complex from = to_klein(corners[side]), to = to_klein(corners[(side + 1) % corners.size()]);
    std::vector<Complex> points{corners[side]};
    for (int i = 1; i < pieces; ++i) points.push_back(from_klein(from + static_cast<double>(i) / pieces * (to - from)));
    points.push_back(corners[(side + 1) % corners.size()]);
    return points;
}

HyperbolicPolygon dirichlet_polygon(const std::vector<DiskIsometry>& generators, double area) {
    Search search;
    std::vector<DiskIsometry> letters;
    for (const DiskIsometry& generator : generators)
        for (const DiskIsometry& letter : {generator, generator.inverse()}) letters.push_back(letter);
    for (const DiskIsometry& letter : letters) search.add(letter);
    // Neighbours of neighbours, until the area says that all sides are there.
    std::vector<DiskIsometry> words = letters;
    for (int round = 0; round < kMostRounds && words.size() < kMost; ++round) {
        const double reached = search.area();
        if (std::abs(reached - area) < kSame * area) return in_disk(search, reached);
        std::vector<DiskIsometry> nearer = search.neighbours();
        bool changed = false;
        for (const DiskIsometry& a : nearer)
            for (const std::vector<DiskIsometry>* others : {&nearer, &letters})
                for (const DiskIsometry& b : *others) {
                    const DiskIsometry product = (a * b).normalized();
                    for (const DiskIsometry& word : {product, product.inverse()}) changed = search.add(word) || changed;
                }
        if (changed) continue;
        // No such product is a side: longer words.
        std::vector<DiskIsometry> longer;
        for (const DiskIsometry& word : words)
            for (const DiskIsometry& letter : letters) longer.push_back((word * letter).normalized());
        for (const DiskIsometry& word : longer)
            for (const DiskIsometry& either : {word, word.inverse()}) search.add(either);
        words = std::move(longer);
    }
    return {};
}

}  // namespace beltrami
