#include "components.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include <beltrami/base/error.h>
#include <beltrami/mesh/submesh.h>

#include "page.h"

namespace beltrami::cli {

namespace {

/// Of the width of an image, the free space beside it.
constexpr double kGap = 0.1;

/// The whole, to which components are added.
class Assembly {
  public:
    explicit Assembly(const Mesh& source) : source_(source), faces_(source.face_count()) {
        for (int v = 0; v < source.vertex_count(); ++v) positions_.emplace_back(source.positions.row(v));
        map_.assign(static_cast<std::size_t>(source.vertex_count()), 0);
    }

    /// @param part where the component's vertices and faces come from
    /// @param split record of the component's split, if it was split
    void add(const Submesh& part, const MethodResult& result, const std::optional<SplitRecord>& split) {
        double left = result.map.real().minCoeff(), right = result.map.real().maxCoeff();
        const Complex shift = next_left_ - left;
        next_left_ += (1 + kGap) * (right - left);
        std::vector<int> vertices = part.vertices;
        const Mesh& mapped = result.split ? result.split->mesh : part.mesh;
        for (int v = static_cast<int>(vertices.size()); v < mapped.vertex_count(); ++v) {
            vertices.push_back(static_cast<int>(positions_.size()));
            positions_.emplace_back(mapped.positions.row(v));
            map_.emplace_back();
        }
        for (int v = 0; v < mapped.vertex_count(); ++v) map_[vertices[v]] = result.map[v] + shift;
        for (int f = 0; f < mapped.face_count(); ++f) {
            std::vector<int> face;
            for (const int v : mapped.faces[f]) face.push_back(vertices[v]);
            faces_[part.faces[result.split ? result.face_parents[f] : f]].push_back(std::move(face));
        }
        if (!split) return;
        edges_ += split->edges;
        for (std::vector<int> row : split->added) {
            for (int& v : row) v = vertices[v];
            added_.push_back(std::move(row));
        }
    }

    MethodResult finish(const Surface& source, Record& record) const {
        MethodResult done;
        if (edges_ > 0) {
            record.split = SplitRecord{edges_, added_};
            Mesh mesh;
            mesh.positions.resize(static_cast<Eigen::Index>(positions_.size()), source_.positions.cols());
            for (std::size_t v = 0; v < positions_.size(); ++v)
                mesh.positions.row(static_cast<Eigen::Index>(v)) = positions_[v];
            for (std::size_t f = 0; f < faces_.size(); ++f)
                for (const std::vector<int>& face : faces_[f]) {
                    mesh.faces.add(face);
                    done.face_parents.push_back(static_cast<int>(f));
                }
            done.split.emplace(std::move(mesh));
        }
        done.map = Eigen::Map<const Eigen::VectorXcd>(map_.data(), static_cast<Eigen::Index>(map_.size()));
        done.distortion = distortion((done.split ? *done.split : source).operators, done.map);
        return done;
    }

  private:
    const Mesh& source_;
    std::vector<Eigen::RowVectorXd> positions_;
    std::vector<Complex> map_;
    std::vector<std::vector<std::vector<int>>> faces_;  // for each face of the source those that it has become
    std::vector<std::vector<int>> added_;
    int edges_ = 0;
    double next_left_ = 0;
};

}  // namespace

MethodResult map_components(const Surface& source,
                            const std::function<MethodResult(const Surface& component, Record& record)>& map_one,
                            Record& record) {
    Assembly assembly(source.mesh);
    record.solve.emplace();
    std::set<std::string> terminations;
    const auto components = component_faces(source.mesh);
    for (std::size_t c = 0; c < components.size(); ++c) {
        const Submesh part = keep_faces(source.mesh, components[c]);
        Record own;
        MethodResult result;
        try {
            result = map_one(Surface(part.mesh), own);
        } catch (const Error& error) {
            throw Error(error.cause(),
                        fmt::format("component {}, whose first face is {}: {}", c, components[c][0], error.what()), {},
                        {Things::faces, {components[c][0]}});
        }
        assembly.add(part, result, own.split);
        std::vector<int> whole_faces = part.faces;
        if (result.split) {
            whole_faces.clear();
            for (const int parent : result.face_parents) whole_faces.push_back(part.faces[parent]);
        }
        for (const Warning& warning : own.warnings)
            record.warnings.push_back({warning.kind, fmt::format("component {}: {}", c, warning.sentence),
                                       in_whole(warning.where, part.vertices, whole_faces)});
        record.components.push_back({components[c][0], static_cast<int>(components[c].size()), *own.map, *own.solve});
        record.solve->iterations += own.solve->iterations;
        record.solve->factorizations += own.solve->factorizations;
        record.solve->seconds_total += own.solve->seconds_total;
        record.solve->folds_removed = record.solve->folds_removed || own.solve->folds_removed;
        terminations.insert(own.solve->termination);
    }
    const std::string settled = to_string(Termination::converged);
    const auto other = std::find_if(terminations.begin(), terminations.end(),
                                    [&](const std::string& termination) { return termination != settled; });
    record.solve->termination = other == terminations.end() ? settled : *other;
    MethodResult done = assembly.finish(source, record);
    record.map = map_record(done.distortion);
    done.pages.push_back({"components", positions_of(done.map), done.distortion.face_abs_mu});
    return done;
}

}  // namespace beltrami::cli
