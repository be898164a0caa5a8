#pragma once
// Where a run came from: its parameters, program and machine, files, and how to make it again.
// Parts of a run's report.

#include <string>

#include "experiments/measure/run_data.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// The scene's title, else its name, else the folder's.
std::string name_of_run(const RunData& data);
/// The scene's parameters and what the run noted in its manifest.
page::Table parameters_table(const RunData& data);
/// Program, machine, dates.
page::Table provenance_table(const RunData& data);
/// What is in the folder.
page::Table files_table(const RunData& data);
/// One line for the head of the page: program, machine, date; empty when the manifest says nothing.
std::string made_by(const RunData& data);
/// Commands that make the run again, as text for a shell in any folder.
std::string reproduce_commands(const RunData& data);

/// What to do next with the program, as text for a shell in any folder: another run, a figure of
/// the paper, a plan, a comparison of solvers. `has_grains`: of a vibrated box.
std::string next_commands(bool has_grains);

}  // namespace ballast
