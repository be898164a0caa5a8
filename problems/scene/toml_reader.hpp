#pragma once
// A TOML table read key by key: types and ranges are checked, every error names file, line, key and
// value, keys that nobody asked for are errors, and what was read, defaults included, is kept as
// the resolved table.

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <limits>
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

/// What is asked of a value besides its type.
struct ValueRule {
  NumberRange range = any_number;  ///< of a number
  std::int64_t low = 0;            ///< of a whole number, included
  std::int64_t high = std::numeric_limits<std::int64_t>::max();
  const char* unit = "";                ///< as messages write it, "kg/m^3"; empty: a pure number
  std::vector<const char*> words = {};  ///< one of which a text must be; none: any text
};

/// Where a value is kept; its type says what stands in the file.
using ValuePlace = std::variant<double*, int*, std::uint64_t*, bool*, std::string*, Vec3*,
                                std::vector<std::string>*>;

/// "a number > 0", "true or false", ...: what is expected, without its unit.
std::string expected_text(ValuePlace place, const ValueRule& rule);
/// What is kept there, as one would write it into a scene: 2e-4, "pgs", [0, 0, 1].
std::string kept_text(ValuePlace place);

/// Parses a file and applies overrides "dotted.key=value" (elements of arrays of tables by index:
/// body.0.mass=2). A value is TOML; a bare word is taken as a string, so that a shell needs no
/// quotes within quotes. Throws SceneFileError.
toml::table load_toml(const std::filesystem::path& file,
                      std::span<const std::string> overrides = {});

/// A whole document written in one way only: sorted keys, shortest digits that read back to the
/// same double. Same table, same text.
std::string toml_text(const toml::table& table);
/// One value on one line; longer than `limit` characters it is cut and ends with "...".
std::string toml_value_text(const toml::node& node, size_t limit = std::string::npos);

class TomlTable {
 public:
  /// `table` and `resolved` outlive this object. `path`: dotted name of the table, empty for the
  /// root.
  TomlTable(std::string file, const toml::table& table, toml::table& resolved,
            std::string path = "");
  TomlTable(TomlTable&&) =
      default;  // not copied: a copy would not know which keys the original was asked for
  TomlTable& operator=(TomlTable&&) = default;

  bool has(std::string_view key) const { return table_->contains(key); }

  /// What is kept in `place` stays when the key is absent, unless it is required. Throws
  /// SceneFileError: missing, of another type, out of range.
  void read(std::string_view key, const ValueRule& rule, bool is_required, ValuePlace place);
  /// A text that must be there, a text, a list of texts that may be empty.
  std::string text(std::string_view key);
  std::string text(std::string_view key, std::string fallback);
  std::vector<std::string> texts(std::string_view key);

  TomlTable section(std::string_view key);  ///< absent: an empty table, so that all fallbacks hold
  std::vector<TomlTable> sections(std::string_view key);  ///< an array of tables; absent: empty

  /// A key that may stand here although nobody reads it: it is offered when another one is
  /// misspelt.
  void know(std::string_view key) { known_.emplace_back(key); }

  /// What the resolved table shall say instead of what was read (a path made absolute).
  void replace_resolved(std::string_view key, const toml::node& value);

  /// The resolved table is to say nothing of a key that was read.
  void leave_unsaid(std::string_view key) { resolved_->erase(key); }

  /// Every key must have been asked for. Throws SceneFileError with the nearest known key.
  void finish() const;

  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

 private:
  const toml::node* find(std::string_view key);
  std::string full_key(std::string_view key) const;
  std::string place_of(const toml::node* node) const;

  std::string file_, path_;
  const toml::table* table_;
  toml::table* resolved_;
  std::vector<std::string> known_;
};

}  // namespace ballast
