#include "problems/scene/toml_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "platform/text.hpp"
#include "problems/scene/scene_file_error.hpp"
#include "problems/scene/toml_text.hpp"

namespace ballast {
namespace {

constexpr const char* override_source = "--set";
constexpr size_t shown_value = 60;  // characters of a value in an error message

std::string unit_text(const char* unit) { return *unit ? std::string(" [") + unit + "]" : ""; }

/// Shortest digits, an exponent without zeros: 2e-4.
std::string digits_of(double value) {
  char digits[32];
  std::string text(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  if (const size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
  if (const size_t plus = text.find("e+"); plus != std::string::npos) text.erase(plus + 1, 1);
  return text;
}

// What is expected of each type.
std::string words_of(const double&, const ValueRule& rule) { return rule.range.words; }
std::string words_of(const std::int64_t&, const ValueRule& rule) {
  const std::string low = std::to_string(rule.low);
  if (rule.high == std::numeric_limits<std::int64_t>::max()) return "a whole number >= " + low;
  return "a whole number from " + low + " to " + std::to_string(rule.high);
}
std::string words_of(const int&, const ValueRule& rule) { return words_of(std::int64_t{}, rule); }
std::string words_of(const std::uint64_t&, const ValueRule& rule) {
  return words_of(std::int64_t{}, rule);
}
std::string words_of(const bool&, const ValueRule&) { return "true or false"; }
std::string words_of(const std::string&, const ValueRule& rule) {
  std::string text;
  for (const char* word : rule.words) add_to_list(text, '"' + std::string(word) + '"');
  return rule.words.empty() ? "a text" : "one of " + text;
}
std::string words_of(const Vec3&, const ValueRule&) { return "three finite numbers"; }
std::string words_of(const std::vector<std::string>&, const ValueRule&) {
  return "a list of texts";
}

// Each takes the value that stands in the file, or says what is wrong with it.
std::string take(const toml::node& node, const ValueRule& rule, double& value) {
  const auto read = node.is_number() ? node.value<double>() : std::nullopt;
  value = read.value_or(value);
  return !read ? "not a number" : rule.range.contains(value) ? "" : "out of range";
}
template <class Whole>
requires std::is_integral_v<Whole> std::string take(const toml::node& node, const ValueRule& rule,
                                                    Whole& value) {
  const auto* read = node.as_integer();
  if (!read) return "not a whole number";
  value = static_cast<Whole>(read->get());
  return read->get() < rule.low || read->get() > rule.high ? "out of range" : "";
}
std::string take(const toml::node& node, const ValueRule&, bool& value) {
  const auto* read = node.as_boolean();
  if (read) value = read->get();
  return read ? "" : "neither";
}
std::string take(const toml::node& node, const ValueRule& rule, std::string& value) {
  const auto* read = node.as_string();
  if (!read) return "not a text in quotes";
  value = read->get();
  const bool is_word = std::find(rule.words.begin(), rule.words.end(), value) != rule.words.end();
  return rule.words.empty() || is_word ? "" : "unknown word";
}
std::string take(const toml::node& node, const ValueRule&, Vec3& value) {
  const auto* read = node.as_array();
  if (!read || read->size() != 3) return "not a vector [x, y, z]";
  for (int i = 0; i < 3; ++i) {
    const std::string wrong = take((*read)[static_cast<size_t>(i)], {}, value[i]);
    if (!wrong.empty()) return "entry " + std::to_string(i) + " is no finite number";
  }
  return "";
}
std::string take(const toml::node& node, const ValueRule&, std::vector<std::string>& values) {
  if (!node.is_array()) return "not a list";
  values.clear();
  for (const toml::node& entry : *node.as_array())
    if (!take(entry, {}, values.emplace_back()).empty()) return "not only texts";
  return "";
}

// As toml++ keeps them.
double as_toml(double value) { return value; }
std::int64_t as_toml(int value) { return value; }
std::int64_t as_toml(std::uint64_t value) { return static_cast<std::int64_t>(value); }
bool as_toml(bool value) { return value; }
std::string as_toml(const std::string& value) { return value; }
toml::array as_toml(const Vec3& value) { return toml::array{value.x(), value.y(), value.z()}; }
toml::array as_toml(const std::vector<std::string>& values) {
  toml::array array;
  for (const std::string& value : values) array.push_back(value);
  return array;
}

}  // namespace

bool NumberRange::contains(double x) const {
  if (!std::isfinite(x)) return false;
  return (low_included ? x >= low : x > low) && (high_included ? x <= high : x < high);
}

std::string expected_text(ValuePlace place, const ValueRule& rule) {
  return std::visit([&](auto* value) { return words_of(*value, rule); }, place);
}

std::string kept_text(ValuePlace place) {
  if (const auto* vector = std::get_if<Vec3*>(&place)) {
    const Vec3& v = **vector;
    return '[' + digits_of(v.x()) + ", " + digits_of(v.y()) + ", " + digits_of(v.z()) + ']';
  }
  if (const auto* number = std::get_if<double*>(&place)) return digits_of(**number);
  toml::array one;
  std::visit([&](auto* value) { one.push_back(as_toml(*value)); }, place);
  return toml_value_text(one[0], std::string::npos);
}

TomlTable::TomlTable(std::string file, const toml::table& table, toml::table& resolved,
                     std::string path)
    : file_(std::move(file)), path_(std::move(path)), table_(&table), resolved_(&resolved) {}

void TomlTable::read(std::string_view key, const ValueRule& rule, bool is_required,
                     ValuePlace place) {
  const std::string expected = ", expected " + expected_text(place, rule) + unit_text(rule.unit);
  const toml::node* node = find(key);
  if (!node && is_required)
    throw SceneFileError(place_of(table_) + ": " + full_key(key) + " is missing" + expected);
  // Given or not, the value goes into the resolved scene, which says what the run was made with.
  const auto keep = [&](auto* value) {
    const std::string wrong = node ? take(*node, rule, *value) : "";
    if (!wrong.empty()) fail(key, wrong + expected);
    resolved_->insert_or_assign(key, as_toml(*value));
  };
  std::visit(keep, place);
}

std::string TomlTable::text(std::string_view key) {
  std::string value;
  read(key, {}, true, &value);
  return value;
}

std::string TomlTable::text(std::string_view key, std::string fallback) {
  read(key, {}, false, &fallback);
  return fallback;
}

std::vector<std::string> TomlTable::texts(std::string_view key) {
  std::vector<std::string> values;
  read(key, {}, false, &values);
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
    if (const std::string meant = did_you_mean(name, known_); !meant.empty())
      fail(name, "unknown key" + meant);
    std::vector<std::string> sorted = known_;
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    fail(name, "unknown key, expected one of " + joined(sorted));
  }
}

void TomlTable::fail(std::string_view key, const std::string& what) const {
  const toml::node* node = table_->get(key);
  const std::string value = node ? " = " + toml_value_text(*node, shown_value) : "";
  throw SceneFileError(place_of(node) + ": " + full_key(key) + value + ": " + what);
}

const toml::node* TomlTable::find(std::string_view key) {
  known_.emplace_back(key);
  return table_->get(key);
}

std::string TomlTable::full_key(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + '.' + std::string(key);
}

std::string TomlTable::place_of(const toml::node* node) const {
  if (!node) return file_;
  const toml::source_region& source = node->source();
  if (source.path && *source.path == override_source) return file_ + " (" + override_source + ")";
  if (source.begin.line > 0) return file_ + ':' + std::to_string(source.begin.line);
  // a table that an override made has no source of its own
  if (const auto* table = node->as_table(); table && !table->empty())
    return place_of(&table->begin()->second);
  return file_;
}

}  // namespace ballast
