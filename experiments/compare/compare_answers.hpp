#pragma once
// What the comparison's page is given so that it answers in the reader's browser
// (experiments/compare/answers): all rows, their histories, the command that makes a row again.

#include <span>

#include "experiments/compare/compare_row.hpp"
#include "experiments/measure/run_data.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Of at least one row. `limit`: seconds that an unsolved case counts in means.
page::Answers comparison_answers(const RunData& data, std::span<const CompareRow> rows,
                                 double limit);

}  // namespace ballast
