#pragma once
// The report of a reproduction: README.md, paper.html (opens offline), figures/*.svg,
// data/*.csv.

#include "experiments/paper/sections.hpp"

namespace ballast {

/// Writes the report of these sections into `folder`, each file beside and renamed. What gnuplot
/// cannot draw becomes a notice. Throws Error.
void write_paper_report(PaperData& data, const std::vector<PaperSection>& sections,
                        const std::filesystem::path& folder);

/// The page that both files are written from; its figures are not drawn yet. `origin`: what the
/// runs were made by, one sentence each.
page::Page paper_page(const std::vector<PaperSection>& sections,
                      const std::vector<page::Text>& origin);

}  // namespace ballast
