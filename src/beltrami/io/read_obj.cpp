#include <array>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <beltrami/io/mesh_builder.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/io/read_polygons.h>
#include <beltrami/io/text_scanner.h>

namespace beltrami {

namespace {

class ObjParser {
  public:
    ObjParser(std::string_view bytes, const std::string& name, LargeFaces large_faces)
        : scanner_(bytes, name, TextScanner::Continuation::backslash), name_(name), builder_(name, 3, large_faces) {}

    LoadedMesh parse() {
        while (scanner_.next_line()) {
            const std::string_view keyword = scanner_.word();
            if (keyword == "v") {
                read_vertex();
            } else if (keyword == "vt") {
                read_texture_point();
            } else if (keyword == "f") {
                read_face();
            } else if (keyword == "usemtl" || keyword == "g" || keyword == "o" || keyword == "s") {
                state_[std::string(keyword)] = rest_of_line();
                state_index_ = -1;
            } else if (keyword == "mtllib") {
                builder_.attributes().header.push_back("mtllib " + rest_of_line());
            } else if (!is_letter(keyword.front())) {
                // Statements without use here (vn, l, curv …) all are words; anything else is no OBJ.
                scanner_.fail(fmt::format("{} is not a statement of an OBJ file", in_quotes(keyword)));
            }
        }
        check_forward(forward_vertices_, builder_.vertex_count(), "vertex");
        check_forward(forward_points_, builder_.texture_point_count(), "texture point");
        keep_colours();
        return builder_.finish();
    }

  private:
    /// An index that was larger than its list when it was read. Some files put faces before vertices.
    struct ForwardReference {
        std::int64_t line;
        int index;
    };

    static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

    void read_vertex() {
        std::array<double, 3> point;
        for (double& coordinate : point) coordinate = scanner_.number("a coordinate");
        builder_.add_vertex(point);
        read_colour();
    }

    /// Three numbers behind the coordinates are a colour; one is a weight of rational curves, four are that and a
    /// colour.
    void read_colour() {
        std::array<double, 4> further;
        std::size_t count = 0;
        while (count < further.size() && !scanner_.at_line_end()) {
            const auto value = spelled_number<double>(scanner_.word());
            if (!value) return;
            further[count++] = *value;
        }
        if (count < 3) return;
        colours_.resize(builder_.vertex_count() - 1, {1, 1, 1});  // white where none is given
        colours_.push_back({further[count - 3], further[count - 2], further[count - 1]});
    }

    void keep_colours() {
        if (colours_.empty()) return;
        colours_.resize(builder_.vertex_count(), {1, 1, 1});
        FileAttributes& attributes = builder_.attributes();
        attributes.unit_colours = true;
        constexpr std::array<const char*, 3> names{"red", "green", "blue"};
        for (std::size_t channel = 0; channel < 3; ++channel) {
            FileColumn column{names[channel], NumberType::float64, {}, {}, {}};
            for (const auto& colour : colours_) column.values.push_back(colour[channel]);
            attributes.vertex_columns.push_back(std::move(column));
        }
    }

    std::string rest_of_line() {
        std::string rest;
        while (!scanner_.at_line_end()) rest += (rest.empty() ? "" : " ") + std::string(scanner_.word());
        return rest;
    }

    /// Notes what is in force at the face that is added next.
    void note_state() {
        if (state_.empty()) return;
        FileAttributes& attributes = builder_.attributes();
        if (state_index_ < 0) {
            const auto [known, is_new] =
                state_indices_.try_emplace(state_, static_cast<int>(state_indices_.size()) + 1);
            state_index_ = known->second;
            if (attributes.states.empty()) attributes.states.emplace_back();  // 0: nothing said yet
            if (is_new) attributes.states.push_back(state_);
        }
        attributes.face_states.resize(builder_.face_count(), 0);
        attributes.face_states.push_back(state_index_);
    }

