#pragma once
// The page of a comparison, what other pages share with it, and its summary for a terminal.

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_row.hpp"
#include "experiments/measure/run_data.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Reads manifest.json of `folder`; writes compare.html there. Throws Error.
void write_compare_page(const std::filesystem::path& folder, std::span<const CompareRow> rows);

/// The table of backends as text for a terminal.
std::string compare_summary(std::span<const CompareRow> rows);

/// The data and modules of the page's answers (experiments/compare/answers): all rows, their
/// histories, the command that makes a row again. Needs at least one row.
page::Answers comparison_answers(const RunData& data, std::span<const CompareRow> rows);

/// Says on `page` which program and machine made it, as in manifest.json beside `file`, draws its
/// figures into figures/ there, and writes it as HTML. Throws Error, also where the manifest is
/// missing or holds no JSON object.
void write_with_origin(page::Page page, const std::filesystem::path& file);

// Rows -> backends side by side: medians over repeats, means over cases. The page itself computes
// those of the reader's selection (answers/statistics.js).

/// One backend on one case to one tolerance from one start, over its repeats.
struct RepeatedSolve {
  const CompareRow* row = nullptr;  ///< the fastest repeat that solved the case, else the first
  bool solved = true;               ///< in every repeat
  double fastest = 0.0, median = 0.0, slowest = 0.0;  ///< [s]; 0 unless all repeats are solved
};
RepeatedSolve over_repeats(const std::vector<const CompareRow*>& repeats);

/// One backend to one tolerance from one start, over all cases that it tried.
struct BackendSummary {
  std::string solver, law;
  int solved = 0, unsolved = 0, timeouts = 0, crashes = 0, unsupported = 0, no_solutions = 0,
      denied = 0;
  int tried() const { return solved + unsolved; }
  double mean_seconds = not_known;  ///< shifted geometric mean over all cases (summary_shift), in
                                    ///< which an unsolved case counts as the limit [s]
  double mean_ratio = not_known;    ///< the same mean of time over the fastest backend's time, over
                                    ///< cases that some backend solved; NaN: none
  double largest_spread = 0.0;  ///< (slowest - fastest)/median over the repeats of a solved case
};

/// All backends of one start and tolerance.
struct CompareTable {
  std::string heading;  ///< "Tolerance 0.01, cold start"
  StartKind start = StartKind::cold;
  double tolerance = 0.0;
  std::map<std::string, std::map<std::string, RepeatedSolve>> cases;  ///< by name, then by backend
  std::vector<BackendSummary> backends;  ///< most solved first, then fastest
};

/// Shift of the geometric means [s]: the smaller, the more the tiny problems count.
inline constexpr double summary_shift = 1e-3;

/// One table for each start and, loosest first, tolerance of the rows, without unreadable cases.
std::vector<CompareTable> compare_tables(std::span<const CompareRow> rows);

/// Returns how many different backends, cases, ... the rows have.
page::Text different(std::span<const CompareRow> rows, std::string CompareRow::*name);

/// Returns the time that stands for an unsolved case: the largest limit of the rows [s].
double limit_of(std::span<const CompareRow> rows);

}  // namespace ballast
