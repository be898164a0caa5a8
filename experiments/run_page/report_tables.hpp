#pragma once
// The tables of a run's report: every number with its unit, and the bound or the paper's value
// where there is one.

#include "experiments/measure/run_data.hpp"
#include "experiments/measure/run_summary.hpp"
#include "experiments/page/html_page.hpp"

namespace ballast {

/// Accuracy, jammed state, energy, and for the vibrated box what the paper says.
Html results_table(const RunData& data, const RunSummary& summary);
/// One row per whole period of the load; empty when there is none.
Html periods_table(const RunSummary& summary);
Html cost_table(const RunSummary& summary);
Html energy_table(const RunSummary& summary);

}  // namespace ballast
