#pragma once

#include <string>

#include "platform/error.hpp"

namespace ballast {

/// what(): "file: key = value: what is wrong and what was expected", one line: control characters
/// of what is quoted from the file are shown as '?'.
class SceneFileError : public Error {
 public:
  explicit SceneFileError(const std::string& what) : Error(one_line(what)) {}

 private:
  static std::string one_line(std::string text) {
    for (char& c : text)
      if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
    return text;
  }
};

}  // namespace ballast
