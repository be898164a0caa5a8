#pragma once
// The ballast program, killed with -9 in the middle of its work.

#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "platform/clock.hpp"

#include "platform/program.hpp"

namespace ballast {

/// Runs the program, and kills it after `seconds`: its children die with it. Its exit code, or -1
/// when it was killed.
inline int run_and_kill(double seconds, const std::vector<std::string>& arguments,
                        const std::filesystem::path& log) {
  BackgroundProgram program(BALLAST_PROGRAM, arguments, log);
  const Stopwatch watch;
  while (!program.has_ended()) {
    if (watch.seconds() > seconds) return -1;  // the destructor kills
    usleep(1000);
  }
  return program.status();
}

}  // namespace ballast
