#include "batch_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <beltrami/base/error.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/operators/operators.h>

namespace beltrami::cli {

const char* const kThumbnail = "thumbnail.bmp";

namespace {

constexpr int kSide = 112;  // pixels
constexpr double kMostMu = 0.6;

/// Viridis by five stops; 255 is the background, 254 a face that is flipped.
std::array<std::uint8_t, 3> palette_colour(int index) {
    constexpr double stops[5][3] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    if (index == 255) return {255, 255, 255};
    if (index == 254) return {220, 20, 60};
    const double t = index / 253.0 * 4;
    const int i = std::min(3, static_cast<int>(t));
    std::array<std::uint8_t, 3> colour{};
    for (int c = 0; c < 3; ++c)
        colour[c] = static_cast<std::uint8_t>(std::lround(stops[i][c] + (t - i) * (stops[i + 1][c] - stops[i][c])));
    return colour;
}

/// An image of numbers of colours, row 0 below.
class Raster {
  public:
    Raster() : pixels_(static_cast<std::size_t>(kSide) * kSide, static_cast<char>(255)) {}

    void triangle(const std::array<Eigen::Vector2d, 3>& p, std::uint8_t colour) {
        const auto side = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, double x, double y) {
            return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
        };
        const auto [low_x, high_x] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
        const auto [low_y, high_y] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
        const double sign = side(p[0], p[1], p[2].x(), p[2].y()) < 0 ? -1 : 1;
        for (int y = clamp(std::ceil(low_y - 0.5)); y <= clamp(high_y); ++y)
            for (int x = clamp(std::ceil(low_x - 0.5)); x <= clamp(high_x); ++x) {
                bool inside = true;
                for (int i = 0; i < 3; ++i) inside = inside && sign * side(p[i], p[(i + 1) % 3], x + 0.5, y + 0.5) >= 0;
                if (inside) set(x, y, colour);
            }
        const Eigen::Vector2d middle = (p[0] + p[1] + p[2]) / 3;  // of faces smaller than a pixel
        set(clamp(middle.x()), clamp(middle.y()), colour);
    }

    std::string bmp() const {
        std::string bytes;
        const auto number = [&](std::uint32_t value, int count) {
            for (int i = 0; i < count; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 255));
        };
        constexpr std::uint32_t header = 14 + 40 + 4 * 256, size = kSide * kSide;
        static_assert(kSide % 4 == 0, "rows of a BMP end on four bytes");
        bytes += "BM";
        number(header + size, 4);
        number(0, 4);
        number(header, 4);
        number(40, 4);
        number(kSide, 4);
        number(kSide, 4);
        number(1, 2);
        number(8, 2);
        number(0, 4);
        number(size, 4);
        for (int i = 0; i < 2; ++i) number(2835, 4);
        number(256, 4);
        number(0, 4);
        for (int i = 0; i < 256; ++i) {
            const std::array<std::uint8_t, 3> colour = palette_colour(i);
            number(
                static_cast<std::uint32_t>(colour[2]) | colour[1] << 8U | static_cast<std::uint32_t>(colour[0]) << 16U,
                4);
        }
        bytes.append(pixels_.begin(), pixels_.end());
        return bytes;
    }

  private:
    static int clamp(double value) { return static_cast<int>(std::clamp(value, 0.0, kSide - 1.0)); }
    void set(int x, int y, std::uint8_t colour) {
        pixels_[static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x)] = static_cast<char>(colour);
    }

    std::vector<char> pixels_;
};

