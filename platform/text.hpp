#pragma once
// Text out of numbers and lists.

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ballast {

/// Returns the text that printf would write, however long.
std::string printed(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// Appends to a list that is written "one, two, three".
void add_to_list(std::string& list, std::string_view item);

/// `text` with every control character, line ends included, replaced by `shown`: text that is
/// quoted from a file may hold any.
std::string one_line(std::string_view text, char shown);

/// Every `from` in the text becomes `to`.
void replace_all(std::string& text, std::string_view from, std::string_view to);

/// Levenshtein's distance: the least number of letters to insert, to leave out and to replace.
size_t edit_distance(std::string_view a, std::string_view b);

/// The words with ", " between them.
template <typename Words>
std::string joined(const Words& words) {
  std::string list;
  for (const auto& word : words) list.append(", ").append(word);
  return list.empty() ? list : list.substr(2);
}

/// The name of an enumerator; `names` has one for each, in their order. Otherwise "unknown".
template <class Enum, std::size_t count>
const char* name_in(const char* const (&names)[count], Enum value) {
  const auto place = static_cast<std::size_t>(value);
  return place < count ? names[place] : "unknown";
}

/// The parts between the separators: one more than there are separators.
std::vector<std::string> split(std::string_view text, char separator);

/// True where `text` is not empty and has only ASCII letters, digits and characters of `also`.
bool is_plain(std::string_view text, std::string_view also);
/// The text with _ in place of every other byte.
std::string made_plain(std::string text, std::string_view also);

/// All of `text` as a number, without blanks; nothing when it is none.
template <class Number>
std::optional<Number> parsed(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// ", did you mean "incline"?" for the one of `words` that `word` was probably meant to be: at most
/// two letters, or a third, are missing, too many or different. Empty where none is that near.
template <typename Words>
std::string did_you_mean(std::string_view word, const Words& words) {
  std::string_view nearest;
  size_t least = word.size() / 3 > 2 ? word.size() / 3 + 1 : 3;
  for (const std::string_view candidate : words)
    if (const size_t distance = edit_distance(word, candidate); distance < least) {
      least = distance;
      nearest = candidate;
    }
  return nearest.empty() ? "" : ", did you mean \"" + std::string(nearest) + "\"?";
}

/// All of `text` as a number, without blanks around it; nothing when it is none. "nan" and "inf"
/// are numbers.
std::optional<double> parsed_number(std::string_view text);

/// "59 s", "3 min 05 s", "2 h 10 min"; "?" when it is not known.
std::string duration_text(double seconds);

// Keys of the inputs of a cached result: 64-bit FNV-1a, as 16 hexadecimal digits.

inline std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325ull) {
  for (unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3ull;
  return hash;
}

inline std::string hash_text(std::uint64_t hash) {
  return printed("%016llx", static_cast<unsigned long long>(hash));
}

inline std::string content_key(std::string_view text) { return hash_text(fnv1a(text)); }

}  // namespace ballast
