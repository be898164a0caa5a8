#pragma once
// A mesh as it stands in a file, and the words and numbers that the formats are made of. For
// mesh_file.cpp and the readers of the formats.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/shape/mesh_file_error.hpp"
#include "geometry/shape/pose.hpp"

namespace ballast::raw_mesh {

/// A mesh as it stands in the file: its vertex indices are in range, nothing else is checked. Lines
/// count from 1; in binary files they are 0.
struct RawMesh {
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> faces;
  std::vector<int> vertex_lines, face_lines;
  bool is_single = false;  ///< its numbers are single precision
};

/// A place in a file, for messages "file: line N: defect".
struct Place {
  const std::filesystem::path& file;
  int line = 0;

  [[noreturn]] void fail(const std::string& message) const {
    throw MeshFileError(file.string() + (line > 0 ? ": line " + std::to_string(line) : "") + ": " +
                        message);
  }
};

/// The next word of `text` (blanks separate), taken off its front; empty at the end.
inline std::string_view next_word(std::string_view& text) {
  constexpr std::string_view blanks = " \t\r\n\v\f";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

/// The next line of `text` without its end, taken off its front.
inline std::string_view next_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

/// At most 40 characters of a word, unprintable ones as '?', for quoting in a message.
inline std::string quoted(std::string_view word) {
  std::string result(1, '\'');
  result.append(word.substr(0, 40)).append(word.size() > 40 ? "...'" : "'");
  for (char& c : result)
    if (c < 32 || c > 126) c = '?';
  return result;
}

/// A whole word as a number, in the C locale whatever the program's locale is.
template <class Number>
bool parse(std::string_view word, Number& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

/// A coordinate: a finite number.
inline double parse_coordinate(std::string_view word, const Place& place) {
  double value = 0.0;
  if (word.empty()) place.fail("a coordinate is missing");
  if (!parse(word, value)) place.fail(quoted(word) + " is no number in range");
  if (!std::isfinite(value)) place.fail("coordinate " + quoted(word) + " is not finite");
  return value;
}

}  // namespace ballast::raw_mesh
