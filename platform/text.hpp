#pragma once
// Text out of numbers and lists.

#include <optional>
#include <string>
#include <string_view>

namespace ballast {

/// What printf would write, however long.
std::string printed(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// Appends to a list that is written "one, two, three".
void add_to_list(std::string& list, std::string_view item);

/// The words with ", " between them.
template <typename Words>
std::string joined(const Words& words) {
  std::string list;
  bool first = true;
  for (const auto& word : words) {
    if (!first) list += ", ";
    list += word;
    first = false;
  }
  return list;
}

/// The number that all of `text` is, blanks around it apart; nothing when it is none. "nan" and
/// "inf" are numbers.
std::optional<double> parsed_number(std::string_view text);

/// "59 s", "3 min 05 s", "2 h 10 min"; "?" when it is not known.
std::string duration_text(double seconds);

}  // namespace ballast
