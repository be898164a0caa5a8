#pragma once
// The page of a comparison, compare.html; what it shares with the page of a closed loop; and the
// comparison in a few lines for a terminal.

#include <filesystem>
#include <span>
#include <string>

#include "experiments/compare/compare_row.hpp"
#include "experiments/measure/run_data.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Reads manifest.json of `folder`; writes compare.html there. Throws Error.
void write_compare_page(const std::filesystem::path& folder, std::span<const CompareRow> rows);

/// The table of backends as text for a terminal.
std::string compare_summary(std::span<const CompareRow> rows);

/// What the comparison's page is given so that it answers in the reader's browser
/// (experiments/compare/answers): all rows, their histories, the command that makes a row again.
/// Of at least one row.
page::Answers comparison_answers(const RunData& data, std::span<const CompareRow> rows);

/// manifest.json of a folder. Throws Error: missing, no JSON object.
RunData read_origin(const std::filesystem::path& folder);

/// Says on `page` which program and machine made it, draws its figures into figures/ beside `file`,
/// and writes it there as HTML. Throws Error.
void write_with_origin(page::Page page, const RunData& data, const std::filesystem::path& file);

}  // namespace ballast
