#pragma once
// The report of a reproduction: README.md, paper.html (opens offline), figures/*.svg and *.pdf,
// data/*.csv.

#include <filesystem>

#include "experiments/paper/sections.hpp"

namespace ballast {

/// Writes the report of these sections into `folder`, each file beside and renamed. What gnuplot
/// cannot draw becomes a note. Throws Error.
void write_paper_report(PaperData& data, std::vector<PaperSection> sections,
                        const std::filesystem::path& folder);

/// What the finished runs were made by: programs, machines, steps, wall clock; one sentence each.
std::vector<std::string> origin_of(const PaperData& data);

std::string markdown_of(const std::vector<PaperSection>& sections,
                        const std::vector<std::string>& origin);
std::string html_of(const std::vector<PaperSection>& sections,
                    const std::vector<std::string>& origin,
                    const std::vector<std::string>& pictures);

}  // namespace ballast
