#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/locate/corner_weights.h>
#include <beltrami/report/drawing.h>
#include <beltrami/report/page.h>

namespace beltrami {

// The page without its data, bundled from page/ and turned into an array by the build.
extern const unsigned char kPageTemplate[];
extern const std::size_t kPageTemplateSize;

namespace {

using Json = nlohmann::ordered_json;

constexpr int kHistogramBins = 64;

/// Bytes and 16- and 32-bit values, little-endian whatever the machine, in base64.
class Base64 {
  public:
    explicit Base64(std::size_t bytes) { text_.reserve((bytes + 2) / 3 * 4); }

    void add(std::uint32_t value) {
        for (int shift = 0; shift < 32; shift += 8) add_byte((value >> shift) & 0xffU);
    }
    void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
    void add(std::uint16_t value) {
        add_byte(value & 0xffU);
        add_byte(value >> 8U);
    }
    void add(std::string_view bytes) {
        for (const char byte : bytes) add_byte(static_cast<unsigned char>(byte));
    }

    std::string finish() {
        const int missing = (3 - held_) % 3;
        for (int i = 0; i < missing; ++i) add_byte(0);
        for (int i = 0; i < missing; ++i) text_[text_.size() - 1 - static_cast<std::size_t>(i)] = '=';
        return std::move(text_);
    }

  private:
    void add_byte(std::uint32_t byte) {
        constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        bits_ = (bits_ << 8) | byte;
        if (++held_ < 3) return;
        for (int shift = 18; shift >= 0; shift -= 6) text_ += letters[(bits_ >> shift) & 63U];
        bits_ = 0;
        held_ = 0;
    }

