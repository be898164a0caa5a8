#pragma once

#include "platform/error.hpp"

namespace ballast {

/// What is wrong with a mesh file; what() starts with the file's name and says the line or the
/// face.
class MeshFileError : public Error {
 public:
  using Error::Error;
};

}  // namespace ballast
