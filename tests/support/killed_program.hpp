#pragma once
// The ballast program, killed with -9 while it works.

#include <filesystem>
#include <string>
#include <vector>

#include "platform/program.hpp"

namespace ballast {

/// Runs the program and kills it after `seconds`; its children die with it. Returns its exit code,
/// or -1 if it was killed.
inline int run_and_kill(double seconds, const std::vector<std::string>& arguments,
                        const std::filesystem::path& log) {
  const auto program = start_program(BALLAST_PROGRAM, arguments, log);
  return program->ends_within(seconds) ? program->status() : -1;  // its destructor kills
}

}  // namespace ballast
