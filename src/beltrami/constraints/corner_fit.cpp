#include <beltrami/constraints/corner_fit.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include <beltrami/base/constants.h>

namespace beltrami::detail {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Points of one curve on one side of a vertex, nearest along the curve first.
struct Side {
    int count = 0;
    std::array<double, kWindow> radius, angle;  ///< chords from the vertex; angles continuous along the curve

    void add(Complex chord, Complex previous, double first_angle) {
        radius[count] = std::abs(chord);
        angle[count] = count == 0 ? first_angle : angle[count - 1] + std::arg(chord / previous);
        ++count;
    }
};

/// y ≈ value + slope x with weights x², as befits directions and logarithms of chords whose ends are displaced.
struct LineFit {
    double value = 0;
    double variance = 0;   ///< of value, for independent displacements of size 1
    double of_vertex = 0;  ///< change of value for a displacement of the vertex itself by 1
    double squares = 0;    ///< sum of the squared displacements that are left
    int freedom = 0;       ///< points minus parameters
    bool slope = false;
};

LineFit fit_line(const double* x, const double* y, int count) {
    LineFit fit;
    double s2 = 0, s3 = 0, s4 = 0, t2 = 0, t3 = 0, s1 = 0, scale = 0;
    for (int i = 0; i < count; ++i) scale = std::max(scale, x[i]);
    if (!(scale > 0)) return fit;
    for (int i = 0; i < count; ++i) {
        const double r = x[i] / scale;
        s1 += r, s2 += r * r, s3 += r * r * r, s4 += r * r * r * r;
        t2 += r * r * y[i], t3 += r * r * r * y[i];
    }
    const double determinant = s2 * s4 - s3 * s3;
    fit.slope = count >= 3 && determinant > 1e-6 * s2 * s4;
    double slope = 0;
    if (fit.slope) {
        fit.value = (s4 * t2 - s3 * t3) / determinant;
        slope = (s2 * t3 - s3 * t2) / determinant;
        fit.variance = s4 / determinant / (scale * scale);
        fit.of_vertex = (s4 * s1 - s3 * s2) / determinant / scale;
    } else {
        fit.value = t2 / s2;
        fit.variance = 1 / s2 / (scale * scale);
        fit.of_vertex = s1 / s2 / scale;
    }
    fit.freedom = count - (fit.slope ? 2 : 1);
    for (int i = 0; i < count; ++i) {
        const double left = x[i] * (y[i] - fit.value - slope * x[i] / scale);
        fit.squares += left * left;
    }
    return fit;
}

double displacement(double squares, int freedom) {
    return freedom > 0 ? std::sqrt(squares / freedom) : 0.0;
}

/// The jump between two sides: its standard deviation for displacements of the given size.
double deviation(const LineFit& out, const LineFit& in, double size) {
    const double of_vertex = out.of_vertex + in.of_vertex;
    return size * std::sqrt(out.variance + in.variance + of_vertex * of_vertex);
}

/// The boundary on both sides of a vertex, ahead first.
struct Sides {
    std::array<Side, 2> source, image;                                 ///< equally many points; no image if not placed
    std::array<std::array<double, kWindow>, 2> log_radius, log_ratio;  ///< of the source; of image to source
    bool placed = false;  ///< the vertex and both neighbours are prescribed

