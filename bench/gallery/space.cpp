#include "gallery/space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/mesh/edge_table.h>
#include <beltrami/mesh/planar.h>

namespace beltrami::gallery {

namespace {

/// The shortest interval with 99 % of the values, and their part.
std::string narrowest(Eigen::VectorXd values) {
    std::sort(values.begin(), values.end());
    const Eigen::Index n = values.size(), inside = std::max<Eigen::Index>(1, (99 * n + 99) / 100);
    Eigen::Index first = 0;
    for (Eigen::Index i = 0; i + inside <= n; ++i)
        if (values[i + inside - 1] - values[i] < values[first + inside - 1] - values[first]) first = i;
    return number(values[first], 3) + "–" + number(values[first + inside - 1], 3);
}

Mesh in_space(const Mesh& mesh) {
    Mesh result;
    result.faces = mesh.faces;
    result.positions.resize(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) result.positions.row(v) = mesh.point(v);
    return result;
}

nlohmann::json signed_panel(const std::string& data, const std::string& title, double azimuth, double elevation,
                            double most) {
    return surface_panel(data, title, "signed", azimuth, elevation, 1, most);
}

}  // namespace

SpaceFigure::SpaceFigure(Output& output, Figure& figure, std::string name, const Mesh& source,
                         const CornerElements& elements, const View& view)
    : output_(output),
      figure_(figure),
      name_(std::move(name)),
      source_(source),
      elements_(elements),
      view_(view),
      area_(surface_area(source)),
      table_{"",
             {"map", "mean abs(μ)", "std", "p99", "max", "99 % of the faces in", "flips", "angles: smallest", "1 %",
              "mean deviation", "area"},
             {}} {}

/// The frame's real axis in the element's is where z × N points, on planar sources x.
Eigen::VectorXd SpaceFigure::first_components(const Eigen::VectorXcd& mu) const {
    const bool planar = is_planar(source_);
    Eigen::VectorXd first(source_.face_count());
    for (int f = 0; f < source_.face_count(); ++f) {
        const Eigen::Vector3d normal = face_vector_area(source_, f).normalized();
        Eigen::Vector3d axis = planar ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ().cross(normal);
        if (!(axis.norm() > 1e-6)) axis = Eigen::Vector3d::UnitX();
        const auto v = source_.faces[f];
        const Eigen::Vector3d edge = source_.point(v[1]) - source_.point(v[0]);
        // From the edge to the axis, and from the element's axis to the edge.
        const Complex turn(edge.dot(axis), edge.cross(axis).dot(normal));
        const Complex direction = elements_.edge_direction[source_.faces.first_corner(f)] * turn;
        first[f] = std::real(mu[f] * std::norm(direction) / (direction * direction));
    }
    return first;
}

void SpaceFigure::add(const std::string& method, const Positions& positions, const Positions& normals, bool drawn) {
    Mesh image = in_space(source_);
    image.positions = positions;
    last_ = distortion(elements_.operators, positions, normals);
    const AngleStatistics angles = angle_statistics(image);
    table_.rows.push_back({method, number(last_.mean), number(last_.standard_deviation), number(last_.p99, 3),
                           number(last_.max, 3), narrowest(last_.face_abs_mu), std::to_string(last_.flipped.size()),
                           number(angles.smallest, 1), number(angles.one_percent, 1), number(angles.mean_deviation, 1),
                           number(surface_area(image) / area_, 3)});
    if (!drawn) return;
    std::vector<double> parts;
    for (const int count : angles.histogram)
        parts.push_back(100.0 * count / static_cast<double>(source_.faces.corner_count()));
    Eigen::VectorXcd mu = last_.mu;
    for (Complex& value : mu)
        if (!std::isfinite(std::abs(value))) value = 2;
    drawn_.push_back({method, std::move(image), last_.face_abs_mu,
                      first_components(face_means(elements_.operators, mu)), std::move(parts)});
}

void SpaceFigure::refuse(const std::string& method, const std::string& reason) {
    std::vector<std::string> row(table_.head.size());
    row[0] = method;
    row[1] = reason;
    table_.rows.push_back(std::move(row));
}

void SpaceFigure::end_table(const std::string& caption) {
    table_.caption = caption;
    figure_.tables.push_back(std::move(table_));
}

void SpaceFigure::end_picture(const std::string& caption) {
    Picture picture{name_, caption, {}};
    std::vector<std::pair<std::string, std::string>> data;
    std::vector<Curve> angles;
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
        const Drawn& d = drawn_[i];
        const std::string file = output_.write(name_ + "_" + std::to_string(i), d.image,
                                               Eigen::VectorXcd::Zero(d.image.vertex_count()), d.abs_mu);
        picture.panels.push_back(surface_panel(file, d.title, "mu", view_.azimuth, view_.elevation, 1, view_.most_mu));
        data.emplace_back(d.title, file);
        Curve curve{d.title, {}, d.angles};
        for (std::size_t j = 0; j < d.angles.size(); ++j) curve.x.push_back(10 * static_cast<double>(j) + 5);
        angles.push_back(std::move(curve));
    }
    picture.panels.push_back(histogram_panel(data, "|μ|", {}, view_.most_mu));
    picture.panels.push_back(curves_panel(angles, "angles", "degrees", "% of the angles", false));
    figure_.pictures.push_back(std::move(picture));
}

void SpaceFigure::end_components(const std::string& caption, bool differences) {
    Picture picture{name_ + "_mu1", caption, {}};
    const EdgeTable edges = edge_table(source_.faces, source_.vertex_count());
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
        const Drawn& d = drawn_[i];
        const auto panel = [&](const std::string& what, const std::string& title, const Eigen::VectorXd& values) {
            const std::string file = output_.write(name_ + what + std::to_string(i), d.image,
                                                   Eigen::VectorXcd::Zero(d.image.vertex_count()), values);
            picture.panels.push_back(signed_panel(file, title, view_.azimuth, view_.elevation, view_.most_mu));
        };
        panel("_mu1_", "μ₁: " + d.title, d.first);
        if (!differences) continue;
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(source_.face_count()), count = sum;
        for (int e = 0; e < edges.edge_count(); ++e) {
            const auto corners = edges.corners_of(e);
            if (corners.size() != 2) continue;
            const int a = edges.corner_faces[corners[0]], b = edges.corner_faces[corners[1]];
            sum[a] += d.first[b] - d.first[a];
            sum[b] += d.first[a] - d.first[b];
            ++count[a];
            ++count[b];
        }
        panel("_change_", "change of μ₁: " + d.title, sum.array() / count.array().max(1));
    }
    figure_.pictures.push_back(std::move(picture));
}

}  // namespace beltrami::gallery
