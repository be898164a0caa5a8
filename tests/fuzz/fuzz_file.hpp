#pragma once
// What every fuzz target does: bytes become a file, a reader of ours reads it, and whatever the
// bytes are, the reader returns or refuses in one line that begins with the file's name.

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

/// Where inputs lie as files (scripts/fuzz.sh: in memory). Removed at exit.
inline const TemporaryFolder& input_folder() {
  static const TemporaryFolder folder;
  return folder;
}

/// A finding that no sanitizer sees: stops the fuzzer, which keeps the input.
[[noreturn]] inline void finding(const std::string& what) {
  std::fprintf(stderr, "ballast fuzz: %s\n", what.c_str());
  abort();
}

/// read(), which may refuse `file` in one line that names it. Every other exception ends the
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
    // of a file that is well formed: it names the array and the entry
  }
}

}  // namespace ballast::fuzz
