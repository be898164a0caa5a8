#pragma once
// Sets an environment variable during its lifetime.

#include <stdlib.h>

#include <optional>
#include <string>

namespace ballast {

class EnvironmentGuard {
 public:
  EnvironmentGuard(std::string name, const std::string& value) : name_(std::move(name)) {
    if (const char* before = getenv(name_.c_str())) before_ = before;
    setenv(name_.c_str(), value.c_str(), 1);
  }
  ~EnvironmentGuard() {
    if (before_)
      setenv(name_.c_str(), before_->c_str(), 1);
    else
      unsetenv(name_.c_str());
  }
  EnvironmentGuard(const EnvironmentGuard&) = delete;
  EnvironmentGuard& operator=(const EnvironmentGuard&) = delete;

 private:
  std::string name_;
  std::optional<std::string> before_;
};

}  // namespace ballast
