#include "problems/scene/key_kind.hpp"

#include <array>
#include <charconv>

namespace ballast {

double NumberKind::read(TomlTable& table, const char* key, std::optional<double> fallback) const {
  return table.number(key, range, unit, fallback);
}

/// Shortest digits, an exponent without zeros: 2e-4.
std::string NumberKind::default_text(double value) const {
  std::array<char, 32> digits;
  std::string text(digits.data(),
                   std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
  if (const size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
  if (const size_t plus = text.find("e+"); plus != std::string::npos) text.erase(plus + 1, 1);
  return text;
}

int WholeKind::read(TomlTable& table, const char* key, std::optional<int> fallback) const {
  return static_cast<int>(table.whole(key, low, high, fallback));
}

std::string WholeKind::expected() const {
  if (high == no_limit) return "a whole number >= " + std::to_string(low);
  return "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
}

SeedKind::Value SeedKind::read(TomlTable& table, const char* key,
                               std::optional<Value> fallback) const {
  constexpr std::int64_t no_limit = std::numeric_limits<std::int64_t>::max();
  return static_cast<Value>(table.whole(key, 0, no_limit, fallback));
}

bool FlagKind::read(TomlTable& table, const char* key, std::optional<bool> fallback) const {
  return table.flag(key, fallback);
}

std::string TextKind::read(TomlTable& table, const char* key, std::optional<Value> fallback) const {
  return table.text(key, std::move(fallback));
}

std::string ChoiceKind::read(TomlTable& table, const char* key,
                             std::optional<Value> fallback) const {
  return table.choice(key, words, std::move(fallback));
}

std::string ChoiceKind::expected() const {
  std::string text;
  for (const char* word : words)
    text += (text.empty() ? "one of \"" : ", \"") + std::string(word) + '"';
  return text;
}

Vec3 VectorKind::read(TomlTable& table, const char* key, std::optional<Vec3> fallback) const {
  return table.vector(key, unit, fallback);
}

std::string VectorKind::default_text(const Vec3& value) const {
  const NumberKind number{any_number};
  return '[' + number.default_text(value.x()) + ", " + number.default_text(value.y()) + ", " +
         number.default_text(value.z()) + ']';
}

TextsKind::Value TextsKind::read(TomlTable& table, const char* key, std::optional<Value>) const {
  return table.texts(key);
}

}  // namespace ballast
