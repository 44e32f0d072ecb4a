#include "space_target.h"

#include <array>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/targets/implicit_target.h>
#include <beltrami/targets/parametric_target.h>
#include <beltrami/targets/simple_targets.h>

#include "parse.h"

namespace beltrami::cli {

const char* const kNamedSurfaces =
    "sphere, plane, torus:R,r, modified-torus:1, modified-torus:2, ellipsoid:a,b,c or cylinder:r,h";

namespace {

struct Name {
    const char* kind;
    std::size_t numbers;
};
constexpr std::array<Name, 6> kNames{
    {{"sphere", 0}, {"plane", 0}, {"torus", 2}, {"modified-torus", 1}, {"ellipsoid", 3}, {"cylinder", 2}}};

const Name* name_of(const std::string& kind) {
    for (const Name& name : kNames)
        if (kind == name.kind) return &name;
    return nullptr;
}

}  // namespace

bool names_surface(const std::string& target) {
    return name_of(target.substr(0, target.find(':'))) != nullptr;
}

std::unique_ptr<Target> named_surface(const std::string& target) {
    const std::size_t colon = target.find(':');
    const Name& name = *name_of(target.substr(0, colon));
    const auto given = colon == std::string::npos ? std::vector<double>{} : number_list(target.substr(colon + 1));
    if (!given || given->size() != name.numbers)
        throw Error(Cause::bad_option, "--onto " + target + " is no surface",
                    std::string("give ") + kNamedSurfaces + ", or a file");
    const std::vector<double>& n = *given;
    const std::string kind = name.kind;
    if (kind == "sphere") return std::make_unique<SphereTarget>();
    if (kind == "plane") return std::make_unique<PlaneTarget>();
    if (kind == "torus") return std::make_unique<ParametricTarget>(torus_target(n[0], n[1]));
    if (kind == "ellipsoid") return std::make_unique<ImplicitTarget>(ellipsoid_target({n[0], n[1], n[2]}));
    if (kind == "cylinder") return std::make_unique<ParametricTarget>(cylinder_target(n[0], n[1]));
    if (n[0] != 1 && n[0] != 2)
        throw Error(Cause::bad_option, "--onto " + target + ": there are two modified tori", "give 1 or 2");
    return std::make_unique<ParametricTarget>(n[0] == 1 ? first_modified_torus() : second_modified_torus());
}

}  // namespace beltrami::cli
