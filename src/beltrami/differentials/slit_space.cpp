#include <beltrami/differentials/slit_space.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <beltrami/base/constants.h>
#include <beltrami/differentials/orthonormal_columns.h>
#include <beltrami/differentials/pulled_back.h>
#include <beltrami/plane/circle_fit.h>

namespace beltrami {

namespace {

/// A function of which less than this part is new is left out.
constexpr double kDependentSlit = 1e-7;
/// Least power of J, and the largest of those that a simple pole or less at ∞ needs: of the first slit these cancel the
/// tails of all others.
constexpr int kLeastPower = -1, kLargestTail = 1;
constexpr int kAbsorbers = 3;
constexpr int kPointsOfCircle = 12;

bool changes(const MixedDomain::Loop& loop) {
    return !loop.transitions.empty();
}

}  // namespace

bool SlitSpace::describes(const MixedDomain& domain) {
    const MixedDomain::Loop& outer = domain.loops[0];
    return changes(outer) &&
           std::all_of(outer.parts.begin(), outer.parts.end(),
                       [](const MixedDomain::Part& part) { return part.radius > 0; }) &&
           std::all_of(domain.loops.begin() + 1, domain.loops.end(),
                       [](const MixedDomain::Loop& hole) { return !changes(hole) && hole.prescribed(); });
}

Complex SlitSpace::Family::coordinate(Complex w) const {
    const Complex x = (kI * (infinity + w) / (infinity - w) - shift) / scale;
    return {x.real(), std::max(x.imag(), 0.0)};  // on the upper side of the slits
}

Complex SlitSpace::Family::derivative(Complex w) const {
    return 2.0 * kI * infinity / ((infinity - w) * (infinity - w)) / scale;
}

std::shared_ptr<const SlitSpace::Family> SlitSpace::family(const MixedDomain& domain, int largest_degree,
                                                           const std::vector<int>& largest_powers) {
    Family result;
    result.largest_degree = largest_degree;
    const std::vector<MixedDomain::Part>& parts = domain.loops[0].parts;
    double longest = 0;
    for (const MixedDomain::Part& part : parts) {
        if (!part.slides || part.to - part.from <= longest) continue;
        longest = part.to - part.from;
        result.infinity = std::polar(1.0, 0.5 * (part.from + part.to));
    }
    for (const MixedDomain::Part& part : parts) {
        if (part.slides) continue;
        const double a = result.coordinate(std::polar(1.0, part.from)).real(),
                     b = result.coordinate(std::polar(1.0, part.to)).real();
        result.slits.push_back({0.5 * (a + b), 0.5 * (b - a)});
    }
    const Slit first = result.slits[0];
    result.shift = first.middle;
    result.scale = first.half;
    for (Slit& slit : result.slits) slit = {(slit.middle - first.middle) / first.half, slit.half / first.half};
    for (const MixedDomain::Mark& mark : domain.marks) result.marks.push_back(result.coordinate(mark.at).real());
    for (std::size_t l = 1; l < domain.loops.size(); ++l) {
        const MixedDomain::Loop& hole = domain.loops[l];
        std::vector<Complex> rim;
        rim.reserve(kPointsOfCircle);
        for (int i = 0; i < kPointsOfCircle; ++i)
            rim.push_back(
                result.coordinate(hole.centre + std::polar(hole.radius, 2 * std::numbers::pi * i / kPointsOfCircle)));
        const CircleFit circle = fit_circle(rim);
        result.places.push_back({circle.centre, circle.radius, largest_powers[l - 1], {1, kI}});
    }
    const auto add_pole = [&](Complex at, std::vector<Complex> coefficients) {
        const Complex x = result.coordinate(at);
        result.places.push_back({x, x.imag(), 1, std::move(coefficients)});
    };
    for (const Complex pin : domain.pins) add_pole(pin, {1, kI});
    for (const auto& point : domain.held) {
        const Complex residue = point.residue / result.derivative(point.at);
        add_pole(point.at, {residue / std::abs(residue)});
    }
    result.samples = boundary_samples(domain, largest_degree, false);
    return std::make_shared<const Family>(std::move(result));
}

SlitSpace::SlitSpace(const MixedDomain& domain, int degree, int largest_degree, const std::vector<int>& largest_powers)
    : family_(family(domain, std::max(degree, largest_degree), largest_powers)) {
    raise(degree);
}

std::vector<SlitSpace::Function> SlitSpace::functions_up_to(int degree) const {
    using Kind = Function::Kind;
    const auto slits = static_cast<int>(family_->slits.size()), places = static_cast<int>(family_->places.size()),
               marks = static_cast<int>(family_->marks.size());
    const bool first = functions_.empty();
    std::vector<Function> more;
    for (int j = 0; first && j < slits; ++j)
        for (int power = kLeastPower; power <= kLargestTail; ++power) more.push_back({Kind::slit, j, power, 1});
    for (int j = 0; first && j < marks; ++j) more.push_back({Kind::mark, j, 1, 1});
    for (int power = degree_ + 1; power <= degree; ++power)
        for (int j = 0; j < slits; ++j) more.push_back({Kind::slit, j, power, 1});
    for (int j = 0; j < places; ++j) {
        const Place& place = family_->places[j];
        const int to = std::min(std::max(1, degree / 2), place.largest_power);
        for (int power = first ? 1 : std::max(1, degree_ / 2) + 1; power <= to; ++power)
            for (const Complex coefficient : place.coefficients) more.push_back({Kind::place, j, power, coefficient});
    }
    return more;
}

/// Values for dw².
Eigen::MatrixXcd SlitSpace::values(const std::vector<Function>& functions, const Eigen::VectorXcd& points) const {
    const std::vector<Slit>& slits = family_->slits;
    const std::vector<Place>& places = family_->places;
    int largest = 1;
    for (const Function& function : functions) largest = std::max(largest, function.power);
    Eigen::MatrixXcd result(points.size(), static_cast<Eigen::Index>(functions.size()));
    // Of one point, by powers: of slits from the least one on, of places and of their mirror images.
    Eigen::MatrixXcd of_slits(largest - kLeastPower + 1, slits.size()), of_places(largest + 1, places.size()),
        of_images(largest + 1, places.size());
    for (Eigen::Index i = 0; i < points.size(); ++i) {
        const Complex x = family_->coordinate(points[i]);
        const Complex squared = family_->derivative(points[i]) * family_->derivative(points[i]);
        for (std::size_t j = 0; j < slits.size(); ++j) {
            const Complex u = (x - slits[j].middle) / slits[j].half, J = u + std::sqrt(u - 1.0) * std::sqrt(u + 1.0);
            const Complex inverse = 1.0 / J;
            const auto column = static_cast<Eigen::Index>(j);
            of_slits(0, column) = J / ((u - 1.0) * (u + 1.0));
            for (Eigen::Index p = 1; p < of_slits.rows(); ++p) of_slits(p, column) = of_slits(p - 1, column) * inverse;
        }
        for (std::size_t j = 0; j < places.size(); ++j) {
            const Place& place = places[j];
            const auto column = static_cast<Eigen::Index>(j);
            const Complex base = place.radius / (x - place.centre),
                          image = place.radius / (x - std::conj(place.centre));
            of_places(0, column) = of_images(0, column) = 1;
            for (Eigen::Index p = 1; p <= largest; ++p) {
                of_places(p, column) = of_places(p - 1, column) * base;
                of_images(p, column) = of_images(p - 1, column) * image;
            }
        }
        for (std::size_t f = 0; f < functions.size(); ++f) {
            const auto& [kind, j, power, coefficient] = functions[f];
            Complex value = 0;
            if (kind == Function::Kind::slit) value = of_slits(power - kLeastPower, j);
            if (kind == Function::Kind::mark) value = 1.0 / (x - family_->marks[j]);
            if (kind == Function::Kind::place)
                value = coefficient * of_places(power, j) + std::conj(coefficient) * of_images(power, j);
            result(i, static_cast<Eigen::Index>(f)) = squared * value;
        }
    }
    return result;
}

/// The coefficients of 1/x, 1/x² and 1/x³ at ∞.
Eigen::Vector3d SlitSpace::tail(const Function& function) const {
    // Of (scale/(x − centre))^power.
    const auto of_power = [](double scale, Complex centre, int power) {
        const Complex c = centre / scale;
        Eigen::Vector3cd result = Eigen::Vector3cd::Zero();
        if (power == 1) result << 1.0, c, c * c;
        if (power == 2) result << 0.0, 1.0, 2.0 * c;
        if (power == 3) result << 0.0, 0.0, 1.0;
        return Eigen::Vector3cd(result.array() * Eigen::Array3d(scale, scale * scale, scale * scale * scale));
    };
    switch (function.kind) {
        case Function::Kind::mark:
            return of_power(1, family_->marks[function.index], 1).real();
        case Function::Kind::place: {
            const Place& place = family_->places[function.index];
            return 2 * (function.coefficient * of_power(place.radius, place.centre, function.power)).real();
        }
        case Function::Kind::slit: {
            // J = 2u − 1/(2u) − …, 1/(u² − 1) = 1/u² + 1/u⁴ + …
            const Slit& slit = family_->slits[function.index];
            const auto power = [&](int p) { return Eigen::Vector3d(of_power(slit.half, slit.middle, p).real()); };
            if (function.power == -1) return 2 * power(1) + 1.5 * power(3);
            if (function.power == 0) return power(2);
            if (function.power == 1) return 0.5 * power(3);
            break;
        }
    }
    return Eigen::Vector3d::Zero();
}

/// Appends what functions up to a degree add to the space.
void SlitSpace::raise(int degree) {
    const BoundarySamples& samples = family_->samples;
    const std::vector<Function> more = functions_up_to(degree);
    std::vector<Function> with_absorbers = more;
    const bool first = functions_.empty();
    if (!first) with_absorbers.insert(with_absorbers.begin(), functions_.begin(), functions_.begin() + kAbsorbers);
    const Eigen::MatrixXcd given =
        samples.root_weights.cast<Complex>().asDiagonal() * values(with_absorbers, samples.places);
    const auto before = static_cast<Eigen::Index>(functions_.size()), old = orthonormal_.cols(), rows = given.rows();
    functions_.insert(functions_.end(), more.begin(), more.end());
    const auto all = static_cast<Eigen::Index>(functions_.size()), added = static_cast<Eigen::Index>(more.size());
    Eigen::MatrixXd Q(2 * rows, old + added), T = Eigen::MatrixXd::Zero(all, old + added);
    if (old > 0) {
        Q.leftCols(old) = orthonormal_;
        T.topLeftCorner(before, old) = coefficients_.real();
    }
    Eigen::Index size = old;
    for (Eigen::Index j = first ? kAbsorbers : 0; j < added; ++j) {
        // Less what of the absorbers has the same tail; theirs are (2, 0, 1.5), (0, 1, 0) and (0, 0, .5).
        const Eigen::Vector3d its = tail(more[static_cast<std::size_t>(j)]);
        const Eigen::Vector3d absorbed(its[0] / 2, its[1], 2 * (its[2] - 0.75 * its[0]));
        const Eigen::VectorXcd value =
            given.col(first ? j : j + kAbsorbers) - given.leftCols(kAbsorbers) * absorbed.cast<Complex>();
        Eigen::VectorXd v(2 * rows), in_functions = Eigen::VectorXd::Zero(all);
        v << value.real(), value.imag();
        in_functions[before + j] = 1;
        in_functions.head(kAbsorbers) -= absorbed;
        const double length = v.norm();
        v /= length;
        in_functions /= length;
        detail::append_orthonormal(std::move(v), std::move(in_functions), kDependentSlit, Q, T, size);
    }
    orthonormal_ = Q.leftCols(size);
    coefficients_ = T.leftCols(size).cast<Complex>();
    degree_ = degree;
}

Eigen::MatrixXcd SlitSpace::generators(const ChartPoints& points) const {
    return pulled_back(points, static_cast<Eigen::Index>(functions_.size()),
                       [&](const Eigen::VectorXcd& places) { return values(functions_, places); });
}

std::unique_ptr<DifferentialSpace> SlitSpace::refined() const {
    if (degree_ >= family_->largest_degree) return nullptr;
    std::unique_ptr<SlitSpace> larger(new SlitSpace(*this));
    larger->raise(std::min(degree_ + std::max(4, degree_ / 2), family_->largest_degree));
    if (larger->size() <= size()) return nullptr;
    return larger;
}

}  // namespace beltrami
