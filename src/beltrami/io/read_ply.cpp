#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <beltrami/io/binary_source.h>
#include <beltrami/io/mesh_builder.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/io/read_polygons.h>
#include <beltrami/io/text_scanner.h>

namespace beltrami {

namespace {

using Type = NumberType;

struct Property {
    std::string name;
    Type type;                        // of the value, or of each entry of a list
    std::optional<Type> length_type;  // present: the property is a list
};

struct Element {
    std::string name;
    std::int64_t count;
    std::vector<Property> properties;

    /// Index of the property; nothing if there is none of that kind.
    std::optional<std::size_t> find(std::string_view wanted, bool list = false) const {
        const auto found = std::ranges::find_if(properties, [&](const Property& property) {
            return property.name == wanted && property.length_type.has_value() == list;
        });
        if (found == properties.end()) return std::nullopt;
        return static_cast<std::size_t>(found - properties.begin());
    }
};

enum class Encoding { ascii, little_endian, big_endian };

struct PlyHeader {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    std::vector<std::string> comments;

    const Element* find(std::string_view name) const {
        const auto found = std::ranges::find(elements, name, &Element::name);
        return found == elements.end() ? nullptr : &*found;
    }
};

Type read_type(TextScanner& scanner) {
    struct Name {
        std::string_view name;
        Type type;
    };
    static constexpr std::array<Name, 16> names{{
        {"char", Type::int8},
        {"int8", Type::int8},
        {"uchar", Type::uint8},
        {"uint8", Type::uint8},
        {"short", Type::int16},
        {"int16", Type::int16},
        {"ushort", Type::uint16},
        {"uint16", Type::uint16},
        {"int", Type::int32},
        {"int32", Type::int32},
        {"uint", Type::uint32},
        {"uint32", Type::uint32},
        {"float", Type::float32},
        {"float32", Type::float32},
        {"double", Type::float64},
        {"float64", Type::float64},
    }};
    const std::string_view word = scanner.word();
    const auto found = std::ranges::find(names, word, &Name::name);
    if (found == names.end()) scanner.fail(fmt::format("{} is not a type of a PLY property", in_quotes(word)));
    return found->type;
}

Encoding read_encoding(TextScanner& scanner) {
    const std::string_view word = scanner.word();
    if (word == "ascii") return Encoding::ascii;
    if (word == "binary_little_endian") return Encoding::little_endian;
    if (word == "binary_big_endian") return Encoding::big_endian;
    scanner.fail(fmt::format("{} is not a format of a PLY file", in_quotes(word)));
}

Property read_property(TextScanner& scanner) {
    Property property;
    TextScanner ahead = scanner;
    if (ahead.word() == "list") {
        scanner.word();
        property.length_type = read_type(scanner);
    }
    property.type = read_type(scanner);
    property.name = scanner.word();
    return property;
}

/// Reads up to and with "end_header"; the scanner then stands right behind this word.
PlyHeader read_ply_header(TextScanner& scanner) {
    if (!scanner.next_line() || scanner.word() != "ply") scanner.fail("the file does not begin with 'ply'");
    PlyHeader header;
    bool has_format = false;
    std::set<std::string, std::less<>> names;
    while (scanner.next_line()) {
        const std::string_view keyword = scanner.word();
        if (keyword == "end_header") {
            if (!has_format) scanner.fail("the header names no format");
            return header;
        }
        if (keyword == "format") {
            header.encoding = read_encoding(scanner);
            has_format = true;
        } else if (keyword == "element") {
            const std::string name(scanner.word());
            const std::int64_t count = scanner.integer("the number of elements");
            if (!names.insert(name).second) scanner.fail(fmt::format("element {} is declared twice", in_quotes(name)));
            if (count < 0) scanner.fail(fmt::format("{} elements {} are announced", count, in_quotes(name)));
            header.elements.push_back({name, count, {}});
        } else if (keyword == "property") {
            if (header.elements.empty()) scanner.fail("a property comes before the first element");
            header.elements.back().properties.push_back(read_property(scanner));
        } else if (keyword == "comment" || keyword == "obj_info") {
            std::string line(keyword);
            while (!scanner.at_line_end()) line += fmt::format(" {}", scanner.word());
            header.comments.push_back(std::move(line));
        } else {
            scanner.fail(fmt::format("{} is not a statement of a PLY header", in_quotes(keyword)));
        }
    }
    scanner.fail("the file ends before 'end_header'");
}

/// The body as text: one line an element.
class TextBody {
  public:
    explicit TextBody(const TextScanner& scanner) : scanner_(scanner) {}

