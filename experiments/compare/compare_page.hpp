#pragma once
// The page of a comparison, compare.html, with its figures as SVG beside it; what it shares
// with the pages of a site and of a closed loop; and the comparison in a few lines for a terminal.

#include <filesystem>
#include <span>
#include <string>

#include "experiments/compare/compare_table.hpp"
#include "experiments/compare/reference_times.hpp"
#include "experiments/measure/run_data.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Reads manifest.json of `folder`; writes figures/*.svg and compare.html there. Without
/// gnuplot the page has the tables alone and says so. Throws Error.
void write_compare_page(const std::filesystem::path& folder, std::span<const CompareRow> rows,
                        std::span<const ReferenceTimes> reference);

/// The table of backends as text for a terminal, and the ratios to the reference.
std::string compare_summary(std::span<const CompareRow> rows,
                            std::span<const ReferenceTimes> reference);

/// Backends side by side. `of_machines`: of several, whose times are not averaged: ratios alone.
page::Table backends_table(const CompareTable& table, double limit, bool of_machines);

/// What the comparison's page is given so that it answers in the reader's browser
/// (experiments/compare/answers): all rows, their histories, the command that makes a row again.
/// Of at least one row. `limit`: seconds that an unsolved case counts in means.
page::Answers comparison_answers(const RunData& data, std::span<const CompareRow> rows,
                                 double limit);

/// manifest.json of a folder. Throws Error: missing, no JSON object.
RunData read_origin(const std::filesystem::path& folder);

/// Says on `page` which program and machine made it, draws its figures into figures/ beside `file`,
/// and writes it there as HTML. Throws Error.
void write_with_origin(page::Page page, const RunData& data, const std::filesystem::path& file);

}  // namespace ballast
