#include "problems/level_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include <beltrami/mesh/topology.h>

namespace beltrami::bench {

namespace {

constexpr int kRounds = 15;       // of evening
constexpr double kEvening = 0.7;  // part of the way to the mean of the neighbours
constexpr double kDifference = 1e-4;

Eigen::Vector3d gradient(const Level& level, const Eigen::Vector3d& p) {
    Eigen::Vector3d result;
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d step = kDifference * Eigen::Vector3d::Unit(k);
        result[k] = (level(p + step) - level(p - step)) / (2 * kDifference);
    }
    return result;
}

/// Vertices to the mean of their neighbours, along the surface, and back onto it.
void even_out(const Level& level, Mesh& mesh) {
    const Topology shape = topology(mesh);
    for (int round = 0; round < kRounds; ++round) {
        Positions sums = Positions::Zero(mesh.vertex_count(), 3);
        Eigen::VectorXd counts = Eigen::VectorXd::Zero(mesh.vertex_count());
        for (const auto& [a, b] : shape.edges) {
            sums.row(a) += mesh.positions.row(b);
            sums.row(b) += mesh.positions.row(a);
            counts[a] += 1;
            counts[b] += 1;
        }
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            Eigen::Vector3d p = mesh.point(v);
            const Eigen::Vector3d normal = gradient(level, p).normalized();
            Eigen::Vector3d way = sums.row(v).transpose() / counts[v] - p;
            way -= way.dot(normal) * normal;
            p += kEvening * way;
            for (int step = 0; step < 3; ++step) {
                const Eigen::Vector3d slope = gradient(level, p);
                p -= level(p) / slope.squaredNorm() * slope;
            }
            mesh.positions.row(v) = p.transpose();
        }
    }
}

/// Marching tetrahedra: six of every cell, about its long diagonal.
class Marching {
  public:
    Marching(const Level& level, const LevelGrid& grid)
        : level_(level), turn_(Eigen::AngleAxisd(grid.turn, Eigen::Vector3d::UnitZ())) {
        // The box that holds the given one once it is turned.
        middle_ = 0.5 * (grid.low + grid.high);
        Eigen::Vector3d half = 0.5 * (grid.high - grid.low);
        const double c = std::abs(std::cos(grid.turn)), s = std::abs(std::sin(grid.turn));
        half.head<2>() = Eigen::Vector2d(c * half[0] + s * half[1], s * half[0] + c * half[1]);
        step_ = grid.edge_length;
        corner_ = -half + step_ * grid.offset - step_ * Eigen::Vector3d::Ones();
        for (int k = 0; k < 3; ++k)
            size_[static_cast<std::size_t>(k)] = static_cast<int>(std::ceil(2 * half[k] / step_)) + 3;
    }

    Mesh run() {
        const auto [nx, ny, nz] = size_;
        values_.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
        for (int i = 0; i < nx; ++i)
            for (int j = 0; j < ny; ++j)
                for (int k = 0; k < nz; ++k) values_[number({i, j, k})] = level_(place({i, j, k}));
        constexpr std::array<std::array<int, 3>, 6> orders{
            {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
        for (int i = 0; i + 1 < nx; ++i)
            for (int j = 0; j + 1 < ny; ++j)
                for (int k = 0; k + 1 < nz; ++k)
                    for (const std::array<int, 3>& order : orders) {
                        std::array<std::array<int, 3>, 4> corners{};
                        corners[0] = {i, j, k};
                        for (std::size_t n = 0; n < 3; ++n) {
                            corners[n + 1] = corners[n];
                            ++corners[n + 1][static_cast<std::size_t>(order[n])];
                        }
                        tetrahedron(corners);
                    }
        mesh_.positions.resize(static_cast<Eigen::Index>(points_.size()), 3);
        for (std::size_t v = 0; v < points_.size(); ++v)
            mesh_.positions.row(static_cast<Eigen::Index>(v)) = points_[v].transpose();
        return std::move(mesh_);
    }

  private:
    using Node = std::array<int, 3>;
    std::size_t number(const Node& n) const {
        return (static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(size_[1]) + static_cast<std::size_t>(n[1])) *
                   static_cast<std::size_t>(size_[2]) +
               static_cast<std::size_t>(n[2]);
    }
    Eigen::Vector3d place(const Node& n) const {
        return middle_ + turn_ * (corner_ + step_ * Eigen::Vector3d(n[0], n[1], n[2]));
    }
    int crossing(const Node& a, const Node& b) {
        const auto [low, high] = std::minmax({number(a), number(b)});
        const auto [at, is_new] = numbers_.try_emplace({low, high}, static_cast<int>(points_.size()));
        if (is_new) {
            const double here = values_[number(a)], there = values_[number(b)];
            points_.push_back(place(a) + here / (here - there) * (place(b) - place(a)));
        }
        return at->second;
    }
    void triangle(const std::array<int, 3>& t, const Eigen::Vector3d& outwards) {
        const auto point = [&](std::size_t k) { return points_[static_cast<std::size_t>(t[k])]; };
        const bool turned = (point(1) - point(0)).cross(point(2) - point(0)).dot(outwards) < 0;
        mesh_.faces.add(turned ? std::array<int, 3>{t[0], t[2], t[1]} : t);
    }
    void tetrahedron(const std::array<Node, 4>& corners) {
        std::vector<Node> in, out;
        Eigen::Vector3d outwards = Eigen::Vector3d::Zero();
        for (const Node& n : corners) (values_[number(n)] < 0 ? in : out).push_back(n);
        if (in.empty() || out.empty()) return;
        for (const Node& n : in) outwards -= place(n) / static_cast<double>(in.size());
        for (const Node& n : out) outwards += place(n) / static_cast<double>(out.size());
        if (in.size() == 2) {
            const std::array<int, 4> q{crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[1], out[1]),
                                       crossing(in[1], out[0])};
            triangle({q[0], q[1], q[2]}, outwards);
            triangle({q[0], q[2], q[3]}, outwards);
            return;
        }
        const Node& alone = in.size() == 1 ? in[0] : out[0];
        const std::vector<Node>& others = in.size() == 1 ? out : in;
        triangle({crossing(alone, others[0]), crossing(alone, others[1]), crossing(alone, others[2])}, outwards);
    }

    const Level& level_;
    Eigen::Matrix3d turn_;
    Eigen::Vector3d middle_, corner_;
    double step_ = 0;
    std::array<int, 3> size_{};
    std::vector<double> values_;
    std::map<std::array<std::size_t, 2>, int> numbers_;
    std::vector<Eigen::Vector3d> points_;
    Mesh mesh_;
};

/// Another grid than the upright one.
LevelGrid grid_of(double edge_length, const Eigen::Vector3d& low, const Eigen::Vector3d& high, bool other) {
    LevelGrid grid;
    grid.edge_length = edge_length;
    grid.low = low;
    grid.high = high;
    grid.offset = other ? Eigen::Vector3d(0.37, 0.21, 0.43) : Eigen::Vector3d(0.05, 0.15, 0.31);
    grid.turn = other ? 0.5 : 0.2;
    return grid;
}

}  // namespace