std::uint8_t colour_of_mu(double abs_mu) {
    if (!(abs_mu < 1)) return 254;
    return static_cast<std::uint8_t>(std::lround(253 * std::min(1.0, abs_mu / kMostMu)));
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '&':
                result += "&amp;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

const std::vector<std::pair<const char*, const char*>>& number_columns() {
    static const std::vector<std::pair<const char*, const char*>> columns{
        {"faces", "faces"},      {"K", "K"},           {"K_lower_proved", "proved"},
        {"K_max", "K of faces"}, {"mean", "mean |μ|"}, {"flipped", "flipped"}};
    return columns;
}

std::string row_of(const BatchOutcome& outcome) {
    const std::string id = escaped(outcome.id);
    std::string row = fmt::format("<tr class=\"{}\"><td>", outcome.done() ? "done" : "failed");
    if (std::find(outcome.files.begin(), outcome.files.end(), kThumbnail) != outcome.files.end())
        row += fmt::format("<img loading=\"lazy\" width=\"{0}\" height=\"{0}\" alt=\"\" src=\"{1}/{2}\">", kSide, id,
                           kThumbnail);
    row += fmt::format("</td><td><a href=\"{0}/\">{0}</a></td><td>{1}</td><td class=\"n\">{2:.2f}</td>", id,
                       outcome.done() ? "done" : escaped(outcome.cause), outcome.seconds);
    for (const auto& [name, title] : number_columns()) {
        const auto found = outcome.numbers.find(name);
        row += found == outcome.numbers.end() ? std::string("<td class=\"n\"></td>")
                                              : fmt::format("<td class=\"n\">{:.6g}</td>", found->second);
    }
    std::string command = "beltrami";
    for (const std::string& arg : outcome.args) command += " " + arg;
    row += fmt::format("<td title=\"{}\">{}</td></tr>\n", escaped(command), escaped(outcome.message));
    return row;
}

constexpr const char* kBatchStyle =
    "body{font:14px system-ui,sans-serif;margin:2em}table{border-collapse:collapse}"
    "th{cursor:pointer;text-align:left;border-bottom:2px solid #888;padding:4px "
    "10px;position:sticky;top:0;background:#fff}"
    "td{padding:2px 10px;border-bottom:1px solid #ddd}.n{text-align:right;font-variant-numeric:tabular-nums}"
    ".failed td{background:#fdecea}img{display:block;image-rendering:pixelated}";

constexpr const char* kBatchScript =
    "document.querySelectorAll('th').forEach((head,column)=>{let up=false;head.onclick=()=>{up=!up;"
    "const body=document.querySelector('tbody'),key=r=>r.cells[column].innerText;"
    "[...body.rows].sort((a,b)=>{const x=key(a),y=key(b),n=x-y;"
    "if(x===''||y==='')return (x==='')-(y==='');"
    "return (up?1:-1)*(isNaN(n)?x.localeCompare(y,undefined,{numeric:true}):n)}).forEach(r=>body.append(r))}});";

}  // namespace

std::string thumbnail_of(const std::filesystem::path& path) {
    try {
        const Mesh mesh = read_mesh(path).mesh;
        const bool has_map = mesh.texture.has_value();
        Positions points = has_map ? texture_corners(mesh) : corner_positions(mesh);
        if (points.rows() == 0 || !points.allFinite()) return {};
        const Eigen::VectorXd abs_mu =
            has_map ? distortion_to_corners(mesh, points).face_abs_mu : Eigen::VectorXd::Zero(mesh.face_count());
        const Eigen::RowVectorXd low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
        const double size = std::max(high[0] - low[0], high[1] - low[1]);
        if (!(size > 0)) return {};
        const auto place = [&](int corner) -> Eigen::Vector2d {
            const double unit = (kSide - 4) / size;
            return {kSide / 2.0 + unit * (points(corner, 0) - (low[0] + high[0]) / 2),
                    kSide / 2.0 + unit * (points(corner, 1) - (low[1] + high[1]) / 2)};
        };
        Raster raster;
        for (int f = 0; f < mesh.face_count(); ++f) {
            const int first = mesh.faces.first_corner(f);
            for (int i = 1; i + 1 < mesh.faces.degree(f); ++i)
                raster.triangle({place(first), place(first + i), place(first + i + 1)}, colour_of_mu(abs_mu[f]));
        }
        return raster.bmp();
    } catch (const Error&) {  // no mesh, or one without a picture
        return {};
    }
}

std::string batch_page(const std::string& title, const std::vector<BatchOutcome>& outcomes, std::size_t jobs) {
    std::size_t failed = 0;
    for (const BatchOutcome& outcome : outcomes) failed += outcome.done() ? 0 : 1;
    std::string page = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title><style>{1}</style></head>\n"
        "<body><h1>{0}</h1><p>{2} of {3} jobs finished, {4} failed. Pictures: the image of the map by |μ|, from 0 "
        "(dark) "
        "to {5} (yellow), flipped faces red. A click on a head sorts.</p>\n<table><thead><tr><th></th><th>job</th>"
        "<th>status</th><th>seconds</th>",
        escaped(title), kBatchStyle, outcomes.size(), jobs, failed, kMostMu);
    for (const auto& [name, head] : number_columns()) page += fmt::format("<th>{}</th>", head);
    page += "<th>message</th></tr></thead><tbody>\n";
    for (const BatchOutcome& outcome : outcomes) page += row_of(outcome);
    return page + "</tbody></table>\n<script>" + kBatchScript + "</script></body></html>\n";
}

}  // namespace beltrami::cli
