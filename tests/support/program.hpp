#pragma once
// The ballast program as a child of a test.

#include <algorithm>
#include <string>
#include <vector>

#include "experiments/run/run.hpp"
#include "platform/program.hpp"
#include "tests/catch.hpp"

namespace ballast {

inline ProgramResult ballast_program(const std::vector<std::string>& arguments) {
  return run_program(BALLAST_PROGRAM, arguments, 120.0);
}

/// The same after the words of a shell: limits, redirections. `words` ends with the call of "$@".
inline ProgramResult ballast_in_shell(const std::string& words,
                                      std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"-c", words, "sh", BALLAST_PROGRAM});
  return run_program("/bin/sh", arguments, 120.0);
}

/// Checks a failure: the program ended with this exit code and wrote one line to standard error,
/// which names all of `named`.
inline void check_failure(const ProgramResult& result, ExitCode code,
                          const std::vector<std::string>& named) {
  CHECK_FALSE(result.timed_out);
  CHECK(result.status == static_cast<int>(code));
  CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
  CHECK_THAT(result.errors, Catch::StartsWith("ballast: ") && Catch::EndsWith("\n"));
  for (const std::string& part : named) CHECK_THAT(result.errors, Catch::Contains(part));
}

}  // namespace ballast
