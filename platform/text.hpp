#pragma once
// Text out of numbers and lists.

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// What stands between the separators: one more than there are of them.
std::vector<std::string> split(std::string_view text, char separator);

/// Letters and digits of ASCII and `also` alone, at least one.
bool is_plain(std::string_view text, std::string_view also);

/// The number that all of `text` is, without blanks; nothing when it is none.
template <class Number>
std::optional<Number> parsed(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The number that all of `text` is, blanks around it apart; nothing when it is none. "nan" and
/// "inf" are numbers.
std::optional<double> parsed_number(std::string_view text);

/// "59 s", "3 min 05 s", "2 h 10 min"; "?" when it is not known.
std::string duration_text(double seconds);

}  // namespace ballast