    std::array<int, 2> counts(int scale) const {
        return {std::min(scale, source[0].count), std::min(scale, source[1].count)};
    }
};

Sides follow(const Outline& outline, int position, Reach reach) {
    const int n = outline.size();
    const auto around = [&](int i) { return (position + i + n) % n; };
    Sides sides;
    sides.placed = outline.prescribed[position] && outline.prescribed[around(1)] && outline.prescribed[around(-1)];
    const Complex base = outline.developed[position + outline.reach], image_base = outline.images[position];
    for (int side = 0; side < 2; ++side) {
        Complex previous = 0, image_previous = 0;
        for (int j = 0; j < (side == 0 ? reach.out : reach.in); ++j) {
            const int step = side == 0 ? j + 1 : -j - 1;
            if (sides.placed && !outline.prescribed[around(step)]) break;
            const Complex chord = outline.developed[position + outline.reach + step] - base;
            const Complex image_chord = sides.placed ? outline.images[around(step)] - image_base : Complex(1);
            if (chord == 0.0 || image_chord == 0.0) break;
            sides.source[side].add(chord, previous, side == 0 ? 0.0 : outline.angles[position]);
            previous = chord;
            if (!sides.placed) continue;
            double first = 0;
            if (side == 1 && j == 0) {
                first = std::arg(image_chord / (outline.images[around(1)] - image_base));
                if (first <= 0) first += 2 * kPi;
            }
            sides.image[side].add(image_chord, image_previous, first);
            image_previous = image_chord;
            sides.log_radius[side][j] = std::log(std::abs(chord));
            sides.log_ratio[side][j] = std::log(std::abs(image_chord)) - sides.log_radius[side][j];
        }
    }
    return sides;
}

/// log of image over source distance ≈ log c1 or log c2 + slope r + q log r, the slopes of the sides apart; or, to see
/// whether smooth data explain as much, with q r² instead.
struct PowerFit {
    double out = 0, in = 0, q = 0;
    double deviation_q = 0, deviation_jump = 0;
    double residual = 0;
    bool valid = false;
};

PowerFit fit_power(const Sides& sides, const std::array<int, 2>& count, double noise, bool logarithm) {
    using Vector = Eigen::Matrix<double, 5, 1>;
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
    Vector right = Vector::Zero();
    std::array<Vector, 2> of_vertex{Vector::Zero(), Vector::Zero()};
    const std::array<const double*, 2> x{sides.source[0].radius.data(), sides.source[1].radius.data()};
    double scale = 0;
    for (int side = 0; side < 2; ++side)
        for (int i = 0; i < count[side]; ++i) scale = std::max(scale, x[side][i]);
    const double log_scale = std::log(scale);
    const auto row = [&](int side, int i) {
        const double r = x[side][i] / scale;
        Vector result = Vector::Zero();
        result[side] = 1;
        result[2 + side] = r;
        result[4] = logarithm ? sides.log_radius[side][i] - log_scale : r * r;
        return result;
    };
    for (int side = 0; side < 2; ++side)
        for (int i = 0; i < count[side]; ++i) {
            const double r = x[side][i] / scale;
            const Vector a = row(side, i);
            normal.noalias() += r * r * a * a.transpose();
            right += r * r * sides.log_ratio[side][i] * a;
            of_vertex[side] += r * a / scale;
        }
    PowerFit fit;
    const Eigen::LDLT<Eigen::Matrix<double, 5, 5>> solver(normal);
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 1e-12 * solver.vectorD().maxCoeff()))
        return fit;
    const Vector solution = solver.solve(right);
    const Eigen::Matrix<double, 5, 5> inverse = solver.solve(Eigen::Matrix<double, 5, 5>::Identity());
    double squares = 0;
    for (int side = 0; side < 2; ++side)
        for (int i = 0; i < count[side]; ++i) {
            const double left = x[side][i] * (sides.log_ratio[side][i] - row(side, i).dot(solution));
            squares += left * left;
        }
    fit.valid = true;
    fit.residual = displacement(squares, count[0] + count[1] - 5);
    const double size = std::max(noise, fit.residual);
    const auto deviation_of = [&](const Vector& what) {
        double variance = what.dot(inverse * what) / (scale * scale), common = 0;
        for (const Vector& v : of_vertex) common += std::abs(what.dot(inverse * v));
        return size * std::sqrt(variance + common * common);
    };
    Vector jump = Vector::Zero();
    jump[0] = -1, jump[1] = 1;
    fit.q = solution[4];
    fit.out = solution[0] - fit.q * log_scale;
    fit.in = solution[1] - fit.q * log_scale;
    fit.deviation_q = deviation_of(Vector::Unit(4));
    fit.deviation_jump = deviation_of(jump);
    return fit;
}