    void read_texture_point() {
        const double u = scanner_.number("a texture coordinate");
        builder_.add_texture_point(u, scanner_.at_line_end() ? 0.0 : scanner_.number("a texture coordinate"));
    }

    void read_face() {
        vertices_.clear();
        points_.clear();
        while (!scanner_.at_line_end()) read_corner(scanner_.word());
        if (vertices_.size() < 3) {
            scanner_.fail(fmt::format("a face names {} corners, it needs at least 3", vertices_.size()));
        }
        note_state();
        builder_.add_face(vertices_, points_, scanner_);
    }

    /// v, v/vt, v//vn or v/vt/vn; a slash with nothing after it is let pass.
    void read_corner(std::string_view corner) {
        std::array<std::string_view, 3> parts;
        std::string_view rest = corner;
        for (std::string_view& part : parts) {
            const std::size_t slash = rest.find('/');
            part = rest.substr(0, slash);
            rest = slash == std::string_view::npos ? std::string_view() : rest.substr(slash + 1);
        }
        const auto vertex = spelled_number<std::int64_t>(parts[0]);
        const auto point = parts[1].empty() ? 0 : spelled_number<std::int64_t>(parts[1]);
        const auto normal = parts[2].empty() ? 0 : spelled_number<std::int64_t>(parts[2]);
        if (!vertex || !point || !normal || !rest.empty()) {
            scanner_.fail(fmt::format("{} is not a corner of a face (v, v/vt, v//vn or v/vt/vn)", in_quotes(corner)));
        }
        vertices_.push_back(resolve(*vertex, builder_.vertex_count(), forward_vertices_, "vertex"));
        points_.push_back(
            parts[1].empty() ? -1 : resolve(*point, builder_.texture_point_count(), forward_points_, "texture point"));
    }

    /// From the file's index (from 1, or from -1 backwards from the last one so far) to one from 0.
    int resolve(std::int64_t index, std::size_t count, std::vector<ForwardReference>& forward, const char* thing) {
        const auto so_far = static_cast<std::int64_t>(count);
        if (index < 0 && index >= -so_far) return static_cast<int>(so_far + index);
        if (index <= 0 || index > std::numeric_limits<int>::max()) {
            scanner_.fail(fmt::format("a face names {} {}, {}", thing, index,
                                      index == 0  ? "but indices count from 1"
                                      : index < 0 ? fmt::format("but only {} came before it", so_far)
                                                  : "which is too large"));
        }
        if (index > so_far) forward.push_back({scanner_.line(), static_cast<int>(index)});
        return static_cast<int>(index - 1);
    }

    void check_forward(const std::vector<ForwardReference>& forward, std::size_t count, const char* thing) const {
        for (const auto& [line, index] : forward) {
            if (static_cast<std::size_t>(index) > count) {
                fail_to_read(fmt::format("{}:{}", name_, line),
                             fmt::format("a face names {} {}, but the file has {}", thing, index, count), line);
            }
        }
    }

    TextScanner scanner_;
    std::string name_;
    MeshBuilder builder_;
    std::vector<int> vertices_;  // of the face being read
    std::vector<int> points_;
    std::vector<ForwardReference> forward_vertices_;
    std::vector<ForwardReference> forward_points_;
    std::vector<std::array<double, 3>> colours_;
    std::map<std::string, std::string> state_;  // statements in force, by keyword
    int state_index_ = -1;                      // of state_ among the attributes' states; -1: not looked up yet
    std::map<std::map<std::string, std::string>, int> state_indices_;
};

}  // namespace

LoadedMesh read_obj(std::string_view bytes, const std::string& name) {
    return read_obj(bytes, name, LargeFaces::cut);
}

LoadedMesh read_obj(std::string_view bytes, const std::string& name, LargeFaces large_faces) {
    return ObjParser(bytes, name, large_faces).parse();
}

}  // namespace beltrami
