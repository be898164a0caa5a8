#pragma once
// The article about the reproduction: prose (article.md, built into the program) in Pandoc's
// Markdown. {{name.key}} in it stands for a number of the report, the value `key` of its figure,
// claim or finding `name`; figures/NAME.svg stands for one of the report's figures.

#include "experiments/paper/sections.hpp"

namespace ballast {

/// `prose` with every number put in. Throws Error naming the first one that there is not.
std::string article_of(std::string_view prose, const page::Values& numbers);

/// The article with the numbers of the whole report.
std::string article_of(const std::vector<PaperSection>& sections);

/// Writes article.md and the figures that it shows into `folder`, and by Pandoc and XeLaTeX
/// article.html and article.pdf. Says on `notes` what is missing for them. Throws Error.
ExitCode write_article(PaperData& data, const std::filesystem::path& folder, std::ostream& notes);

}  // namespace ballast
