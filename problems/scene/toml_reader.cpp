#include "problems/scene/toml_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {
namespace {

constexpr const char* override_source = "--set";
constexpr size_t shown_value = 63;   // characters of " = value" in an error message
constexpr size_t most_dots = 1'000;  // in a line

std::string key_text(std::string_view key) {
  return is_plain(key, "_-") ? std::string(key) : toml_value_text(toml::value<std::string>(key));
}

bool is_array_of_tables(const toml::node& node) {
  const auto* array = node.as_array();
  return array && !array->empty() && array->is_homogeneous(toml::node_type::table);
}

/// Plain keys first, then subtables, then arrays of tables: the order that TOML needs.
void write_table(const toml::table& table, const std::string& path, std::string& out) {
  const auto name_of = [&](const toml::key& key) {
    return path.empty() ? key_text(key.str()) : path + '.' + key_text(key.str());
  };
  for (const auto& [key, value] : table)
    if (!value.is_table() && !is_array_of_tables(value))
      out += key_text(key.str()) + " = " + toml_value_text(value) + '\n';
  for (const auto& [key, value] : table) {
    const auto* child = value.as_table();
    if (!child) continue;
    out += "\n[" + name_of(key) + "]\n";
    write_table(*child, name_of(key), out);
  }
  for (const auto& [key, value] : table) {
    if (!is_array_of_tables(value)) continue;
    for (const toml::node& element : *value.as_array()) {
      out += "\n[[" + name_of(key) + "]]\n";
      write_table(*element.as_table(), name_of(key), out);
    }
  }
}

/// The value as toml++ keeps it; of a list every entry.
template <class Value>
auto as_toml(const Value& value) {
  if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
    return static_cast<std::int64_t>(value);
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
    return value;
  } else {
    toml::array list;
    for (const auto& entry : value) list.push_back(as_toml(entry));
    return list;
  }
}

// take() reads the value that stands in the file, or returns what is wrong with it.

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
std::string take(const toml::node& node, const ValueRule& rule, NumberRows& rows) {
  if (!node.is_array()) return "not a list";
  rows.clear();
  for (const toml::node& entry : *node.as_array()) {
    const auto* row = entry.as_array();
    const std::string name = "row " + std::to_string(rows.size());
    if (!row || row->size() != rule.columns)
      return name + " has not " + std::to_string(rule.columns) + " numbers";
    rows.emplace_back();
    for (const toml::node& number : *row)
      if (!take(number, {}, rows.back().emplace_back()).empty())
        return name + " has an entry that is no finite number";
  }
  return "";
}

/// "a number > 0", "true or false", ...: the expectation in words, without its unit.
template <class Value>
std::string expected_text(const Value&, const ValueRule& rule) {
  if constexpr (std::is_same_v<Value, double>) {
    return rule.range.words;
  } else if constexpr (std::is_same_v<Value, bool>) {
    return "true or false";
  } else if constexpr (std::is_integral_v<Value>) {
    if (rule.high == std::numeric_limits<std::int64_t>::max())
      return "a whole number >= " + std::to_string(rule.low);
    return "a whole number from " + std::to_string(rule.low) + " to " + std::to_string(rule.high);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    std::string text;
    for (const char* word : rule.words) add_to_list(text, '"' + std::string(word) + '"');
    return rule.words.empty() ? "a text" : "one of " + text;
  } else if constexpr (std::is_same_v<Value, NumberRows>) {
    return "a list of rows of " + std::to_string(rule.columns) + " finite numbers";
  } else {
    return std::is_same_v<Value, Vec3> ? "three finite numbers" : "a list of texts";
  }
}

// Overrides.

constexpr const char* too_deep = "more than 1000 dots in a line";

/// Returns the first line with too many dots. Each dot of a key is a level of tables, and the
/// parser and the tables' destructors recurse at each level: some ten thousand levels overflow the
/// stack. (For nested brackets toml++ itself counts the levels.)
std::optional<long> line_too_deep(std::string_view text) {
  long line = 1;
  size_t dots = 0;
  for (const char c : text) {
    dots = c == '\n' ? 0 : dots + (c == '.');
    if (dots > most_dots) return line;
    line += c == '\n';
  }
  return std::nullopt;
}

