#pragma once

#include "platform/error.hpp"

namespace ballast {

/// What is wrong with a problem file; what() starts with the file's name and names the group,
/// dataset and entry.
class ProblemFileError : public Error {
 public:
  using Error::Error;
};

}  // namespace ballast
