#pragma once
// The ballast program, killed with -9 in the middle of its work.

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "platform/worker.hpp"

namespace ballast {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

/// Runs the program, and kills it after `seconds`: its children die with it. Its exit code, or -1
/// when it was killed.
inline int run_and_kill(double seconds, const std::vector<std::string>& arguments,
                        const std::filesystem::path& log) {
  Worker program(BALLAST_PROGRAM, arguments, log);
  const auto begin = Clock::now();
  while (!program.has_ended()) {
    if (seconds_since(begin) > seconds) return -1;  // the destructor kills
    usleep(1000);
  }
  return program.status();
}

}  // namespace ballast
