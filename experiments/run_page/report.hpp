#pragma once
// The page of a run: its numbers beside their bounds and the paper's values, figures, provenance.
// One HTML file that opens offline.

#include <filesystem>
#include <string>

#include "experiments/measure/run_data.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Reads the record and manifest.json of `folder`; writes figures/*.svg and report.html, each whole
/// or not at all. Without gnuplot the page says so and has the tables alone. Throws Error when
/// there is no record.
void write_report(const std::filesystem::path& folder);

/// Accuracy, jammed state, energy, and for the vibrated box what the paper says: every number with
/// its unit, and the bound or the paper's value where there is one.
page::Table results_table(const RunSummary& summary);
/// One row per whole period of the load; no rows when there is none.
page::Table periods_table(const RunSummary& summary);

/// Program, machine and dates of a run or a comparison.
page::Table provenance_table(const RunData& data);
/// One line for the head of the page: program, machine, date; empty when the manifest says nothing.
std::string made_by(const RunData& data);
/// Commands that make the run again, as text for a shell in any folder.
std::string reproduce_commands(const RunData& data);
/// Commands for next steps with the program, as text for a shell in any folder: another run, a
/// figure of the paper, a plan, a comparison of solvers. `has_grains`: the run is a vibrated box's.
std::string next_commands(bool has_grains);

}  // namespace ballast
