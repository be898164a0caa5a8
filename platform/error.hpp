#pragma once
// Errors from outside the program: a file, a folder, a disk, another program.

#include <stdexcept>
#include <string>

#include "platform/text.hpp"

namespace ballast {

/// what() begins with the file or program and says what is wrong with it. It is one line: control
/// characters in it are shown as '?'.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what) : std::runtime_error(one_line(what, '?')) {}
};

/// The message for JSON of ours that is not as we write it, in place of the library's words.
inline constexpr const char* broken_json =
    "a name or a bracket is missing, or a value is of another kind";

/// Exit codes of the ballast program.
enum class ExitCode { ok = 0, failure = 1, usage = 2, time_limit = 3, backend_missing = 4 };

}  // namespace ballast
