#pragma once

#include <beltrami/report/page.h>
#include <beltrami/report/record.h>

#include "command.h"

namespace beltrami::cli {

/// #V×2 positions of a planar map.
Positions positions_of(const Eigen::VectorXcd& map);

/// Renders and writes the page, if one is wanted.
void write_page(const CommonOptions& common, const Mesh& source, std::vector<PageMap> maps,
                const std::vector<Iteration>& history, const Record& record, const std::string& title);

}  // namespace beltrami::cli
