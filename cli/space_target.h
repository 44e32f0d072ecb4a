#pragma once

#include <memory>
#include <string>

#include <beltrami/targets/target.h>

namespace beltrami::cli {

/// Whether TARGET is the name of a surface, not a file.
bool names_surface(const std::string& target);

/// The surface: sphere, plane, torus:R,r, modified-torus:1, modified-torus:2, ellipsoid:a,b,c, cylinder:r,h.
/// @pre names_surface(target)
/// @throw Error bad_option
std::unique_ptr<Target> named_surface(const std::string& target);

/// How they are written, for --help.
extern const char* const kNamedSurfaces;

}  // namespace beltrami::cli
