#pragma once
// A program run as a child, without a shell.

#include <string>
#include <vector>

namespace ballast {

struct ProgramResult {
  bool was_found = true;   ///< the program is on PATH
  bool timed_out = false;  ///< and was killed
  int status = 0;          ///< exit code; 128 + signal when a signal ended it
  std::string output;      ///< standard output
  std::string errors;      ///< standard error
  bool succeeded() const { return was_found && !timed_out && status == 0; }
};

/// Runs program (looked up on PATH) with arguments, standard input empty, in the C locale and
/// without the variables GNUPLOT* and GNUTERM; kills it after `seconds`, or when it has written
/// more than 256 MB. Throws Error when there can be no child at all.
ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments,
                        double seconds);

}  // namespace ballast
