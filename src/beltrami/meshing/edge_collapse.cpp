#include <beltrami/meshing/edge_collapse.h>

#include <algorithm>
#include <array>
#include <functional>
#include <queue>
#include <tuple>

#include <Eigen/Geometry>

namespace beltrami {

namespace {

constexpr double kMostTurn = 0.2;  // least cosine between the normals of a face before and after
constexpr int kMostNeighbours = 12;

class Collapsing {
  public:
    explicit Collapsing(const Mesh& mesh)
        : mesh_(mesh), around_(static_cast<std::size_t>(mesh.vertex_count())), images_(around_.size()) {
        for (int f = 0; f < mesh.face_count(); ++f) {
            const auto v = mesh.faces[f];
            faces_.push_back({v[0], v[1], v[2]});
            for (const int corner : v) around_[corner].push_back(f);
        }
        for (std::size_t v = 0; v < images_.size(); ++v) {
            images_[v] = static_cast<int>(v);
            left_ += !around_[v].empty();
        }
        for (std::size_t v = 0; v < images_.size(); ++v)
            for (const int w : neighbours(static_cast<int>(v)))
                if (static_cast<int>(v) < w) push(static_cast<int>(v), w);
    }

    void run(int vertices) {
        while (left_ > vertices && !queue_.empty()) {
            const auto [length, a, b] = queue_.top();
            queue_.pop();
            if (images_[a] != a || images_[b] != b) continue;
            if (may_move(b, a))
                move(b, a);
            else if (may_move(a, b))
                move(a, b);
        }
    }

    CollapsedMesh result() {
        CollapsedMesh result;
        result.images.resize(images_.size());
        std::vector<int> numbers(images_.size(), -1);
        int count = 0;
        for (std::size_t v = 0; v < images_.size(); ++v)
            if (images_[v] == static_cast<int>(v)) numbers[v] = count++;
        result.mesh.positions.resize(count, mesh_.positions.cols());
        for (std::size_t v = 0; v < images_.size(); ++v) {
            if (numbers[v] >= 0)
                result.mesh.positions.row(numbers[v]) = mesh_.positions.row(static_cast<Eigen::Index>(v));
            int image = static_cast<int>(v);
            while (images_[image] != image) image = images_[image];
            result.images[v] = numbers[image];
        }
        for (const auto& [a, b, c] : faces_)
            if (a >= 0) result.mesh.faces.add({numbers[a], numbers[b], numbers[c]});
        return result;
    }

  private:
    std::vector<int> neighbours(int v) const {
        std::vector<int> result;
        for (const int f : around_[v])
            for (const int w : faces_[f])
                if (w != v) result.push_back(w);
        std::ranges::sort(result);
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }
    bool has(int f, int v) const { return std::ranges::find(faces_[f], v) != faces_[f].end(); }
    Eigen::Vector3d normal(const std::array<int, 3>& face) const {
        const Eigen::Vector3d p = mesh_.point(face[0]);
        return (mesh_.point(face[1]) - p).cross(mesh_.point(face[2]) - p).normalized();
    }
    void push(int a, int b) {
        queue_.emplace((mesh_.point(a) - mesh_.point(b)).norm(), std::min(a, b), std::max(a, b));
    }

    bool may_move(int from, int to) const {
        const std::vector<int> here = neighbours(from), there = neighbours(to);
        if (here.size() != around_[from].size()) return false;  // on the boundary
        std::vector<int> common;
        std::ranges::set_intersection(here, there, std::back_inserter(common));
        if (common.size() != 2 || here.size() + there.size() > kMostNeighbours + 4) return false;
        for (const int opposite : common)
            if (around_[opposite].size() <= 3) return false;
        for (const int f : around_[from]) {
            if (has(f, to)) continue;
            std::array<int, 3> moved = faces_[f];
            std::ranges::replace(moved, from, to);
            if (!(normal(faces_[f]).dot(normal(moved)) > kMostTurn)) return false;
        }
        return true;
    }
    void move(int from, int to) {
        for (const int f : around_[from]) {
            if (has(f, to)) {
                for (const int v : faces_[f])
                    if (v != from) std::erase(around_[v], f);
                faces_[f] = {-1, -1, -1};
            } else {
                std::ranges::replace(faces_[f], from, to);
                around_[to].push_back(f);
            }
        }
        around_[from].clear();
        images_[from] = to;
        --left_;
        for (const int w : neighbours(to)) push(to, w);
    }

    const Mesh& mesh_;
    std::vector<std::vector<int>> around_;  // faces at every vertex
    std::vector<int> images_;
    std::vector<std::array<int, 3>> faces_;  // −1: gone
    using Entry = std::tuple<double, int, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
    int left_ = 0;
};

}  // namespace

CollapsedMesh collapse_edges(const Mesh& mesh, int vertices) {
    Collapsing collapsing(mesh);
    collapsing.run(vertices);
    return collapsing.result();
}

}  // namespace beltrami