WindowFit fit_sides(const Outline& outline, const Sides& sides, int scale, const CornerOptions& options) {
    const std::array<int, 2> count = sides.counts(scale);
    WindowFit result;
    if (count[0] == 0 || count[1] == 0) return result;
    // Without slopes the turning of a smooth curve cannot be told from a corner: that of a circle is allowed for.
    const auto turning = [&](const LineFit& fit, int points) {
        return fit.slope ? 0.0 : kPi * (points + 0.5) / outline.size();
    };
    const auto turn = [&](const std::array<Side, 2>& curve, int channel) {
        const LineFit out = fit_line(curve[0].radius.data(), curve[0].angle.data(), count[0]);
        const LineFit in = fit_line(curve[1].radius.data(), curve[1].angle.data(), count[1]);
        result.residual[channel] = displacement(out.squares + in.squares, out.freedom + in.freedom);
        result.jumps[channel] = {kPi - (in.value - out.value),
                                 deviation(out, in, std::max(outline.noise[channel], result.residual[channel])),
                                 options.min_turn + turning(out, count[0]) + turning(in, count[1]), true};
    };
    turn(sides.source, 0);
    if (!sides.placed) return result;
    turn(sides.image, 1);

    const LineFit out = fit_line(sides.source[0].radius.data(), sides.log_ratio[0].data(), count[0]);
    const LineFit in = fit_line(sides.source[1].radius.data(), sides.log_ratio[1].data(), count[1]);
    result.residual[2] = displacement(out.squares + in.squares, out.freedom + in.freedom);
    result.log_speed = {out.value, in.value};
    result.jumps[2] = {in.value - out.value, deviation(out, in, std::max(outline.noise[2], result.residual[2])),
                       options.min_log_speed, true};
    constexpr int kFewest = 6;  // points a side for a power
    if (count[0] < kFewest || count[1] < kFewest) return result;
    const PowerFit power = fit_power(sides, count, outline.noise[2], true);
    if (!power.valid) return result;
    result.jumps[3] = {power.q, power.deviation_q, options.min_exponent, true};
    // A power has to describe the data clearly better than the square that smooth data begin with.
    constexpr double kBetter = 0.7;
    if (std::abs(power.q) > options.min_exponent + options.confidence * power.deviation_q &&
        power.residual < kBetter * fit_power(sides, count, outline.noise[2], false).residual) {
        result.power = true;
        result.log_speed_of_power = {power.out, power.in};
        result.jumps[2].value = power.in - power.out;
        result.jumps[2].sigma = power.deviation_jump;
    }
    return result;
}

}  // namespace

WindowFit fit_window(const Outline& outline, int position, int scale, const CornerOptions& options) {
    return fit_sides(outline, follow(outline, position, {scale, scale}), scale, options);
}

