#include "page.h"

#include <beltrami/io/atomic_file.h>
#include <beltrami/io/read_file.h>
#include <beltrami/report/record_json.h>

namespace beltrami::cli {

Positions positions_of(const Eigen::VectorXcd& map) {
    Positions positions(map.size(), 2);
    positions.col(0) = map.real();
    positions.col(1) = map.imag();
    return positions;
}

void write_page(const CommonOptions& common, const Mesh& source, std::vector<PageMap> maps,
                const std::vector<Iteration>& history, const Record& record, const std::string& title,
                std::vector<int> joined) {
    if (common.report.empty()) return;
    PageContent content{source, std::move(maps), {}, {}, {}, to_json(record), title, std::move(joined)};
    if (!common.texture.empty()) content.texture = read_file(common.texture);
    for (const Iteration& iteration : history) {
        content.history_k.push_back(iteration.k);
        content.history_change.push_back(iteration.change);
        content.history_largest.push_back(iteration.largest);
    }
    write_atomically(common.report, render_page(content));
}

void write_page(const CommonOptions& common, const Mesh& source, RegistrationPage page, const Record& record,
                const std::string& title) {
    if (common.report.empty()) return;
    if (!page.domain) return write_page(common, source, {std::move(page.map)}, page.history, record, title);
    PageDomain& domain = *page.domain;
    page.map.map = domain.at_copies(page.map.map);
    if (page.map.differential) page.map.differential = domain.at_copies(std::move(*page.map.differential), source);
    PageMap polygon{"fundamental polygon", std::move(domain.layout), {}};
    polygon.of_source = true;
    polygon.outline = std::move(domain.outline);
    write_page(common, domain.mesh, {std::move(page.map), std::move(polygon)}, page.history, record, title,
               std::move(domain.joined));
}

}  // namespace beltrami::cli