    void begin_row() {
        if (!scanner_.next_line()) fail("the file ends before its last element");
    }
    void end_row() {
        if (!scanner_.at_line_end()) fail("the line holds more values than the header says");
    }
    double value(Type) { return scanner_.number("a value"); }
    /// Bytes that values and list lengths take at the very least: a digit and a separator, which the last may lack.
    bool has_room(double values) const { return 2 * values <= static_cast<double>(scanner_.rest().size() + 1); }
    std::string here() const { return scanner_.here(); }
    [[noreturn]] void fail(const std::string& what) const { scanner_.fail(what); }

  private:
    TextScanner scanner_;
};

/// The body as numbers of the declared types.
class BinaryBody {
  public:
    explicit BinaryBody(const BinarySource& source) : source_(source) {}

    void begin_row() {}
    void end_row() {}
    double value(Type type) {
        switch (type) {
            case Type::int8:
                return source_.read<std::int8_t>();
            case Type::uint8:
                return source_.read<std::uint8_t>();
            case Type::int16:
                return source_.read<std::int16_t>();
            case Type::uint16:
                return source_.read<std::uint16_t>();
            case Type::int32:
                return source_.read<std::int32_t>();
            case Type::uint32:
                return source_.read<std::uint32_t>();
            case Type::float32:
                return source_.read<float>();
            case Type::float64:
                return source_.read<double>();
        }
        return 0;
    }
    bool has_room(double values) const { return values <= static_cast<double>(source_.remaining()); }
    std::string here() const { return source_.here(); }
    [[noreturn]] void fail(const std::string& what) const { source_.fail(what); }

  private:
    BinarySource source_;
};

/// One row of an element, by property.
struct Row {
    explicit Row(const Element& element) : scalars(element.properties.size()), lists(element.properties.size()) {}
    std::vector<double> scalars;
    std::vector<std::vector<double>> lists;
};

template <class Body>
void read_row(Body& body, const Element& element, Row& row) {
    body.begin_row();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const Property& property = element.properties[i];
        if (!property.length_type) {
            row.scalars[i] = body.value(property.type);
            continue;
        }
        const double length = body.value(*property.length_type);
        if (!(length >= 0) || length != std::floor(length)) body.fail(fmt::format("a list has {} entries", length));
        row.lists[i].clear();
        const auto count = static_cast<std::uint64_t>(std::min(length, 1e18));
        for (std::uint64_t entry = 0; entry < count; ++entry)  // a false length ends with the data
            row.lists[i].push_back(body.value(property.type));
    }
    body.end_row();
}

/// The properties of an element that are kept as they are, each with its column.
class KeptColumns {
  public:
    /// @param used properties that the mesh is made of
    KeptColumns(const Element& element, const std::set<std::size_t>& used, std::vector<FileColumn>& columns)
        : columns_(columns) {
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const Property& property = element.properties[i];
            if (used.contains(i) || property.name.empty()) continue;
            properties_.push_back(i);
            columns_.push_back({property.name, property.type, property.length_type, {}, {}});
            if (property.length_type) columns_.back().offsets.push_back(0);
        }
    }
    void add(const Row& row) {
        for (std::size_t c = 0; c < properties_.size(); ++c) {
            FileColumn& column = columns_[c];
            if (column.length_type) {
                const std::vector<double>& list = row.lists[properties_[c]];
                column.values.insert(column.values.end(), list.begin(), list.end());
                column.offsets.push_back(static_cast<int>(column.values.size()));
            } else {
                column.values.push_back(row.scalars[properties_[c]]);
            }
        }
    }

