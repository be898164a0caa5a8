#pragma once
// What goes wrong outside the program: a file, a folder, a disk, another program.

#include <stdexcept>

namespace ballast {

/// what() is one line that begins with the file or program and says what is wrong with it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace ballast