Mesh level_surface(const Level& level, const LevelGrid& grid) {
    Mesh mesh = Marching(level, grid).run();
    even_out(level, mesh);
    return mesh;
}

Mesh level_double_torus(double edge_length, const Stretch& stretch, bool other) {
    const Level level = [&](const Eigen::Vector3d& p) {
        const double x = p[0], y = p[1] / stretch(x), square = x * (x - 1) * (x - 1) * (x - 2) + y * y;
        return square * square + p[2] * p[2] - 0.027;
    };
    const double width = 1.15 * std::max(stretch(-0.1), stretch(2.1));
    return level_surface(level, grid_of(edge_length, {-0.35, -width, -0.35}, {2.35, width, 0.35}, other));
}

Mesh three_rings(bool in_a_row, double edge_length, const Stretch& stretch, bool other) {
    std::array<Eigen::Vector2d, 3> centres;
    for (std::size_t i = 0; i < 3; ++i) {
        const double angle = std::numbers::pi * (0.5 + 2.0 / 3 * static_cast<double>(i));
        centres[i] = in_a_row ? Eigen::Vector2d(1.1 * static_cast<double>(i), 0)
                              : Eigen::Vector2d(1.1 + 0.66 * std::cos(angle), 0.66 * std::sin(angle));
    }
    const Level level = [&](const Eigen::Vector3d& p) {
        const Eigen::Vector2d q(p[0], p[1] / stretch(p[0]));
        double sum = 0;
        for (const Eigen::Vector2d& centre : centres) {
            const double from_circle = std::sqrt((q - centre).squaredNorm() + 1e-9) - 0.5;
            sum += std::exp(-12 * (from_circle * from_circle + p[2] * p[2]));
        }
        return -std::log(sum) / 12 - 0.04;
    };
    const double length = in_a_row ? 2.1 : 1.6,
                 width = (in_a_row ? 1.0 : 1.5) * std::max({stretch(-0.5), stretch(1.1), stretch(2.7)});
    return level_surface(level, grid_of(edge_length, {1.1 - length, -width, -0.4}, {1.1 + length, width, 0.4}, other));
}

Mesh root_three_refined(const Mesh& mesh) {
    const Topology shape = topology(mesh);
    const int n = mesh.vertex_count();
    Mesh result;
    result.positions.resize(n + mesh.face_count(), 3);
    result.positions.topRows(n) = mesh.positions;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto corners = mesh.faces[f];
        result.positions.row(n + f) =
            (mesh.positions.row(corners[0]) + mesh.positions.row(corners[1]) + mesh.positions.row(corners[2])) / 3;
    }
    for (int f = 0; f < mesh.face_count(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 3];
            const auto& [left, right] = shape.edge_faces[shape.corner_edges[mesh.faces.first_corner(f) + k]];
            const int beyond = left == f ? right : left;
            if (beyond < 0)
                result.faces.add({a, b, n + f});
            else
                result.faces.add({a, n + beyond, n + f});
        }
    return result;
}

}  // namespace beltrami::bench
