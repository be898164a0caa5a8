#pragma once
// The captured standard error of this process.

#include <unistd.h>

#include <cstdio>

namespace ballast {

/// Captures standard error during its lifetime.
class CapturedErrors {
 public:
  CapturedErrors() : file_(std::tmpfile()), saved_(dup(STDERR_FILENO)) {
    dup2(fileno(file_), STDERR_FILENO);
  }
  ~CapturedErrors() {
    std::fflush(stderr);
    dup2(saved_, STDERR_FILENO);
    close(saved_);
    std::fclose(file_);
  }
  /// The number of bytes captured so far.
  long bytes() const {
    std::fflush(stderr);
    return static_cast<long>(lseek(fileno(file_), 0, SEEK_END));
  }

 private:
  std::FILE* file_;
  int saved_;
};

}  // namespace ballast
