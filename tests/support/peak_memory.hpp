#pragma once

#include <fstream>
#include <functional>
#include <string>

#include "platform/program.hpp"
#include "tests/catch.hpp"

namespace ballast {

/// A number of /proc/self/status, such as "VmRSS:" [kB].
inline long memory_entry(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word && word != name) {
  }
  long kilobytes = 0;
  status >> kilobytes;
  return kilobytes;
}

/// By how many kB `work` raises the resident memory of a process of its own, at its peak.
/// Sanitizers keep what is freed: 0 under them.
inline long peak_memory(const std::function<void()>& work) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  work();
  return 0;
#endif
  const ChildResult child = run_in_child(1e9, [&] {
    const long before = memory_entry("VmRSS:");
    work();
    return std::to_string(memory_entry("VmHWM:") - before);
  });
  REQUIRE(child.end == ChildEnd::complete);
  return std::stol(child.answer);
}

}  // namespace ballast
