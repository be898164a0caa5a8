#pragma once
// The tables of a run's report: every number with its unit, and the bound or the paper's value
// where there is one.

#include "experiments/measure/run_data.hpp"
#include "experiments/measure/run_summary.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Accuracy, jammed state, energy, and for the vibrated box what the paper says.
page::Table results_table(const RunSummary& summary);
/// One row per whole period of the load; no rows when there is none.
page::Table periods_table(const RunSummary& summary);
page::Table cost_table(const RunSummary& summary);
page::Table energy_table(const RunSummary& summary);

}  // namespace ballast