  private:
    std::vector<std::size_t> properties_;
    std::vector<FileColumn>& columns_;
};

template <class Body>
void check_count(const Body& body, const Element& element) {
    if (element.count > std::numeric_limits<int>::max()) {
        body.fail(fmt::format("the header announces {} elements {}, too many to be indexed", element.count,
                              in_quotes(element.name)));
    }
    if (!body.has_room(static_cast<double>(element.count) * static_cast<double>(element.properties.size()))) {
        body.fail(fmt::format("the header announces {} elements {}, more than the file can hold", element.count,
                              in_quotes(element.name)));
    }
}

/// The names of the texture coordinates of the vertices, if they have some.
std::optional<std::array<std::string_view, 2>> texture_names(const Element& vertices) {
    constexpr std::array<std::array<std::string_view, 2>, 3> known{
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};
    const auto named = std::ranges::find_if(
        known, [&](const auto& names) { return vertices.find(names[0]) && vertices.find(names[1]); });
    if (named == known.end()) return std::nullopt;
    return *named;
}

template <class Body>
void read_vertices(Body& body, const Element& element, MeshBuilder& builder, int dimension) {
    std::vector<std::size_t> columns{*element.find("x"), *element.find("y")};
    if (dimension == 3) columns.push_back(*element.find("z"));
    const auto named = texture_names(element);
    const bool has_texture = named.has_value();
    if (has_texture) builder.use_texture_per_vertex();
    const std::size_t u = has_texture ? *element.find((*named)[0]) : 0;
    const std::size_t v = has_texture ? *element.find((*named)[1]) : 0;

    builder.reserve_vertices(static_cast<std::size_t>(element.count));
    std::set<std::size_t> used(columns.begin(), columns.end());
    if (has_texture) used.insert({u, v});
    KeptColumns kept(element, used, builder.attributes().vertex_columns);
    Row values(element);
    std::vector<double> point(columns.size());
    for (std::int64_t row = 0; row < element.count; ++row) {
        read_row(body, element, values);
        std::ranges::transform(columns, point.begin(), [&](std::size_t column) { return values.scalars[column]; });
        builder.add_vertex(point);
        if (has_texture) builder.add_texture_point(values.scalars[u], values.scalars[v]);
        kept.add(values);
    }
}

/// Texture points of face corners: those of one vertex with equal numbers are one point.
class CornerPoints {
  public:
    explicit CornerPoints(MeshBuilder& builder) : builder_(builder) {}

    /// @param numbers u and v of every corner
    void of_face(const std::vector<int>& vertices, const std::vector<double>& numbers, std::vector<int>& points) {
        points.clear();
        for (std::size_t c = 0; c < vertices.size(); ++c) {
            const auto [u, v] = std::pair(numbers[2 * c], numbers[2 * c + 1]);
            // NaN is not equal to itself and would break the order of keys.
            const auto key =
                std::tuple(vertices[c], std::bit_cast<std::uint64_t>(u + 0.0), std::bit_cast<std::uint64_t>(v + 0.0));
            const auto [at, is_new] = index_.try_emplace(key, static_cast<int>(builder_.texture_point_count()));
            if (is_new) builder_.add_texture_point(u, v);
            points.push_back(at->second);
        }
    }

  private:
    MeshBuilder& builder_;
    std::map<std::tuple<int, std::uint64_t, std::uint64_t>, int> index_;
};

