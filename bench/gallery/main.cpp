// Solves the gallery's figures, writes their data and their sections of the pages.
//
//     gallery DATA_FOLDER DOCUMENTATION_FOLDER [FIGURE...]        default: all figures
//
// Sections of figures that are not named stay as they are. draw.py draws the pictures from DATA_FOLDER.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "gallery/gallery.h"

namespace {

using namespace beltrami;
using namespace beltrami::gallery;

std::string marker(const std::string& name) {
    return "<!-- " + name + " -->\n";
}

/// The sections of a page by name.
std::map<std::string, std::string> sections_of(const Page& page, const std::string& text) {
    std::map<std::string, std::string> result;
    for (const Entry& entry : page.figures) {
        const std::size_t at = text.find(marker(entry.name));
        if (at == std::string::npos) continue;
        const std::size_t end = text.find("<!-- ", at + 1);
        result[entry.name] = text.substr(at, end == std::string::npos ? end : end - at);
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
    for (const gallery::Picture& picture : figure.pictures)
        if (!picture.panels.empty())
            text += "![" + picture.caption + "](gallery/" + picture.name + ".png)\n\n" + picture.caption + "\n\n";
    return text;
}

/// Makes the wanted figures of a page; their pictures are added to @p pictures.
void make(const Page& page, const std::filesystem::path& file, const std::vector<std::string>& wanted, Output& output,
          nlohmann::json& pictures) {
    std::stringstream old;
    old << std::ifstream(file).rdbuf();
    auto sections = sections_of(page, old.str());
    // After every figure: what is done stays where a later one fails.
    const auto write = [&] {
        std::ofstream text(file);
        text << page.introduction;
        for (const Entry& entry : page.figures)
            if (sections.contains(entry.name)) text << sections[entry.name];
        text.close();
        if (!text) throw Error(Cause::unwritable, "cannot write " + file.string());
    };
    for (const Entry& entry : page.figures) {
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), entry.name) == wanted.end()) continue;
        fmt::print("{}\n", entry.name);
        std::fflush(stdout);
        const Figure figure = entry.make(output);
        if (figure.title.empty()) continue;
        sections[entry.name] = section(entry.name, figure);
        for (const gallery::Picture& picture : figure.pictures)
            if (!picture.panels.empty()) pictures.push_back({{"name", picture.name}, {"panels", picture.panels}});
        write();
    }
    write();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "gallery DATA_FOLDER DOCUMENTATION_FOLDER [FIGURE...]\n");
        return 2;
    }
    const std::vector<std::string> wanted(argv + 3, argv + argc);
    std::string names;
    std::set<std::string> known;
    for (const Page& page : pages())
        for (const Entry& entry : page.figures) names += " " + entry.name, known.insert(entry.name);
    for (const std::string& name : wanted)
        if (!known.contains(name)) {
            fmt::print(stderr, "there is no figure {}; there are:{}\n", name, names);
            return 2;
        }
    try {
        Output output(argv[1]);
        nlohmann::json pictures = nlohmann::json::array();
        for (const Page& page : pages())
            make(page, std::filesystem::path(argv[2]) / page.file, wanted, output, pictures);
        std::ofstream(output.folder() / "pictures.json") << pictures.dump(1) << "\n";
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
