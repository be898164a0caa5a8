#pragma once
// Reads a TOML table key by key: checks types and ranges, names file, line, key and value in every
// error, refuses keys that were not asked for, and keeps all values that were read, defaults
// included, as the resolved table.

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// An interval of finite numbers and its words for error messages; NaN and infinity lie in none.
struct NumberRange {
  const char* words;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = false;
  bool high_included = false;
  bool contains(double x) const;
};

inline constexpr NumberRange any_number{"a finite number"};
inline constexpr NumberRange positive{"a number > 0", 0.0};
inline constexpr NumberRange not_negative{"a number >= 0", 0.0,
                                          std::numeric_limits<double>::infinity(), true};
inline constexpr NumberRange zero_to_one{"a number from 0 to 1", 0.0, 1.0, true, true};
inline constexpr NumberRange part_of_one{"a number > 0 and <= 1", 0.0, 1.0, false, true};

/// The requirements on a value besides its type.
struct ValueRule {
  NumberRange range = any_number;  ///< of a number
  std::int64_t low = 0;            ///< of a whole number, included
  std::int64_t high = std::numeric_limits<std::int64_t>::max();
  const char* unit = "";                ///< as messages write it, "kg/m^3"; empty: a pure number
  std::vector<const char*> words = {};  ///< a text must be one of these; none: any text
  size_t columns = 0;                   ///< of a list of rows
};
inline ValueRule in(const NumberRange& range, const char* unit = "") {
  return {.range = range, .unit = unit};
}
inline ValueRule of_unit(const char* unit) { return in(any_number, unit); }
inline ValueRule whole(int low, int high = 1'000'000'000) { return {.low = low, .high = high}; }
inline ValueRule rows_of(size_t columns, const char* unit = "") {
  return {.unit = unit, .columns = columns};
}
inline ValueRule one_of(std::vector<const char*> words) { return {.words = std::move(words)}; }

/// Whether a key must be there.
enum class Presence {
  optional,  ///< absent: the default
  required,
  /// Absent or equal to the default: not in the resolved table. A scene.toml that is older than the
  /// key keeps its bytes, and so its run keeps its key.
  only_where_given
};

/// Rows of numbers, all of one length.
using NumberRows = std::vector<std::vector<double>>;

/// The variable that a value is read into; its type is the one expected in the file.
using ValuePlace = std::variant<double*, int*, std::uint64_t*, bool*, std::string*, Vec3*,
                                std::vector<std::string>*, NumberRows*>;

/// Parses a file and applies overrides "dotted.key=value" (elements of arrays of tables by index:
/// body.0.mass=2). A value is TOML; a bare word is taken as a string, so that a shell needs no
/// quotes within quotes. Throws Error.
toml::table load_toml(const std::filesystem::path& file,
                      std::span<const std::string> overrides = {});
/// load_toml() for a text that has been read.
toml::table parse_toml(const std::string& text, const std::filesystem::path& file,
                       std::span<const std::string> overrides = {});

/// Writes a whole document in canonical form: sorted keys, shortest digits that read back to the
/// same double. The same table gives the same text.
std::string toml_text(const toml::table& table);
/// Writes one value on one line.
std::string toml_value_text(const toml::node& node);

class TomlTable {
 public:
  /// `table` and `resolved` outlive this object. `path`: dotted name of the table, empty for the
  /// root.
  TomlTable(std::string file, const toml::table& table, toml::table& resolved,
            std::string path = "");
  bool has(std::string_view key) const { return table_->contains(key); }
  /// The table as it stands in the file, for keys that the user chooses.
  const toml::table& as_it_stands() const { return *table_; }

  /// Reads a key into `place`, which keeps its value when the key is absent. Throws Error that says
  /// what was expected: missing, of another type, out of range.
  void read(std::string_view key, ValuePlace place, const ValueRule& rule = {},
            Presence presence = Presence::optional);
  /// Read a text, which is required without a fallback, and a list of texts, which may be empty.
  std::string text(std::string_view key, std::optional<std::string> fallback = {});
  std::vector<std::string> texts(std::string_view key);

  TomlTable section(std::string_view key);  ///< absent: an empty table, so that all fallbacks hold
  std::vector<TomlTable> sections(std::string_view key);  ///< an array of tables; absent: empty

  /// Permits a key although nobody reads it: it is offered when another one is misspelt.
  void know(std::string_view key) { known_.emplace(key); }

  /// Sets a value of the resolved table in place of the one read (a path made absolute).
  void replace_resolved(std::string_view key, const toml::node& value);

  /// Throws Error for a key that was not asked for, with the nearest known key.
  void finish() const;

  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

 private:
  const toml::node* find(std::string_view key);
  std::string full_key(std::string_view key) const;
  std::string place_of(const toml::node* node) const;

  std::string file_, path_;
  const toml::table* table_;
  toml::table* resolved_;
  std::set<std::string> known_;
};

}  // namespace ballast
