#pragma once
// Common to all fuzz targets: bytes become a file, and one of our readers reads it. Whatever the
// bytes are, the reader returns or refuses them in one line that names the file.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include "platform/error.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "tests/support/temporary_folder.hpp"

/// Called by libFuzzer (clang's -fsanitize=fuzzer) for one input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace ballast::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The folder for the input files (scripts/fuzz.sh puts it into memory). Removed at exit.
inline const TemporaryFolder& input_folder() {
  static const TemporaryFolder folder;
  return folder;
}

/// Reports a fault that no sanitizer sees: stops the fuzzer, which keeps the input.
[[noreturn]] inline void finding(const std::string& what) {
  std::fprintf(stderr, "ballast fuzz: %s\n", what.c_str());
  abort();
}

/// Calls read(), which may refuse `file` in one line that names it. Any other exception ends the
/// fuzzer.
template <typename Read>
void refused_or(const std::filesystem::path& file, Read&& read) {
  try {
    read();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.find(file.string()) == std::string::npos) finding("names no file: " + message);
    if (message.find_first_of("\r\n") != std::string::npos) finding("more than a line: " + message);
  } catch (const InvalidProblem&) {
    // The file is well formed, but not its problem: the message names the array and the entry.
  }
}

}  // namespace ballast::fuzz