BoundaryCorner fit_corner(const Outline& outline, int position, Reach reach, const CornerOptions& options) {
    const Sides sides = follow(outline, position, reach);
    std::array<WindowFit, 4> fits;  // 4, 8, 16, 32 edges
    int count = 0;
    for (int scale = std::min(4, outline.reach);; scale *= 2) {
        fits[count++] = fit_sides(outline, sides, scale, options);
        if (2 * scale > outline.reach || scale >= std::max(reach.out, reach.in)) break;
    }
    std::array<double, 4> significance{};
    for (int c = 0; c < 4; ++c) {
        double most = 0, limit = std::numeric_limits<double>::infinity();
        for (int i = 0; i < count; ++i) {
            const Jump& jump = fits[i].jumps[c];
            if (!jump.known) continue;
            const double reached = options.confidence * jump.sigma, size = std::abs(jump.value);
            if (c < 3 || fits[i].power) most = std::max(most, size / (jump.allowed + reached));
            limit = std::min(limit, (size + reached) / jump.allowed);
        }
        significance[c] = std::min(most, limit);
    }
    const bool power = significance[3] > 1;
    // The window in which a sum of deviations is smallest; of equals the largest.
    const auto best = [&](int first, int last, bool with_power) -> const WindowFit& {
        int chosen = -1;
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < count; ++i) {
            if (with_power && !fits[i].power) continue;
            double sum = 0;
            for (int c = first; c < last; ++c) sum += fits[i].jumps[c].sigma;
            if (chosen < 0 || sum <= least) chosen = i, least = sum;
        }
        return fits[chosen];
    };
    BoundaryCorner corner;
    corner.position = position;
    corner.vertex = outline.vertices[position];
    corner.significance = *std::max_element(significance.begin(), significance.end());
    const WindowFit& angles = best(0, 2, false);
    corner.source_angle = kPi - angles.jumps[0].value;
    if (!angles.jumps[1].known) {
        corner.image_angle = corner.speed_out = corner.speed_in = kNaN;
        return corner;
    }
    corner.image_angle = kPi - angles.jumps[1].value;
    const WindowFit& speeds = best(2, 3, power);
    const auto& [log_out, log_in] = power ? speeds.log_speed_of_power : speeds.log_speed;
    corner.speed_out = std::exp(log_out);
    corner.speed_in = std::exp(log_in);
    if (power) corner.exponent = 1 + speeds.jumps[3].value;
    corner.corner_bound = beltrami::corner_bound(corner.source_angle, corner.image_angle, corner.speed_out,
                                                 corner.speed_in, corner.exponent);
    // Every jump smaller by what noise may have added to it.
    const auto towards = [&](double value, double target, const Jump& jump) {
        const double change = options.confidence * jump.sigma;
        return value + std::clamp(target - value, -change, change);
    };
    const double alpha = towards(corner.source_angle, corner.image_angle, angles.jumps[0]);
    const double beta = towards(corner.image_angle, alpha, angles.jumps[1]);
    const double jump = towards(speeds.jumps[2].value, 0.0, speeds.jumps[2]);
    const double p = power ? towards(corner.exponent, beta / alpha, speeds.jumps[3]) : 1.0;
    corner.safe_bound = beltrami::corner_bound(alpha, beta, 1.0, std::exp(jump), p);
    return corner;
}

std::vector<Outline> outlines(const Surface& source, const BoundaryCondition& boundary) {
    const Mesh& mesh = source.mesh;
    std::vector<double> angle(mesh.vertex_count(), 0.0);
    const auto point = [&](int c) -> Eigen::Vector3d {
        if (!source.metric) return mesh.point(mesh.faces.vertices()[c]);
        return {(*source.metric)(c, 0), (*source.metric)(c, 1),
                source.metric->cols() > 2 ? (*source.metric)(c, 2) : 0.0};
    };
    for (int f = 0; f < mesh.face_count(); ++f)
        for (int first = mesh.faces.first_corner(f), degree = mesh.faces.degree(f), i = 0; i < degree; ++i) {
            const int c = first + i;
            if (!source.topology.on_boundary[mesh.faces.vertices()[c]]) continue;
            const Eigen::Vector3d next = point(first + (i + 1) % degree) - point(c);
            const Eigen::Vector3d previous = point(first + (i + degree - 1) % degree) - point(c);
            angle[mesh.faces.vertices()[c]] += std::atan2(next.cross(previous).norm(), next.dot(previous));
        }
    std::vector<char> prescribed(mesh.vertex_count(), 0);
    for (const int v : boundary.vertices) prescribed[v] = 1;
    const Eigen::VectorXcd image = prescribed_values(boundary, source);

    std::vector<Outline> result;
    for (std::size_t l = 0; l < source.topology.boundary_loops.size(); ++l) {
        Outline& outline = result.emplace_back();
        outline.vertices = source.topology.boundary_loops[l];
        const int n = outline.size();
        outline.reach = std::clamp(n / 8, 1, kWindow);
        for (const int v : outline.vertices) {
            outline.angles.push_back(angle[v]);
            outline.images.push_back(image[v]);
            outline.prescribed.push_back(prescribed[v]);
        }
        double direction = 0;
        Complex at = 0;
        for (int k = 0; k <= n + 2 * outline.reach; ++k) {
            const int i = (k + n - outline.reach) % n;
            outline.developed.push_back(at);
            direction += kPi - outline.angles[i];
            at += std::polar(source.boundary_edge_lengths[l][i], direction);
        }
    }
    return result;
}

}  // namespace beltrami::detail
