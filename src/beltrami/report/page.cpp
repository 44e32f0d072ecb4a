#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include <beltrami/base/error.h>
#include <beltrami/report/drawing.h>
#include <beltrami/report/page.h>

namespace beltrami {

// page.html.in, turned into an array by the build.
extern const unsigned char kPageTemplate[];
extern const std::size_t kPageTemplateSize;

namespace {

using Json = nlohmann::ordered_json;

constexpr int kHistogramBins = 64;

/// Bytes of 32-bit values, little-endian whatever the machine, in base64.
class Base64 {
  public:
    explicit Base64(std::size_t values) { text_.reserve((4 * values + 2) / 3 * 4); }

    void add(std::uint32_t value) {
        for (int shift = 0; shift < 32; shift += 8) add_byte((value >> shift) & 0xffU);
    }
    void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }

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
Json encode_positions(const Positions& positions) {
    const Eigen::Index dimension = positions.cols() > 2 && !positions.col(2).isZero(0.0) ? 3 : 2;
    Eigen::RowVectorXd low = Eigen::RowVectorXd::Constant(dimension, std::numeric_limits<double>::infinity());
    Eigen::RowVectorXd high = -low;
    for (Eigen::Index row = 0; row < positions.rows(); ++row) {
        const auto point = positions.row(row).head(dimension);
        if (!point.allFinite()) continue;
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    double radius = 0.5 * (high - low).maxCoeff();
    if (!(radius > 0.0) || !std::isfinite(radius)) radius = 1.0;
    const Eigen::RowVectorXd centre = 0.5 * (low + high);
    Base64 encoded(static_cast<std::size_t>(positions.rows() * dimension));
    for (Eigen::Index row = 0; row < positions.rows(); ++row) {
        for (Eigen::Index i = 0; i < dimension; ++i) {
            encoded.add(static_cast<float>((positions(row, i) - centre[i]) / radius));
        }
    }
    return {{"dimension", dimension}, {"coordinates", encoded.finish()}};
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
    for (const PageMap& map : content.maps) {
        const bool fits = map.map.rows() == content.source.vertex_count() && map.map.cols() >= 2 &&
                          map.map.cols() <= 3 && map.abs_mu.size() == content.source.face_count();
        if (fits) continue;
        throw Error(Cause::bad_option,
                    fmt::format("the map '{}' ({}×{} positions, {} values of |μ|) does not fit the mesh", map.name,
                                map.map.rows(), map.map.cols(), map.abs_mu.size()),
                    fmt::format("give one row of 2 or 3 coordinates for each of the {} vertices and one value for each "
                                "of the {} faces",
                                content.source.vertex_count(), content.source.face_count()));
    }
    Json record = Json::parse(content.record_json, nullptr, false);
    if (!record.is_object()) throw Error(Cause::bad_option, "the page's record is not a JSON object");
    return record;
}

}  // namespace

std::string render_page(const PageContent& content) {
    Json data;
    data["record"] = require_record(content);
    data["title"] = content.title;
    data["history"] = {
        {"k", content.history_k}, {"change", content.history_change}, {"largest", content.history_largest}};

    const Mesh& mesh = content.source;
    const Drawing drawing = make_drawing(mesh, content.drawn_faces);
    Base64 triangles(3 * drawing.triangles.size());
    Base64 faces(drawing.triangles.size());
    bool identity = true;
    for (std::size_t t = 0; t < drawing.triangles.size(); ++t) {
        for (const int vertex : drawing.triangles[t]) triangles.add(static_cast<std::uint32_t>(vertex));
        faces.add(static_cast<std::uint32_t>(drawing.faces[t]));
        identity = identity && drawing.faces[t] == static_cast<int>(t);
    }
    data["faces"] = mesh.face_count();
    data["coarsened"] = drawing.coarsened();
    data["triangles"] = triangles.finish();
    if (!identity) data["face"] = faces.finish();
    data["source"] = encode_positions(drawing.reduce(mesh.positions));

    Eigen::VectorXd areas(mesh.face_count());
    for (int face = 0; face < mesh.face_count(); ++face) areas[face] = face_vector_area(mesh, face).norm();
    double end = 0.0;
    for (const PageMap& map : content.maps) end = std::max(end, weighted_quantile(map.abs_mu, areas, 0.995));
    end = std::min(round_up(1.02 * end), 1.0);
    data["histogram_end"] = end;
    for (const PageMap& map : content.maps) {
        Json entry = encode_positions(drawing.reduce(map.map));
        entry["name"] = map.name;
        Base64 values(drawing.faces.size());
        for (const int face : drawing.faces) values.add(static_cast<float>(map.abs_mu[face]));
        entry["abs_mu"] = values.finish();
        entry["p99"] = weighted_quantile(map.abs_mu, areas, 0.99);
        entry["histogram"] = {{"area", histogram(map.abs_mu, areas, end)},
                              {"faces", histogram(map.abs_mu, Eigen::VectorXd::Ones(areas.size()), end)}};
        data["maps"].push_back(std::move(entry));
    }

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
    html += rest;
    return html;
}

}  // namespace beltrami
