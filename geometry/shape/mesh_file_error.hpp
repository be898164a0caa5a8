#pragma once
// The error of a mesh file that cannot be read.

#include "platform/error.hpp"

namespace ballast {

/// what() is one line: the file's name, the line or the face, and the defect.
class MeshFileError : public Error {
 public:
  using Error::Error;
};

}  // namespace ballast
