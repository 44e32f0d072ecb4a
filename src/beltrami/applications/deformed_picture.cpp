#include <beltrami/applications/deformed_picture.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami {

namespace {

constexpr int kMostPixels = 100'000'000;
constexpr int kLeastSubpixels = 3, kMostSubpixels = 12;  // along a side of a pixel
constexpr double kEnough = 8;  // fitted points for each of a polynomial's two values and gradients

/// Red, green, blue times opacity, as light, and opacity.
using Light = Eigen::Array4d;

double light_of(std::uint8_t value) {
    const double s = value / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

std::uint8_t value_of(double light) {
    const double l = std::clamp(light, 0.0, 1.0), s = l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * s));
}

/// A picture as light, by places of the plane.
class LightField {
  public:
    LightField(const Picture& picture, const Box& place) : picture_(picture), place_(place), lights_(256) {
        for (int i = 0; i < 256; ++i) lights_[static_cast<std::size_t>(i)] = light_of(static_cast<std::uint8_t>(i));
    }

    /// Linear between the middles of pixels; nothing outside the picture.
    Light at(Complex p) const {
        const double x = (p.real() - place_.low.real()) / (place_.high.real() - place_.low.real()),
                     y = (place_.high.imag() - p.imag()) / (place_.high.imag() - place_.low.imag());
        constexpr double kOutside = 1e-9;
        if (!(x >= -kOutside && x <= 1 + kOutside && y >= -kOutside && y <= 1 + kOutside)) return Light::Zero();
        const double column = x * picture_.width - 0.5, row = y * picture_.height - 0.5;
        const int c = static_cast<int>(std::floor(column)), r = static_cast<int>(std::floor(row));
        const double s = column - c, t = row - r;
        return (1 - t) * ((1 - s) * pixel(c, r) + s * pixel(c + 1, r)) +
               t * ((1 - s) * pixel(c, r + 1) + s * pixel(c + 1, r + 1));
    }
    /// Side of a pixel.
    double pixel_size() const {
        return std::min((place_.high.real() - place_.low.real()) / picture_.width,
                        (place_.high.imag() - place_.low.imag()) / picture_.height);
    }

  private:
    Light pixel(int column, int row) const {
        const std::uint8_t* p =
            picture_.at(std::clamp(column, 0, picture_.width - 1), std::clamp(row, 0, picture_.height - 1));
        const double opacity = p[3] / 255.0;
        return {lights_[p[0]] * opacity, lights_[p[1]] * opacity, lights_[p[2]] * opacity, opacity};
    }

    const Picture& picture_;
    const Box& place_;
    std::vector<double> lights_;
};

/// The inverse of a map as a polynomial of first degree around every vertex's image.
class SmoothInverse {
  public:
    SmoothInverse(const Surface& source, const Eigen::VectorXcd& map, const Eigen::VectorXcd& own)
        : map_(map), value_(own), along_(map.size(), 2) {
        std::vector<std::vector<int>> near(static_cast<std::size_t>(map.size()));
        for (const auto& [a, b] : source.topology.edges) {
            near[a].push_back(b);
            near[b].push_back(a);
        }
        parallel_for(
            0, static_cast<int>(map.size()), [&](int first, int last) { fit(source, own, near, first, last); }, 64);
    }

    /// The source's place of a point in a face, whose three vertices and weights are known.
    Complex at(Complex point, const MeshPoint& face) const {
        double sum = 0;
        Complex result = 0;
        for (int i = 0; i < 3; ++i) {
            const int v = face.vertices[i];
            const double b = std::max(face.barycentric[i], 0.0), weight = b * b;
            const Complex away = point - map_[v];
            sum += weight;
            result += weight * (value_[v] + along_(v, 0) * away.real() + along_(v, 1) * away.imag());
        }
        return result / sum;
    }

  private:
    void fit(const Surface& source, const Eigen::VectorXcd& own, const std::vector<std::vector<int>>& near, int first,
             int last) {
        std::vector<int> around;
        for (int v = first; v < last; ++v) {
            around.assign({v});
            for (const int w : near[v]) {
                around.push_back(w);
                around.insert(around.end(), near[w].begin(), near[w].end());
            }
            std::sort(around.begin(), around.end());
            around.erase(std::unique(around.begin(), around.end()), around.end());
            const bool quadratic = static_cast<double>(around.size()) >= kEnough;
            // Vertices of the boundary stay where they are, so that the outline does.
            const bool held = source.topology.on_boundary[v] != 0;
            double size = 0;
            for (const int w : around) size = std::max(size, std::abs(map_[w] - map_[v]));
            if (!(size > 0)) {
                along_.row(v).setZero();
                continue;
            }
            Eigen::MatrixXd rows(static_cast<Eigen::Index>(around.size()), quadratic ? 6 : 3);
            Eigen::MatrixXd wanted(rows.rows(), 2);
            for (Eigen::Index i = 0; i < rows.rows(); ++i) {
                const int w = around[static_cast<std::size_t>(i)];
                const Complex d = (map_[w] - map_[v]) / size, z = own[w] - own[v];
                const double x = d.real(), y = d.imag(), weight = 1 / (1 + std::norm(d));
                rows.row(i).head<3>() << (held ? 0.0 : 1.0), x, y;
                if (quadratic) rows.row(i).tail<3>() << x * x, x * y, y * y;
                wanted.row(i) << z.real(), z.imag();
                rows.row(i) *= weight;
                wanted.row(i) *= weight;
            }
            const Eigen::MatrixXd c = least_squares(rows, wanted);
            value_[v] = own[v] + (held ? Complex(0) : Complex(c(0, 0), c(0, 1)));
            for (int i = 0; i < 2; ++i) along_(v, i) = Complex(c(i + 1, 0), c(i + 1, 1)) / size;
        }
    }

