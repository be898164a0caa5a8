#pragma once
// The report of a reproduction: README.md, paper.html (opens offline), figures/*.svg,
// data/*.csv.

#include <filesystem>

#include "experiments/paper/sections.hpp"

namespace ballast {

/// Writes the report of these sections into `folder`, each file beside and renamed. What gnuplot
/// cannot draw becomes a notice. Throws Error.
void write_paper_report(PaperData& data, const std::vector<PaperSection>& sections,
                        const std::filesystem::path& folder);

/// What the finished runs were made by: programs, machines, steps, wall clock; one sentence each.
std::vector<page::Text> origin_of(PaperData& data);

/// The page that both files are written from; its figures are not drawn yet.
page::Page paper_page(const std::vector<PaperSection>& sections,
                      const std::vector<page::Text>& origin);

}  // namespace ballast
