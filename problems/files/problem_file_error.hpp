#pragma once

#include "platform/error.hpp"

namespace ballast {

/// What is wrong with a problem file; what() starts with the file's name and names the group,
/// dataset and entry.
class ProblemFileError : public Error {
 public:
  using Error::Error;
};

/// work(), with every Error of it (a file that cannot be read or written) as a ProblemFileError.
template <typename Work>
auto with_problem_file_errors(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw ProblemFileError(error.what());
  }
}

}  // namespace ballast