    std::string text_;
    std::uint32_t bits_ = 0;
    int held_ = 0;
};

/// Centred and scaled in double precision to the square or cube [-1, 1], then stored as floats: large offsets cost no
/// digits. A third coordinate that is 0 everywhere is left out.
/// @param outline curves in the same plane, which count for the square too
Json encode_positions(const Positions& positions, const std::vector<Positions>& outline = {}) {
    const Eigen::Index dimension = positions.cols() > 2 && !positions.col(2).isZero(0.0) ? 3 : 2;
    Eigen::RowVectorXd low = Eigen::RowVectorXd::Constant(dimension, std::numeric_limits<double>::infinity());
    Eigen::RowVectorXd high = -low;
    const auto hold = [&](const Positions& points) {
        for (Eigen::Index row = 0; row < points.rows(); ++row) {
            const auto point = points.row(row).head(dimension);
            if (!point.allFinite()) continue;
            low = low.cwiseMin(point);
            high = high.cwiseMax(point);
        }
    };
    hold(positions);
    if (dimension == 2) std::for_each(outline.begin(), outline.end(), hold);
    double radius = 0.5 * (high - low).maxCoeff();
    if (!(radius > 0.0) || !std::isfinite(radius)) radius = 1.0;
    const Eigen::RowVectorXd centre = 0.5 * (low + high);
    const auto encode = [&](const Positions& points) {
        Base64 encoded(sizeof(float) * static_cast<std::size_t>(points.rows() * dimension));
        for (Eigen::Index row = 0; row < points.rows(); ++row) {
            for (Eigen::Index i = 0; i < dimension; ++i) {
                encoded.add(static_cast<float>((points(row, i) - centre[i]) / radius));
            }
        }
        return encoded.finish();
    };
    Json result{{"dimension", dimension}, {"radius", radius}, {"coordinates", encode(positions)}};
    for (const Positions& curve : outline)
        if (dimension == 2) result["outline"].push_back(encode(curve));
    return result;
}

/// For every vertex the first one that is a copy of the same.
std::string encode_joined(const std::vector<int>& joined) {
    std::unordered_map<int, std::uint32_t> first;
    Base64 encoded(sizeof(std::uint32_t) * joined.size());
    for (std::size_t v = 0; v < joined.size(); ++v)
        encoded.add(first.try_emplace(joined[v], static_cast<std::uint32_t>(v)).first->second);
    return encoded.finish();
}

/// Angles of trajectories, of each drawn triangle from its first edge, in units of π/65535; 65535 where there is none.
/// @param positions of the drawn vertices
std::string encode_directions(const Mesh& mesh, const Drawing& drawing, const Positions& positions,
                              const Eigen::VectorXd& angles) {
    constexpr std::uint16_t none = 0xffff;
    const auto point = [&](int vertex) {
        Eigen::Vector3d at = Eigen::Vector3d::Zero();
        at.head(positions.cols()) = positions.row(vertex).transpose();
        return at;
    };
    Base64 encoded(sizeof(std::uint16_t) * drawing.triangles.size());
    for (std::size_t t = 0; t < drawing.triangles.size(); ++t) {
        const int face = drawing.faces[t];
        const Eigen::Vector3d along = (mesh.point(mesh.faces[face][1]) - mesh.point(mesh.faces[face][0])).normalized();
        const Eigen::Vector3d across = face_vector_area(mesh, face).normalized().cross(along);
        const Eigen::Vector3d direction = std::cos(angles[face]) * along + std::sin(angles[face]) * across;
        const auto& [a, b, c] = drawing.triangles[t];
        const Eigen::Vector3d first = (point(b) - point(a)).normalized();
        const Eigen::Vector3d side = point(c) - point(a);
        const Eigen::Vector3d second = (side - side.dot(first) * first).normalized();
        double angle = std::atan2(direction.dot(second), direction.dot(first));
        if (angle < 0.0) angle += std::numbers::pi;
        encoded.add(std::isfinite(angle)
                        ? static_cast<std::uint16_t>(std::min(angle / std::numbers::pi * none, none - 1.0))
                        : none);
    }
    return encoded.finish();
}

/// Zeros and poles by the drawn vertices around them.
Json critical_points(const Mesh& mesh, const Drawing& drawing, const std::vector<CriticalPoint>& points) {
    Json list = Json::array();
    for (const CriticalPoint& point : points) {
        std::vector<int> vertices;
        for (const int vertex : mesh.faces[point.place.face])
            vertices.push_back(drawing.coarsened() ? drawing.drawn_vertex[static_cast<std::size_t>(vertex)] : vertex);
        list.push_back({{"order", point.order},
                        {"on_boundary", point.on_boundary},
                        {"vertices", vertices},
                        {"weights", corner_weights(mesh, point.place)}});
    }
    return list;
}

/// Which kind of image that browsers show the bytes are; null if none.
const char* image_kind(std::string_view bytes) {
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "png";
    if (bytes.starts_with("\xff\xd8\xff")) return "jpeg";
    if (bytes.starts_with("RIFF") && bytes.find("WEBP") == 8) return "webp";
    return bytes.starts_with("GIF8") ? "gif" : nullptr;
}

/// An image as an address that needs no fetching.
std::string data_address(const std::string& bytes) {
    require_texture(bytes);
    Base64 encoded(bytes.size());
    encoded.add(std::string_view(bytes));
    return fmt::format("data:image/{};base64,{}", image_kind(bytes), encoded.finish());
}

/// The value below which a share of the area lies; among the faces that keep their orientation.
double weighted_quantile(const Eigen::VectorXd& values, const Eigen::VectorXd& areas, double share) {
    std::vector<Eigen::Index> order;
    for (Eigen::Index face = 0; face < values.size(); ++face) {
        if (values[face] <= 1.0) order.push_back(face);
    }
    if (order.empty()) return 0.0;
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
    double total = 0.0;
    for (const Eigen::Index face : order) total += areas[face];
    double below = 0.0;
    for (const Eigen::Index face : order) {
        below += areas[face];
        if (below >= share * total) return values[face];
    }
    return values[order.back()];
}

/// The next round number: the end of an axis.
double round_up(double value) {
    if (!(value > 0.0)) return 0.01;
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double digit : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
        if (value <= digit * power * (1.0 + 1e-12)) return digit * power;
    }
    return 10.0 * power;
}

/// Shares by |μ| of all faces of the mesh.
/// @param weights of the faces: their areas, or one for each
Json histogram(const Eigen::VectorXd& abs_mu, const Eigen::VectorXd& weights, double end) {
    std::vector<double> bins(kHistogramBins, 0.0);
    double above = 0.0;
    double flipped = 0.0;
    double undefined = 0.0;
    const double total = weights.sum() > 0.0 ? weights.sum() : 1.0;
    for (Eigen::Index face = 0; face < abs_mu.size(); ++face) {
        const double value = abs_mu[face];
        const double share = weights[face] / total;
        if (std::isnan(value)) {
            undefined += share;
        } else if (value > 1.0) {
            flipped += share;
        } else if (value > end) {
            above += share;
        } else {
            const auto bin = static_cast<std::size_t>(std::max(value, 0.0) / end * kHistogramBins);
            bins[std::min(bin, bins.size() - 1)] += share;
        }
    }
    return {{"bins", bins}, {"above", above}, {"flipped", flipped}, {"undefined", undefined}};
}

/// What a map does to the faces that are drawn, and its φ.
/// @param positions of the drawn vertices
void add_values(const PageContent& content, const PageMap& map, const Drawing& drawing, const Positions& positions,
                Json& entry) {
    Base64 values(sizeof(float) * drawing.faces.size());
    for (const int face : drawing.faces) values.add(static_cast<float>(map.abs_mu[face]));
    entry["abs_mu"] = values.finish();
    if (map.differential) {
        entry["directions"] = encode_directions(content.source, drawing, positions, map.differential->angles);
        entry["critical_points"] = critical_points(content.source, drawing, map.differential->points);
    }
}

/// Of every map what the page says of it, apart from what it draws.
/// @param end of the histograms
Json maps_in_numbers(const PageContent& content, const Drawing& drawing, const Eigen::VectorXd& areas, double end) {
    Json list = Json::array();
    for (const PageMap& map : content.maps) {
        if (map.of_source && drawing.coarsened()) continue;
        Json entry{{"name", map.name}};
        if (map.of_source) {
            entry["of_source"] = true;
        } else {
            entry["p99"] = weighted_quantile(map.abs_mu, areas, 0.99);
            entry["histogram"] = {{"area", histogram(map.abs_mu, areas, end)},
                                  {"faces", histogram(map.abs_mu, Eigen::VectorXd::Ones(areas.size()), end)}};
        }
        list.push_back(std::move(entry));
    }
    return list;
}

/// What the page draws. It is long and read beside the page, which does not wait for it.
Json drawn_mesh(const PageContent& content, const Drawing& drawing) {
    const Mesh& mesh = content.source;
    Json result;
    Base64 triangles(3 * sizeof(std::uint32_t) * drawing.triangles.size());
    Base64 faces(sizeof(std::uint32_t) * drawing.triangles.size());
    bool identity = true;
    for (std::size_t t = 0; t < drawing.triangles.size(); ++t) {
        for (const int vertex : drawing.triangles[t]) triangles.add(static_cast<std::uint32_t>(vertex));
        faces.add(static_cast<std::uint32_t>(drawing.faces[t]));
        identity = identity && drawing.faces[t] == static_cast<int>(t);
    }
    result["triangles"] = triangles.finish();
    if (!identity) result["face"] = faces.finish();
    const Positions positions = drawing.reduce(mesh.positions);
    result["source"] = encode_positions(positions);
    // A coarser mesh merges the copies of a vertex.
    if (!content.joined.empty() && !drawing.coarsened()) result["joined"] = encode_joined(content.joined);
    if (!content.texture.empty()) result["texture"] = data_address(content.texture);
    for (const PageMap& map : content.maps) {
        if (map.of_source && drawing.coarsened()) continue;
        Json entry = encode_positions(drawing.reduce(map.map), map.outline);
        if (map.of_source)
            entry["of_source"] = true;
        else
            add_values(content, map, drawing, positions, entry);
        result["maps"].push_back(std::move(entry));
    }
    return result;
}

std::string dump(const Json& json) {
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

/// JSON that may stand inside a script element: no "<", hence neither "</script>" nor "<!--".
std::string dump_for_script(const Json& json) {
    const std::string plain = dump(json);
    std::string safe;
    safe.reserve(plain.size());
    for (const char c : plain) {
        if (c == '<') {
            safe += "\\u003c";
        } else {
            safe += c;
        }
    }
    return safe;
}

std::string escape_html(const std::string& text) {
    std::string safe;
    for (const char c : Json::parse(dump(text)).get<std::string>()) {  // bytes that are not UTF-8 become U+FFFD
        switch (c) {
            case '&':
                safe += "&amp;";
                break;
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '"':
                safe += "&quot;";
                break;
            default:
                safe += c;
        }
    }
    return safe;
}

Json require_record(const PageContent& content) {
    if (content.maps.empty()) throw Error(Cause::bad_option, "the page has no map to show", "give at least one");
    if (content.maps[0].of_source)
        throw Error(Cause::bad_option, "the first map of the page is a picture of its source", "give a map before it");
    for (const PageMap& map : content.maps) {
        const bool fits = map.map.rows() == content.source.vertex_count() && map.map.cols() >= 2 &&
                          map.map.cols() <= 3 && (map.of_source || map.abs_mu.size() == content.source.face_count()) &&
                          (!map.differential || map.differential->angles.size() == content.source.face_count());
        if (fits) continue;
        throw Error(Cause::bad_option,
                    fmt::format("the map '{}' ({}×{} positions, {} values of |μ|) does not fit the mesh", map.name,
                                map.map.rows(), map.map.cols(), map.abs_mu.size()),
                    fmt::format("give one row of 2 or 3 coordinates for each of the {} vertices and one value for each "
                                "of the {} faces",
                                content.source.vertex_count(), content.source.face_count()));
    }
    if (!content.joined.empty() && static_cast<int>(content.joined.size()) != content.source.vertex_count())
        throw Error(Cause::bad_option, fmt::format("{} copies of vertices are named for {} vertices",
                                                   content.joined.size(), content.source.vertex_count()));
    Json record = Json::parse(content.record_json, nullptr, false);
    if (!record.is_object()) throw Error(Cause::bad_option, "the page's record is not a JSON object");
    return record;
}

}  // namespace

void require_texture(const std::string& bytes) {
    if (image_kind(bytes) == nullptr)
        throw Error(Cause::bad_option, "the texture is no image that browsers show", "give a PNG, JPEG, WebP or GIF");
}

std::string render_page(const PageContent& content) {
    Json data;
    data["record"] = require_record(content);
    data["title"] = content.title;
    data["history"] = {
        {"k", content.history_k}, {"change", content.history_change}, {"largest", content.history_largest}};

    const Mesh& mesh = content.source;
    const Drawing drawing = make_drawing(mesh, content.drawn_faces);
    data["faces"] = mesh.face_count();
    data["coarsened"] = drawing.coarsened();
    data["texture"] = !content.texture.empty();

    Eigen::VectorXd areas(mesh.face_count());
    for (int face = 0; face < mesh.face_count(); ++face) areas[face] = face_vector_area(mesh, face).norm();
    double end = 0.0;
    for (const PageMap& map : content.maps)
        if (!map.of_source) end = std::max(end, weighted_quantile(map.abs_mu, areas, 0.995));
    end = std::min(round_up(1.02 * end), 1.0);
    data["histogram_end"] = end;
    data["maps"] = maps_in_numbers(content, drawing, areas, end);

    std::string html;
    std::string_view rest(reinterpret_cast<const char*>(kPageTemplate), kPageTemplateSize);
    const auto copy_until = [&](std::string_view mark) {
        const std::size_t at = rest.find(mark);
        html += rest.substr(0, at);
        rest.remove_prefix(at + mark.size());
    };
    copy_until("@TITLE@");
    html += escape_html(content.title);
    copy_until("@HEADING@");
    html += escape_html(content.title);
    copy_until("@DATA@");
    html += dump_for_script(data);
    copy_until("@MESH@");
    html += dump_for_script(drawn_mesh(content, drawing));
    html += rest;
    return html;
}

}  // namespace beltrami