template <class Body>
void read_faces(Body& body, const Element& element, std::int64_t vertex_count, bool texture_per_vertex,
                MeshBuilder& builder) {
    std::optional<std::size_t> corners = element.find("vertex_indices", true);
    if (!corners) corners = element.find("vertex_index", true);
    if (!corners) body.fail("the faces have no list vertex_indices");
    const std::optional<std::size_t> re = element.find("mu_re"), im = element.find("mu_im");
    std::optional<std::size_t> texture;
    if (!texture_per_vertex) texture = element.find("texcoord", true);
    std::set<std::size_t> used{*corners};
    if (texture) used.insert(*texture);
    KeptColumns kept(element, used, builder.attributes().face_columns);
    CornerPoints corner_points(builder);
    Row values(element);
    std::vector<int> vertices, points;
    for (std::int64_t row = 0; row < element.count; ++row) {
        read_row(body, element, values);
        const std::vector<double>& list = values.lists[*corners];
        if (list.size() < 3) body.fail(fmt::format("a face names {} corners, it needs at least 3", list.size()));
        vertices.clear();
        for (const double index : list) {
            if (!(index >= 0 && index < static_cast<double>(vertex_count)) || index != std::floor(index)) {
                body.fail(
                    fmt::format("a face names vertex {}, but the file has vertices 0 to {}", index, vertex_count - 1));
            }
            vertices.push_back(static_cast<int>(index));
        }
        if (re && im) builder.add_face_mu({values.scalars[*re], values.scalars[*im]});
        points.clear();
        if (texture && !values.lists[*texture].empty()) {
            const std::size_t numbers = values.lists[*texture].size();
            if (numbers != 2 * vertices.size())
                body.fail(fmt::format("a face with {} corners has {} numbers in its list texcoord instead of {}",
                                      vertices.size(), numbers, 2 * vertices.size()));
            corner_points.of_face(vertices, values.lists[*texture], points);
        }
        kept.add(values);
        builder.add_face(vertices, points, body);
    }
}

template <class Body>
LoadedMesh read_body(Body body, const PlyHeader& header, const std::string& name, LargeFaces large_faces) {
    const Element* vertices = header.find("vertex");
    if (!vertices || !vertices->find("x") || !vertices->find("y")) body.fail("the vertices have no properties x and y");
    check_count(body, *vertices);
    const int dimension = vertices->find("z") ? 3 : 2;
    MeshBuilder builder(name, dimension, large_faces);
    builder.attributes().header = header.comments;
    for (const Element& element : header.elements) {
        if (element.properties.empty()) continue;  // takes no bytes, whatever its count
        check_count(body, element);
        if (element.name == "vertex") {
            read_vertices(body, element, builder, dimension);
        } else if (element.name == "face") {
            read_faces(body, element, vertices->count, texture_names(*vertices).has_value(), builder);
        } else {
            Row values(element);
            for (std::int64_t row = 0; row < element.count; ++row) read_row(body, element, values);
        }
    }
    return builder.finish();
}

}  // namespace

LoadedMesh read_ply(std::string_view bytes, const std::string& name) {
    return read_ply(bytes, name, LargeFaces::cut);
}

LoadedMesh read_ply(std::string_view bytes, const std::string& name, LargeFaces large_faces) {
    TextScanner scanner(bytes, name);
    const PlyHeader header = read_ply_header(scanner);
    if (header.encoding == Encoding::ascii) return read_body(TextBody(scanner), header, name, large_faces);

    // Behind "end_header" the first newline belongs to the header. CR LF is one unless the first line ends with CR
    // alone: then the LF may be the first byte of the data. (Some writers end this one line so and all others with LF.)
    std::string_view rest = scanner.rest();
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    const std::string_view first_end = bytes.substr(bytes.find_first_of("\r\n"));
    const bool crlf = rest.starts_with("\r\n") && (first_end.starts_with("\r\n") || first_end.starts_with('\n'));
    const std::size_t offset = bytes.size() - rest.size() + std::min<std::size_t>(crlf ? 2 : 1, rest.size());
    const std::endian order = header.encoding == Encoding::big_endian ? std::endian::big : std::endian::little;
    return read_body(BinaryBody(BinarySource(bytes, offset, order, name)), header, name, large_faces);
}

}  // namespace beltrami
