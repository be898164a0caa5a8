#pragma once

#include "platform/error.hpp"

namespace ballast {

/// what(): "file: key = value: what is wrong and what was expected".
class SceneFileError : public Error {
 public:
  using Error::Error;
};

}  // namespace ballast