    const Eigen::VectorXcd& map_;
    Eigen::VectorXcd value_;
    Eigen::Matrix<Complex, Eigen::Dynamic, 2> along_;
};

Box box_of(const Eigen::VectorXcd& map) {
    const Eigen::VectorXd x = map.real(), y = map.imag();
    return {{x.minCoeff(), y.minCoeff()}, {x.maxCoeff(), y.maxCoeff()}};
}

void validate(const Picture& picture) {
    if (picture.width < 1 || picture.height < 1 ||
        picture.rgba.size() != 4 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height))
        throw Error(Cause::bad_option, "the picture has no pixels, or not four numbers for each");
}

/// So many points along a side of a pixel of the result that none of the picture's is passed over.
int subpixels(const LightField& field, const Surface& source, const Eigen::VectorXcd& map, double pixel) {
    double steepest = 0;  // of the inverse, mean over the source
    for (int s = 0; s < source.operators.sample_count(); ++s) {
        const auto [p, q] = source.operators.derivatives(s, map);
        const double least = std::abs(std::abs(p) - std::abs(q));
        steepest +=
            source.operators.weights[s] * std::min(1 / std::max(least, 1e-300), 1e6 * field.pixel_size() / pixel);
    }
    steepest /= source.operators.area();
    return std::clamp(static_cast<int>(std::ceil(2 * steepest * pixel / field.pixel_size())), kLeastSubpixels,
                      kMostSubpixels);
}

}  // namespace

void PictureOptions::validate() const {
    if (!(place.high.real() > place.low.real() && place.high.imag() > place.low.imag()))
        throw Error(Cause::bad_option, "the picture's place on the plane is no rectangle",
                    "give its lower left and its upper right corner");
    if (width < 1) throw Error(Cause::bad_option, "the width is not positive");
}

Picture deformed_picture(const Picture& picture, const Surface& source, const Eigen::VectorXcd& map,
                         const PictureOptions& options) {
    options.validate();
    validate(picture);
    if (!source.in_plane())
        throw Error(Cause::bad_mesh, "the surface does not lie in a plane z = const, on which a picture could lie");
    if (map.size() != source.mesh.vertex_count() || !map.allFinite())
        throw Error(Cause::bad_option, "the map has not one finite image for every vertex");
    const Box box = box_of(map);
    const double pixel = (box.high.real() - box.low.real()) / options.width;
    const double rows = pixel > 0 ? std::ceil((box.high.imag() - box.low.imag()) / pixel - 1e-9) : 0;
    if (!(rows >= 1) || !(rows * options.width <= kMostPixels))
        throw Error(Cause::bad_option,
                    "the result would have " + std::to_string(options.width) + " times " +
                        std::to_string(static_cast<long>(rows)) + " pixels",
                    "give another width");
    Mesh image{{}, source.mesh.faces, {}};
    image.positions.resize(map.size(), 2);
    image.positions.col(0) = map.real();
    image.positions.col(1) = map.imag();
    const PlanarLocator locator(image);
    Eigen::VectorXcd own(map.size());
    for (int v = 0; v < map.size(); ++v) own[v] = {source.mesh.positions(v, 0), source.mesh.positions(v, 1)};
    const LightField field(picture, options.place);
    const std::optional<SmoothInverse> smooth =
        options.smooth ? std::optional<SmoothInverse>(std::in_place, source, map, own) : std::nullopt;
    const int n = subpixels(field, source, map, pixel);

    Picture result{options.width, static_cast<int>(rows), {}};
    result.rgba.assign(4 * static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height), 0);
    const auto preimage = [&](Complex w) -> std::optional<Complex> {
        const std::optional<MeshPoint> place = locator.locate(w);
        if (!place) return {};
        Complex z = 0;
        if (smooth) {
            z = smooth->at(w, *place);
        } else {
            z = place->interpolate(own);
        }
        return z;
    };
    parallel_for(
        0, result.height,
        [&](int first, int last) {
            for (int row = first; row < last; ++row)
                for (int column = 0; column < result.width; ++column) {
                    Light sum = Light::Zero();
                    for (int i = 0; i < n * n; ++i) {
                        const int across = i % n, down = i / n;
                        const Complex w(box.low.real() + pixel * (column + (across + 0.5) / n),
                                        box.high.imag() - pixel * (row + (down + 0.5) / n));
                        if (const std::optional<Complex> z = preimage(w)) sum += field.at(*z);
                    }
                    if (!(sum[3] > 0)) continue;
                    std::uint8_t* out = result.rgba.data() + (result.at(column, row) - result.rgba.data());
                    for (int c = 0; c < 3; ++c) out[c] = value_of(sum[c] / sum[3]);
                    out[3] = static_cast<std::uint8_t>(std::lround(255 * sum[3] / (n * n)));
                }
        },
        4);
    return result;
}

}  // namespace beltrami
