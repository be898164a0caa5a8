#pragma once
// What every fuzz target does: bytes become a file, a reader of ours reads it, and whatever the
// bytes are, the reader returns or refuses in one line that begins with the file's name.

#include <stdlib.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "platform/error.hpp"
#include "problems/algebra/friction_problem.hpp"

/// Called by libFuzzer (clang's -fsanitize=fuzzer) for one input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace ballast::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Where inputs lie as files: in memory where the system has such a folder. Removed at exit.
class InputFolder {
 public:
  InputFolder() {
    const bool has_memory = std::filesystem::is_directory("/dev/shm");
    std::string name = has_memory ? "/dev/shm" : std::filesystem::temp_directory_path().string();
    name += "/ballast_fuzz_XXXXXX";
    if (!mkdtemp(name.data())) abort();
    path_ = name;
  }
  ~InputFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline const InputFolder& input_folder() {
  static const InputFolder folder;
  return folder;
}

/// A finding that no sanitizer sees: stops the fuzzer, which keeps the input.
[[noreturn]] inline void finding(const std::string& what) {
  std::fprintf(stderr, "ballast fuzz: %s\n", what.c_str());
  abort();
}

/// A refusal is one line, and says which file.
inline void check_refusal(const std::string& message, std::string_view named) {
  if (message.find(named) == std::string::npos) finding("names no file: " + message);
  if (message.find_first_of("\r\n") != std::string::npos) finding("more than a line: " + message);
}

/// read(), which may refuse `file`. Every other exception ends the fuzzer.
template <typename Read>
void refused_or(const std::filesystem::path& file, Read&& read) {
  try {
    read();
  } catch (const Error& error) {
    check_refusal(error.what(), file.string());
  } catch (const InvalidProblem&) {
    // of a file that is well formed: it names the array and the entry
  }
}

}  // namespace ballast::fuzz
