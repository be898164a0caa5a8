#include "problems/scene/toml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "platform/text.hpp"
#include "problems/scene/scene_file_error.hpp"
#include "problems/scene/toml_text.hpp"

namespace ballast {
namespace {

constexpr const char* override_source = "--set";
constexpr size_t shown_value = 60;  // characters of a value in an error message

/// Levenshtein distance: insertions, deletions and substitutions between two keys.
size_t edit_distance(std::string_view a, std::string_view b) {
  // one row of the table of distances between prefixes of a and of b
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0]++;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string unit_text(const char* unit) { return *unit ? std::string(" [") + unit + "]" : ""; }

}  // namespace

bool NumberRange::contains(double x) const {
  if (!std::isfinite(x)) return false;
  return (low_included ? x >= low : x > low) && (high_included ? x <= high : x < high);
}

TomlTable::TomlTable(std::string file, const toml::table& table, toml::table& resolved,
                     std::string path)
    : file_(std::move(file)), path_(std::move(path)), table_(&table), resolved_(&resolved) {}

double TomlTable::number(std::string_view key, const NumberRange& range, const char* unit,
                         std::optional<double> fallback) {
  const std::string expected = range.words + unit_text(unit);
  double x = fallback.value_or(0.0);
  if (const toml::node* node = find(key)) {
    const auto read = node->is_number() ? node->value<double>() : std::nullopt;
    if (!read) fail(key, "not a number, expected " + expected);
    x = *read;
    if (!range.contains(x)) fail(key, "out of range, expected " + expected);
  } else if (!fallback) {
    fail_missing(key, expected);
  }
  resolved_->insert_or_assign(key, x);
  return x;
}

std::int64_t TomlTable::whole(std::string_view key, std::int64_t low, std::int64_t high,
                              std::optional<std::int64_t> fallback) {
  std::string expected = "a whole number";
  if (high == std::numeric_limits<std::int64_t>::max())
    expected += " >= " + std::to_string(low);
  else
    expected += " from " + std::to_string(low) + " to " + std::to_string(high);
  std::int64_t n = fallback.value_or(0);
  if (const toml::node* node = find(key)) {
    const auto* read = node->as_integer();
    if (!read) fail(key, "not a whole number, expected " + expected);
    n = read->get();
    if (n < low || n > high) fail(key, "out of range, expected " + expected);
  } else if (!fallback) {
    fail_missing(key, expected);
  }
  resolved_->insert_or_assign(key, n);
  return n;
}

bool TomlTable::flag(std::string_view key, std::optional<bool> fallback) {
  bool value = fallback.value_or(false);
  if (const toml::node* node = find(key)) {
    const auto* read = node->as_boolean();
    if (!read) fail(key, "expected true or false");
    value = read->get();
  } else if (!fallback) {
    fail_missing(key, "true or false");
  }
  resolved_->insert_or_assign(key, value);
  return value;
}

std::string TomlTable::text(std::string_view key, std::optional<std::string> fallback) {
  std::string value = fallback.value_or("");
  if (const toml::node* node = find(key)) {
    const auto* read = node->as_string();
    if (!read) fail(key, "not a text, expected a text in quotes");
    value = read->get();
  } else if (!fallback) {
    fail_missing(key, "a text");
  }
  resolved_->insert_or_assign(key, value);
  return value;
}

std::string TomlTable::choice(std::string_view key, const std::vector<const char*>& words,
                              std::optional<std::string> fallback) {
  std::string expected = "one of ";
  for (const char* word : words)
    expected += (word == words.front() ? "\"" : ", \"") + std::string(word) + '"';
  if (!fallback && !has(key)) fail_missing(key, expected);
  const std::string value = text(key, std::move(fallback));
  if (std::find(words.begin(), words.end(), value) == words.end())
    fail(key, "unknown word, expected " + expected);
  return value;
}

Vec3 TomlTable::vector(std::string_view key, const char* unit, std::optional<Vec3> fallback) {
  const std::string expected = "three finite numbers [x, y, z]" + unit_text(unit);
  Vec3 v = fallback.value_or(Vec3::Zero());
  if (const toml::node* node = find(key)) {
    const auto* read = node->as_array();
    if (!read || read->size() != 3) fail(key, "not a vector, expected " + expected);
    for (int i = 0; i < 3; ++i) {
      const toml::node& entry = (*read)[static_cast<size_t>(i)];
      const auto x = entry.is_number() ? entry.value<double>() : std::nullopt;
      if (!x || !std::isfinite(*x))
        fail(key, "entry " + std::to_string(i) + " is no finite number, expected " + expected);
      v[i] = *x;
    }
  } else if (!fallback) {
    fail_missing(key, expected);
  }
  resolved_->insert_or_assign(key, toml::array{v.x(), v.y(), v.z()});
  return v;
}

std::vector<std::string> TomlTable::texts(std::string_view key) {
  std::vector<std::string> values;
  toml::array kept;
  if (const toml::node* node = find(key)) {
    if (!node->is_array()) fail(key, "expected a list of texts");
    for (const toml::node& entry : *node->as_array()) {
      if (!entry.is_string()) fail(key, "expected a list of texts");
      values.push_back(entry.as_string()->get());
      kept.push_back(values.back());
    }
  }
  resolved_->insert_or_assign(key, std::move(kept));
  return values;
}

TomlTable TomlTable::section(std::string_view key) {
  static const toml::table empty;
  const toml::node* node = find(key);
  if (node && !node->is_table()) fail(key, "expected a table [" + full_key(key) + "]");
  toml::node& kept = resolved_->insert_or_assign(key, toml::table{}).first->second;
  return TomlTable(file_, node ? *node->as_table() : empty, *kept.as_table(), full_key(key));
}

std::vector<TomlTable> TomlTable::sections(std::string_view key) {
  std::vector<TomlTable> tables;
  const toml::node* node = find(key);
  if (!node) return tables;
  const auto* read = node->as_array();
  if (!read) fail(key, "expected a list of tables [[" + full_key(key) + "]]");
  toml::array& kept = *resolved_->insert_or_assign(key, toml::array{}).first->second.as_array();
  for (size_t i = 0; i < read->size(); ++i) {
    if (!(*read)[i].is_table()) fail(key, "expected a list of tables [[" + full_key(key) + "]]");
    kept.push_back(toml::table{});
    tables.emplace_back(file_, *(*read)[i].as_table(), *kept.back().as_table(),
                        full_key(key) + '.' + std::to_string(i));
  }
  return tables;
}

void TomlTable::replace_resolved(std::string_view key, const toml::node& value) {
  value.visit([&](const auto& v) { resolved_->insert_or_assign(key, v); });
}

void TomlTable::finish() const {
  for (const auto& [key, value] : *table_) {
    const std::string name(key.str());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    // a word that is nearly one of the known ones is taken for a slip of the finger
    const auto nearest = std::min_element(known_.begin(), known_.end(),
                                          [&](const std::string& a, const std::string& b) {
                                            return edit_distance(name, a) < edit_distance(name, b);
                                          });
    std::vector<std::string> sorted = known_;
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    if (nearest != known_.end() &&
        edit_distance(name, *nearest) <= std::max<size_t>(2, name.size() / 3))
      fail(name, "unknown key, did you mean \"" + *nearest + "\"?");
    fail(name, "unknown key, expected one of " + joined(sorted));
  }
}

void TomlTable::fail(std::string_view key, const std::string& what) const {
  const toml::node* node = table_->get(key);
  const std::string value = node ? " = " + toml_value_text(*node, shown_value) : "";
  throw SceneFileError(place(node) + ": " + full_key(key) + value + ": " + what);
}

void TomlTable::fail_missing(std::string_view key, const std::string& expected) const {
  throw SceneFileError(place(table_) + ": " + full_key(key) + " is missing, expected " + expected);
}

const toml::node* TomlTable::find(std::string_view key) {
  known_.emplace_back(key);
  return table_->get(key);
}

std::string TomlTable::full_key(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + '.' + std::string(key);
}

std::string TomlTable::place(const toml::node* node) const {
  if (!node) return file_;
  const toml::source_region& source = node->source();
  if (source.path && *source.path == override_source) return file_ + " (" + override_source + ")";
  if (source.begin.line > 0) return file_ + ':' + std::to_string(source.begin.line);
  // a table that an override made has no source of its own
  if (const auto* table = node->as_table(); table && !table->empty())
    return place(&table->begin()->second);
  return file_;
}

}  // namespace ballast
