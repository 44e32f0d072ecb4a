// Solves the gallery's figures, writes their data and their sections of the page.
//
//     gallery DATA_FOLDER PAGE [FIGURE...]        default: all figures
//
// Sections of figures that are not named stay as they are. draw.py draws the pictures from DATA_FOLDER.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "gallery/gallery.h"

namespace {

using namespace beltrami;
using namespace beltrami::gallery;

constexpr const char* introduction =
    "# Gallery\n\n"
    "Figures of Weber, Myles, Zorin, *Computing extremal quasiconformal maps*, 2012, made again with beltrami by\n"
    "`./run gallery`. Shapes that the paper does not give are made here (`bench/support/problems.h`), so its numbers\n"
    "are for orientation. Colours show |μ|; flipped faces are red. Tables: the estimate of k, the lower bound on K of\n"
    "the extremal map and the estimate of K ([certificate](certificate.md), the bounds of quadratic maps), and the\n"
    "statistics of |μ| over the faces, weighted by area. Iterations: linear solves, Newton steps for the methods that\n"
    "are not linear; seconds on a busy machine, bounds included. A chessboard is that of the source on the image of a\n"
    "planar source, that of the plane on a surface in space. In histograms the last bin holds all that lies "
    "beyond.\n\n";

std::string marker(const std::string& name) {
    return "<!-- " + name + " -->\n";
}

/// The sections of a page by name.
std::map<std::string, std::string> sections_of(const std::string& page) {
    std::map<std::string, std::string> result;
    for (const Entry& entry : figures()) {
        const std::size_t at = page.find(marker(entry.name));
        if (at == std::string::npos) continue;
        const std::size_t end = page.find("<!-- ", at + 1);
        result[entry.name] = page.substr(at, end == std::string::npos ? end : end - at);
    }
    return result;
}

std::string row_of(const std::vector<std::string>& cells) {
    std::string line = "|";
    for (const std::string& cell : cells) line += " " + cell + " |";
    return line + "\n";
}

std::string section(const std::string& name, const Figure& figure) {
    std::string text = marker(name) + "## " + figure.title + "\n\n" + figure.statement + "\n\n";
    for (const Table& table : figure.tables) {
        if (!table.caption.empty()) text += table.caption + ".\n\n";
        text += row_of(table.head) + row_of(std::vector<std::string>(table.head.size(), "---"));
        for (const auto& row : table.rows) text += row_of(row);
        text += "\n";
    }
    for (const std::string& remark : figure.remarks) text += remark + "\n\n";
    for (const Picture& picture : figure.pictures)
        if (!picture.panels.empty())
            text += "![" + picture.caption + "](gallery/" + picture.name + ".png)\n\n" + picture.caption + "\n\n";
    return text;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "gallery DATA_FOLDER PAGE [FIGURE...]\n");
        return 2;
    }
    const std::vector<std::string> wanted(argv + 3, argv + argc);
    for (const std::string& name : wanted)
        if (std::none_of(figures().begin(), figures().end(), [&](const Entry& e) { return e.name == name; })) {
            std::string names;
            for (const Entry& entry : figures()) names += " " + entry.name;
            fmt::print(stderr, "there is no figure {}; there are:{}\n", name, names);
            return 2;
        }
    try {
        std::stringstream old;
        old << std::ifstream(argv[2]).rdbuf();
        auto sections = sections_of(old.str());
        Output output(argv[1]);
        nlohmann::json pictures = nlohmann::json::array();
        for (const Entry& entry : figures()) {
            if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), entry.name) == wanted.end()) continue;
            fmt::print("{}\n", entry.name);
            std::fflush(stdout);
            const Figure figure = entry.make(output);
            if (figure.title.empty()) continue;
            sections[entry.name] = section(entry.name, figure);
            for (const Picture& picture : figure.pictures)
                if (!picture.panels.empty()) pictures.push_back({{"name", picture.name}, {"panels", picture.panels}});
        }
        std::ofstream(output.folder() / "pictures.json") << pictures.dump(1) << "\n";
        std::ofstream page(argv[2]);
        page << introduction;
        for (const Entry& entry : figures())
            if (sections.contains(entry.name)) page << sections[entry.name];
        page.close();
        if (!page) throw Error(Cause::unwritable, std::string("cannot write ") + argv[2]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
