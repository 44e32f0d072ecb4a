#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>

#include <beltrami/io/binary_source.h>
#include <beltrami/io/mesh_builder.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/io/text_scanner.h>

namespace beltrami {

namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

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

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;

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
Header read_header(TextScanner& scanner) {
    if (!scanner.next_line() || scanner.word() != "ply") scanner.fail("the file does not begin with 'ply'");
    Header header;
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
        } else if (keyword != "comment" && keyword != "obj_info") {
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

/// Reads one element: scalars[i] becomes the value of property i, list the entries of the list property `wanted`.
template <class Body>
void read_row(Body& body, const Element& element, std::optional<std::size_t> wanted, std::vector<double>& scalars,
              std::vector<double>& list) {
    body.begin_row();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const Property& property = element.properties[i];
        if (!property.length_type) {
            scalars[i] = body.value(property.type);
            continue;
        }
        const double length = body.value(*property.length_type);
        if (!(length >= 0) || length != std::floor(length)) body.fail(fmt::format("a list has {} entries", length));
        if (wanted == i) list.clear();
        const auto count = static_cast<std::uint64_t>(std::min(length, 1e18));
        for (std::uint64_t entry = 0; entry < count; ++entry) {  // a false length ends with the data
            const double value = body.value(property.type);
            if (wanted == i) list.push_back(value);
        }
    }
    body.end_row();
}

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

template <class Body>
void read_vertices(Body& body, const Element& element, MeshBuilder& builder, int dimension) {
    std::vector<std::size_t> columns{*element.find("x"), *element.find("y")};
    if (dimension == 3) columns.push_back(*element.find("z"));
    constexpr std::array<std::array<std::string_view, 2>, 3> texture_names{
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};
    const auto named = std::ranges::find_if(
        texture_names, [&](const auto& names) { return element.find(names[0]) && element.find(names[1]); });
    const bool has_texture = named != texture_names.end();
    if (has_texture) builder.use_texture_per_vertex();
    const std::size_t u = has_texture ? *element.find((*named)[0]) : 0;
    const std::size_t v = has_texture ? *element.find((*named)[1]) : 0;

    builder.reserve_vertices(static_cast<std::size_t>(element.count));
    std::vector<double> values(element.properties.size());
    std::vector<double> point(columns.size());
    std::vector<double> unused;
    for (std::int64_t row = 0; row < element.count; ++row) {
        read_row(body, element, std::nullopt, values, unused);
        std::ranges::transform(columns, point.begin(), [&](std::size_t column) { return values[column]; });
        builder.add_vertex(point);
        if (has_texture) builder.add_texture_point(values[u], values[v]);
    }
}

template <class Body>
void read_faces(Body& body, const Element& element, std::int64_t vertex_count, MeshBuilder& builder) {
    std::optional<std::size_t> corners = element.find("vertex_indices", true);
    if (!corners) corners = element.find("vertex_index", true);
    if (!corners) body.fail("the faces have no list vertex_indices");
    const std::optional<std::size_t> re = element.find("mu_re"), im = element.find("mu_im");
    std::vector<double> values(element.properties.size());
    std::vector<double> list;
    std::vector<int> vertices;
    for (std::int64_t row = 0; row < element.count; ++row) {
        read_row(body, element, corners, values, list);
        if (list.size() < 3) body.fail(fmt::format("a face names {} corners, it needs at least 3", list.size()));
        vertices.clear();
        for (const double index : list) {
            if (!(index >= 0 && index < static_cast<double>(vertex_count)) || index != std::floor(index)) {
                body.fail(
                    fmt::format("a face names vertex {}, but the file has vertices 0 to {}", index, vertex_count - 1));
            }
            vertices.push_back(static_cast<int>(index));
        }
        if (re && im && vertices.size() <= 4) builder.add_face_mu({values[*re], values[*im]});
        builder.add_or_keep_out(vertices, {}, body);
    }
}

template <class Body>
LoadedMesh read_body(Body body, const Header& header, const std::string& name) {
    const Element* vertices = header.find("vertex");
    if (!vertices || !vertices->find("x") || !vertices->find("y")) body.fail("the vertices have no properties x and y");
    check_count(body, *vertices);
    const int dimension = vertices->find("z") ? 3 : 2;
    MeshBuilder builder(name, dimension);
    for (const Element& element : header.elements) {
        if (element.properties.empty()) continue;  // takes no bytes, whatever its count
        check_count(body, element);
        if (element.name == "vertex") {
            read_vertices(body, element, builder, dimension);
        } else if (element.name == "face") {
            read_faces(body, element, vertices->count, builder);
        } else {
            std::vector<double> values(element.properties.size());
            std::vector<double> unused;
            for (std::int64_t row = 0; row < element.count; ++row) {
                read_row(body, element, std::nullopt, values, unused);
            }
        }
    }
    return builder.finish();
}

}  // namespace

LoadedMesh read_ply(std::string_view bytes, const std::string& name) {
    TextScanner scanner(bytes, name);
    const Header header = read_header(scanner);
    if (header.encoding == Encoding::ascii) return read_body(TextBody(scanner), header, name);

    // Behind "end_header" the first newline belongs to the header. CR LF is one only if the first line ends so too:
    // otherwise the LF may be the first byte of the data.
    std::size_t offset = bytes.size() - scanner.rest().size();
    const bool crlf = bytes.substr(bytes.find_first_of("\r\n")).starts_with("\r\n");
    offset += std::min<std::size_t>(crlf ? 2 : 1, scanner.rest().size());
    const std::endian order = header.encoding == Encoding::big_endian ? std::endian::big : std::endian::little;
    return read_body(BinaryBody(BinarySource(bytes, offset, order, name)), header, name);
}

}  // namespace beltrami