/// Applies "dotted.key=value". The value is moved into the tree: a copied node loses its source, by
/// which errors tell that an override is to blame.
void apply(const std::filesystem::path& file, const std::string& text, toml::table& root) {
  const auto fail = [&](const std::string& what) {
    const std::string first_line = text.substr(0, text.find_first_of("\r\n"));
    throw Error(file.string() + " (--set): " + first_line + ": " + what);
  };
  const size_t equals = text.find('=');
  if (equals == std::string::npos) fail("expected dotted.key=value");
  const std::vector<std::string> path = split(text.substr(0, equals), '.');
  if (std::find(path.begin(), path.end(), "") != path.end())
    fail("empty part in the key, expected dotted.key=value");
  if (line_too_deep(text)) fail(too_deep);
  if (text.find_first_of("\r\n") != std::string::npos) fail("a value is one line");
  const std::string value = text.substr(equals + 1);
  const auto parse = [](const std::string& words) {
    return toml::parse("value = " + words, std::string_view(override_source));
  };
  toml::table given;
  try {
    try {
      given = parse(value);
    } catch (const toml::parse_error&) {
      // a bare word, where no TOML was meant
      if (value.empty() || value.find_first_of("\"'[{\\") != std::string::npos) throw;
      given = parse('"' + value + '"');
    }
  } catch (const toml::parse_error& error) {
    fail("not a TOML value: " + std::string(error.description()));
  }
  // down to the table that holds the last key; tables that are missing are made
  toml::table* table = &root;
  for (size_t k = 0; k + 1 < path.size(); ++k) {
    toml::node* node = table->get(path[k]);
    if (!node) node = &table->insert(path[k], toml::table{}).first->second;
    // After the name of a list a number says which of its tables: body.0.mass.
    if (toml::array* array = node->as_array()) {
      node = array->get(parsed<size_t>(path[++k]).value_or(array->size()));
      if (!node)
        fail("no element " + path[k] + " there, expected an index below " +
             std::to_string(array->size()));
      if (!node->is_table()) fail("element " + path[k] + " is not a table");
      if (k + 1 == path.size()) fail("expected a key after the index");
    } else if (!node->is_table()) {
      fail(path[k] + " is not a table");
    }
    table = node->as_table();
  }
  given.get("value")->visit(
      [&](auto& own) { table->insert_or_assign(path.back(), std::move(own)); });
}

}  // namespace

bool NumberRange::contains(double x) const {
  if (!std::isfinite(x)) return false;
  return (low_included ? x >= low : x > low) && (high_included ? x <= high : x < high);
}

TomlTable::TomlTable(std::string file, const toml::table& table, toml::table& resolved,
                     std::string path)
    : file_(std::move(file)), path_(std::move(path)), table_(&table), resolved_(&resolved) {}

void TomlTable::read(std::string_view key, ValuePlace place, const ValueRule& rule,
                     Presence presence) {
  const toml::node* node = find(key);
  const auto read_into = [&](auto* value) {
    const std::string unit = *rule.unit ? std::string(" [") + rule.unit + "]" : "";
    const std::string expected = ", expected " + expected_text(*value, rule) + unit;
    if (!node && presence == Presence::required)
      throw Error(place_of(table_) + ": " + full_key(key) + " is missing" + expected);
    const auto by_default = *value;
    const std::string wrong = node ? take(*node, rule, *value) : "";
    if (!wrong.empty()) fail(key, wrong + expected);
    // Given or not, the value goes into the resolved scene, the record of a run's settings.
    if (presence != Presence::only_where_given || *value != by_default)
      resolved_->insert_or_assign(key, as_toml(*value));
  };
  std::visit(read_into, place);
}

std::string TomlTable::text(std::string_view key, std::optional<std::string> fallback) {
  std::string value = fallback.value_or("");
  read(key, &value, {}, fallback ? Presence::optional : Presence::required);
  return value;
}

std::vector<std::string> TomlTable::texts(std::string_view key) {
  std::vector<std::string> values;
  read(key, &values);
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
  if (!read || !(read->empty() || is_array_of_tables(*read)))
    fail(key, "expected a list of tables [[" + full_key(key) + "]]");
  toml::array& kept = *resolved_->insert_or_assign(key, toml::array{}).first->second.as_array();
  for (size_t i = 0; i < read->size(); ++i) {
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
    if (known_.contains(name)) continue;
    const std::string meant = did_you_mean(name, known_);
    fail(name, "unknown key" + (meant.empty() ? ", expected one of " + joined(known_) : meant));
  }
}

void TomlTable::fail(std::string_view key, const std::string& what) const {
  const toml::node* node = table_->get(key);
  std::string value = node ? " = " + toml_value_text(*node) : "";
  if (value.size() > shown_value) value = value.substr(0, shown_value) + "...";
  throw Error(place_of(node) + ": " + full_key(key) + value + ": " + what);
}

const toml::node* TomlTable::find(std::string_view key) {
  know(key);
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

toml::table load_toml(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return parse_toml(read_whole_file(file), file, overrides);
}

toml::table parse_toml(const std::string& text, const std::filesystem::path& file,
                       std::span<const std::string> overrides) {
  if (const auto line = line_too_deep(text))
    throw Error(file.string() + ':' + std::to_string(*line) + ": " + too_deep);
  toml::table table;
  try {
    table = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    throw Error(file.string() + ':' + std::to_string(error.source().begin.line) +
                ": not valid TOML: " + std::string(error.description()));
  }
  for (const std::string& set : overrides) apply(file, set, table);
  return table;
}

std::string toml_text(const toml::table& table) {
  std::string out;
  write_table(table, "", out);
  return out.starts_with('\n') ? out.substr(1) : out;
}

std::string toml_value_text(const toml::node& node) {
  std::string text;
  if (const auto* array = node.as_array()) {
    for (const toml::node& element : *array) add_to_list(text, toml_value_text(element));
    return "[" + text + "]";
  }
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      add_to_list(text, key_text(key.str()) + " = " + toml_value_text(value));
    return "{" + text + "}";
  }
  if (const auto* number = node.as_floating_point(); number && std::isfinite(number->get())) {
    // The shortest digits with the same bits; with a point or an exponent it stays a float.
    char digits[32];
    text.assign(digits, std::to_chars(digits, digits + sizeof digits, number->get()).ptr);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
  }
  std::ostringstream one;
  one << toml::toml_formatter(node, toml::format_flags::allow_unicode_strings);
  return one.str();
}

}  // namespace ballast
