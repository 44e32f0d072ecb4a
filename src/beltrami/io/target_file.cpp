#include <beltrami/io/target_file.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/io/read_file.h>

namespace beltrami {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLoopForms =
    R"(a loop is {"circle": [x, y, r]}, {"polygon": [[x, y], ...]} or {"spline": [[x, y], ...]})";

[[noreturn]] void fail(const std::string& file, const std::string& what, const std::string& next_step) {
    throw Error(Cause::bad_option, fmt::format("{}: {}", file, what), next_step);
}

std::vector<Complex> points_of(const Json& list, const std::string& file, const std::string& loop) {
    if (!list.is_array()) fail(file, fmt::format("{} has no list of points", loop), kLoopForms);
    std::vector<Complex> points;
    for (const Json& p : list) {
        if (!p.is_array() || p.size() != 2 || !p[0].is_number() || !p[1].is_number())
            fail(file, fmt::format("point {} of {} is not a pair of numbers", points.size(), loop),
                 "write every point as [x, y]");
        points.emplace_back(p[0].get<double>(), p[1].get<double>());
    }
    return points;
}

TargetCurve curve_of(const Json& value, const std::string& file, const std::string& loop) {
    if (!value.is_object() || value.size() != 1)
        fail(file, fmt::format("{} is not one circle, polygon or spline", loop), kLoopForms);
    const std::string& kind = value.begin().key();
    const Json& data = value.begin().value();
    std::vector<double> circle;
    std::vector<Complex> points;
    if (kind == "circle") {
        for (const Json& number : data)
            if (number.is_number()) circle.push_back(number.get<double>());
        if (!data.is_array() || data.size() != 3 || circle.size() != 3)
            fail(file, fmt::format("the circle of {} is not three numbers", loop), "write it as [x, y, r]");
    } else if (kind == "polygon" || kind == "spline") {
        points = points_of(data, file, loop);
    } else {
        fail(file, fmt::format("{} is a \"{:.40}\", which is not known", loop, kind), kLoopForms);
    }
    try {
        if (kind == "circle") return TargetCurve::circle({circle[0], circle[1]}, circle[2]);
        return kind == "polygon" ? TargetCurve::polygon(points) : TargetCurve::spline(points);
    } catch (const Error& error) {
        throw Error(Cause::bad_option, fmt::format("{}: {}: {}", file, loop, error.what()), "", error.where());
    }
}

Json json_of(const TargetCurve& curve) {
    if (curve.kind() == TargetCurve::Kind::circle)
        return {{"circle", {curve.centre().real(), curve.centre().imag(), curve.radius()}}};
    Json list = Json::array();
    for (const Complex p : curve.points()) list.push_back({p.real(), p.imag()});
    return {{curve.kind() == TargetCurve::Kind::polygon ? "polygon" : "spline", std::move(list)}};
}

}  // namespace

TargetDomain parse_target_domain(std::string_view text, const std::string& name) {
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: …": from the place on.
        std::string reason = error.what();
        if (const auto at = reason.find("] "); at != std::string::npos) reason.erase(0, at + 2);
        throw Error(Cause::unreadable, fmt::format("cannot read {}: {}", name, reason), "give a JSON file");
    }
    if (!json.is_object() || !json.contains("outer"))
        fail(name, "there is no outer loop",
             R"(write {"outer": LOOP, "holes": [LOOP, ...]}; )" + std::string(kLoopForms));
    for (const auto& [key, value] : json.items())
        if (key != "outer" && key != "holes")
            fail(name, fmt::format("\"{:.40}\" is not known", key), "a domain has \"outer\" and \"holes\"");
    const TargetCurve outer = curve_of(json["outer"], name, curve_name(0));
    std::vector<TargetCurve> holes;
    if (json.contains("holes")) {
        if (!json["holes"].is_array()) fail(name, "\"holes\" is not a list", "write \"holes\": [LOOP, ...]");
        for (const Json& hole : json["holes"])
            holes.push_back(curve_of(hole, name, curve_name(static_cast<int>(holes.size()) + 1)));
    }
    try {
        return target_domain(outer, std::move(holes));
    } catch (const Error& error) {
        throw Error(error.cause(), fmt::format("{}: {}", name, error.what()), "", error.where());
    }
}

std::string format_target_domain(const TargetDomain& domain) {
    Json json;
    json["outer"] = json_of(domain.outer);
    json["holes"] = Json::array();
    for (const TargetCurve& hole : domain.holes) json["holes"].push_back(json_of(hole));
    return json.dump() + "\n";
}

TargetDomain read_target_domain(const std::filesystem::path& path) {
    return parse_target_domain(read_file(path), path.string());
}

void write_target_domain(const std::filesystem::path& path, const TargetDomain& domain) {
    write_atomically(path, format_target_domain(domain));
}

}  // namespace beltrami
