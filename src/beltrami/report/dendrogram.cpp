#include <beltrami/report/dendrogram.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace beltrami {

namespace {

constexpr double kCell = 56, kTree = 220, kMargin = 16, kLetter = 7.2, kFont = 12;

/// A text for XML.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else
            result += c;
    }
    return result;
}

/// From white (0) to blue (1).
std::string colour(double part) {
    const auto mix = [&](int to) { return static_cast<int>(std::lround(255 + part * (to - 255))); };
    return fmt::format("rgb({},{},{})", mix(38), mix(99), mix(168));
}

}  // namespace

std::vector<int> cluster_order(const std::vector<Merge>& merges) {
    const int n = static_cast<int>(merges.size()) + 1;
    std::vector<std::vector<int>> members(n);
    for (int i = 0; i < n; ++i) members[i] = {i};
    for (const Merge& merge : merges) {
        std::vector<int> both = members[merge.a];
        both.insert(both.end(), members[merge.b].begin(), members[merge.b].end());
        members.push_back(std::move(both));
    }
    return members.back();
}

std::string render_dendrogram(const std::vector<std::string>& names, const Eigen::MatrixXd& distances,
                              const std::vector<Merge>& merges) {
    const std::vector<int> order = cluster_order(merges);
    const int n = static_cast<int>(order.size());
    std::size_t longest = 0;
    for (const std::string& name : names) longest = std::max(longest, name.size());
    const double label = kLetter * static_cast<double>(longest) + 12;
    const double top = kMargin, tree = kMargin + label, matrix = tree + kTree + 12;
    const double width = matrix + n * kCell + kMargin, height = top + n * kCell + 40;
    const double most = std::max(distances.maxCoeff(), 1e-300);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\" "
        "font-family=\"sans-serif\" font-size=\"{2}\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        width, height, kFont);
    const auto row = [&](int place) { return top + (place + 0.5) * kCell; };
    for (int i = 0; i < n; ++i) {
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", tree - 8,
                           row(i) + 0.35 * kFont, escaped(names[order[i]]));
        for (int j = 0; j < n; ++j) {
            const double d = distances(order[i], order[j]);
            svg += fmt::format(
                "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>"
                "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" fill=\"{}\">{:.3f}</text>\n",
                matrix + j * kCell, top + i * kCell, kCell - 2, kCell - 2, colour(d / most),
                matrix + (j + 0.5) * kCell - 1, row(i) + 0.35 * kFont - 1, d > 0.6 * most ? "white" : "black", d);
        }
    }
    // The tree grows from the names to the right; a join stands at its height.
    const double highest = merges.empty() || !(merges.back().height > 0) ? 1 : merges.back().height;
    const auto at = [&](double h) { return tree + (kTree - 8) * h / highest; };
    struct Node {
        double x, y;
    };
    std::vector<Node> nodes(n);
    for (int i = 0; i < n; ++i) nodes[order[i]] = {at(0), row(i)};
    for (const Merge& merge : merges) {
        const Node a = nodes[merge.a], b = nodes[merge.b];
        const double x = at(merge.height);
        svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}V{:.1f}H{:.1f}\" fill=\"none\" stroke=\"#333\"/>\n", a.x,
                           a.y, x, b.y, b.x);
        nodes.push_back({x, 0.5 * (a.y + b.y)});
    }
    const double axis = top + n * kCell + 8;
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#999\"/>\n", at(0), axis, at(highest));
    for (const double part : {0.0, 0.5, 1.0})
        svg += fmt::format(
            "<path d=\"M{0:.1f} {1:.1f}v4\" stroke=\"#999\"/><text x=\"{0:.1f}\" y=\"{2:.1f}\" text-anchor=\"middle\" "
            "fill=\"#555\">{3:.3g}</text>\n",
            at(part * highest), axis, axis + 6 + kFont, part * highest);
    return svg + "</svg>\n";
}

}  // namespace beltrami
