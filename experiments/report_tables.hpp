#pragma once
// The tables of a run's report: every number with its unit, and the bound or the paper's value where there is one.

#include "experiments/html_page.hpp"
#include "experiments/run_data.hpp"
#include "experiments/run_summary.hpp"

namespace ballast {

/// Accuracy, jammed state, energy, and for the vibrated box what the paper says.
Html results_table(const RunData& data, const RunSummary& summary);
/// One row per whole period of the load; empty when there is none.
Html periods_table(const RunSummary& summary);
Html cost_table(const RunSummary& summary);
Html energy_table(const RunSummary& summary);
/// The scene's parameters and what the run noted in its manifest.
Html parameters_table(const RunData& data);
/// Program, machine, dates.
Html provenance_table(const RunData& data);
/// What is in the folder.
Html files_table(const RunData& data);
/// One line for the head of the page: program, machine, date; empty when the manifest says nothing.
std::string made_by(const RunData& data);
/// Commands that make the run again, as text for a shell.
std::string reproduce_commands(const RunData& data);

/// A word as a shell reads it back.
std::string shell_word(const std::string& word);

}  // namespace ballast
