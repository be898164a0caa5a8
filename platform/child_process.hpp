#pragma once
// Foreign code in a process of its own: what crashes, exits, leaks or cannot be interrupted there
// harms nobody here.

#include <functional>
#include <string>

namespace ballast {

enum class ChildEnd { complete, out_of_time, crashed };

struct ChildResult {
  ChildEnd end = ChildEnd::crashed;
  std::string answer;  ///< the bytes that `work` returned there; empty unless complete
};

/// Runs `work` in a forked child and waits for the bytes that it returns (platform/pack.hpp makes
/// and reads them), at most `max_seconds` of wall clock; then the child is killed. Only an answer
/// that arrived whole counts, whatever the exit code says (Debian's Ipopt can die with code 0). The
/// child prints nowhere, lets no exception out, and dies with its parent; it is always waited for.
/// Throws std::runtime_error when no process can be made.
ChildResult run_in_child(double max_seconds, const std::function<std::string()>& work);

}  // namespace ballast
