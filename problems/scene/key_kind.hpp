#pragma once
// The types that a key of a scene file can have: how it is read from a table, and what docs say of
// its unit, its default and what is expected.

#include <optional>
#include <string>
#include <vector>

#include "problems/scene/toml_reader.hpp"

namespace ballast {

// `read` throws SceneFileError when the key is absent and there is no fallback, of another type or
// out of range.

struct NumberKind {
  using Value = double;
  NumberRange range;
  const char* unit = "";  ///< as messages write it, "kg/m^3"; empty: a pure number
  double read(TomlTable& table, const char* key, std::optional<double> fallback) const;
  std::string default_text(double value) const;
  std::string expected() const { return range.words; }
};

struct WholeKind {
  using Value = int;
  static constexpr const char* unit = "";
  static constexpr int no_limit = 1'000'000'000;
  int low = 1, high = no_limit;
  int read(TomlTable& table, const char* key, std::optional<int> fallback) const;
  std::string default_text(int value) const { return std::to_string(value); }
  std::string expected() const;
};

struct SeedKind {
  using Value = std::uint64_t;
  static constexpr const char* unit = "";
  Value read(TomlTable& table, const char* key, std::optional<Value> fallback) const;
  std::string default_text(Value value) const { return std::to_string(value); }
  std::string expected() const { return "a whole number >= 0"; }
};

struct FlagKind {
  using Value = bool;
  static constexpr const char* unit = "";
  bool read(TomlTable& table, const char* key, std::optional<bool> fallback) const;
  std::string default_text(bool value) const { return value ? "true" : "false"; }
  std::string expected() const { return "true or false"; }
};

struct TextKind {
  using Value = std::string;
  static constexpr const char* unit = "";
  std::string read(TomlTable& table, const char* key, std::optional<Value> fallback) const;
  std::string default_text(const std::string& value) const { return '"' + value + '"'; }
  std::string expected() const { return "a text"; }
};

struct ChoiceKind {
  using Value = std::string;
  static constexpr const char* unit = "";
  std::vector<const char*> words;
  std::string read(TomlTable& table, const char* key, std::optional<Value> fallback) const;
  std::string default_text(const std::string& value) const { return '"' + value + '"'; }
  std::string expected() const;
};

struct VectorKind {
  using Value = Vec3;
  const char* unit = "";
  Vec3 read(TomlTable& table, const char* key, std::optional<Vec3> fallback) const;
  std::string default_text(const Vec3& value) const;
  std::string expected() const { return "three finite numbers"; }
};

/// A list, always optional: absent it is empty.
struct TextsKind {
  using Value = std::vector<std::string>;
  static constexpr const char* unit = "";
  Value read(TomlTable& table, const char* key, std::optional<Value> fallback) const;
  std::string default_text(const Value&) const { return "[]"; }
  std::string expected() const { return "a list of texts"; }
};

}  // namespace ballast
