#pragma once
// What work complains of.

#include <filesystem>
#include <string>

#include "platform/error.hpp"
#include "tests/catch.hpp"

namespace ballast {

/// The text of the exception that `work` throws; "" when it throws none.
template <class Expected = Error, class Work>
std::string complaint(const Work& work) {
  try {
    work();
  } catch (const Expected& error) {
    return error.what();
  }
  return "";
}

/// The same of a file, without its name, with which the one line begins.
template <class Work>
std::string complaint_about(const std::filesystem::path& file, const Work& work) {
  const std::string text = complaint(work), name = file.string() + ": ";
  if (text.empty()) return text;
  CHECK(text.starts_with(name));
  CHECK(text.find('\n') == std::string::npos);
  return text.substr(name.size());
}

}  // namespace ballast
