#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/report/page.h>
#include <beltrami/report/page_domain.h>
#include <beltrami/report/record.h>

#include "command.h"

namespace beltrami::cli {

/// #V×2 positions of a planar map.
Positions positions_of(const Eigen::VectorXcd& map);

/// Renders and writes the page, if one is wanted.
/// @param joined of a source that was cut open (PageContent::joined)
void write_page(const CommonOptions& common, const Mesh& source, std::vector<PageMap> maps,
                const std::vector<Iteration>& history, const Record& record, const std::string& title,
                std::vector<int> joined = {});

/// What a page shows of a surface that is carried onto another one.
struct RegistrationPage {
    PageMap map;
    std::optional<PageDomain> domain = {};  ///< of closed surfaces with handles
    std::vector<Iteration> history = {};
};

void write_page(const CommonOptions& common, const Mesh& source, RegistrationPage page, const Record& record,
                const std::string& title);

}  // namespace beltrami::cli
