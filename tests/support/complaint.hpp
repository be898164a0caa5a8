#pragma once
// The message of the exception that a piece of work throws.

#include <filesystem>
#include <string>

#include "platform/error.hpp"
#include "tests/catch.hpp"

namespace ballast {

/// The text of the exception that `work` throws; "" if it throws none.
template <class Expected = Error, class Work>
std::string complaint(const Work& work) {
  try {
    work();
  } catch (const Expected& error) {
    return error.what();
  }
  return "";
}

/// The same for work on a file, without the file's name, with which the one-line text must begin.
template <class Work>
std::string complaint_about(const std::filesystem::path& file, const Work& work) {
  const std::string text = complaint(work), name = file.string() + ": ";
  if (text.empty()) return text;
  CHECK(text.starts_with(name));
  CHECK(text.find('\n') == std::string::npos);
  return text.substr(name.size());
}

}  // namespace ballast
