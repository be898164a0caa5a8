#include "problems/scene/toml_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <type_traits>

#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {
namespace {

constexpr const char* override_source = "--set";
constexpr size_t shown_value = 60;   // characters of a value in an error message
constexpr size_t most_dots = 1'000;  // in a line

/// Shortest digits that read back to the same bits.
std::string shortest_digits(double x) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, x).ptr};
}

// Writing.

/// With a point or an exponent, so that it stays a float.
std::string float_text(double x) {
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  std::string text = shortest_digits(x);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string string_text(const std::string& s) {
  std::string text = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      text += printed("\\u%04X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      text += c;
    }
  }
  return text + '"';
}

std::string key_text(std::string_view key) {
  return is_plain(key, "_-") ? std::string(key) : string_text(std::string(key));
}

std::string inline_text(const toml::node& node) {
  if (const auto* value = node.as_floating_point()) return float_text(value->get());
  if (const auto* value = node.as_integer()) return std::to_string(value->get());
  if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
  if (const auto* value = node.as_string()) return string_text(value->get());
  std::string text;
  if (const auto* array = node.as_array()) {
    for (const toml::node& element : *array) add_to_list(text, inline_text(element));
    return "[" + text + "]";
  }
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      add_to_list(text, key_text(key.str()) + " = " + inline_text(value));
    return "{" + text + "}";
  }
  std::ostringstream date;  // dates and times: in no scene, but a wrong type must be printable
  node.visit([&](const auto& value) { date << value; });
  return date.str();
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
      out += key_text(key.str()) + " = " + inline_text(value) + '\n';
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

/// As toml++ keeps it.
template <class Value>
auto as_toml(const Value& value) {
  if constexpr (std::is_same_v<Value, Vec3>) {
    return toml::array{value.x(), value.y(), value.z()};
  } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
    toml::array array;
    for (const std::string& text : value) array.push_back(text);
    return array;
  } else if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
    return static_cast<std::int64_t>(value);
  } else {
    return value;
  }
}

// Reading: each takes the value that stands in the file, or says what is wrong with it.

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

// Overrides.

constexpr const char* too_deep = "more than 1000 dots in a line";

/// Each dot of a key is a level of tables, and for each level the parser and the destructors of its
/// tables call themselves: some ten thousand of them leave the stack. (Of brackets in brackets
/// toml++ itself counts the levels.) The first line with too many dots.
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

struct Override {
  std::vector<std::string> path;
  std::string text;   ///< as given, for messages
  toml::table value;  ///< under the key "value"
};

[[noreturn]] void fail(const std::filesystem::path& file, const Override& o,
                       const std::string& what) {
  const std::string first_line = o.text.substr(0, o.text.find_first_of("\r\n"));
  throw SceneFileError(file.string() + " (--set): " + first_line + ": " + what);
}

toml::table parse_value(const std::filesystem::path& file, const Override& o,
                        const std::string& value) {
  if (value.find_first_of("\r\n") != std::string::npos) fail(file, o, "a value is one line");
  try {
    return toml::parse("value = " + value, std::string_view(override_source));
  } catch (const toml::parse_error& error) {
    // a bare word, where no TOML was meant
    if (value.empty() || value.find_first_of("\"'[{\\") != std::string::npos)
      fail(file, o, "not a TOML value: " + std::string(error.description()));
    return toml::parse("value = \"" + value + "\"", std::string_view(override_source));
  }
}

Override parse_override(const std::filesystem::path& file, const std::string& text) {
  Override o;
  o.text = text;
  const size_t equals = text.find('=');
  if (equals == std::string::npos) fail(file, o, "expected dotted.key=value");
  o.path = split(text.substr(0, equals), '.');
  for (const std::string& part : o.path)
    if (part.empty()) fail(file, o, "empty part in the key, expected dotted.key=value");
  if (const auto line = line_too_deep(text)) fail(file, o, too_deep);
  o.value = parse_value(file, o, text.substr(equals + 1));
  return o;
}

toml::table& element(const std::filesystem::path& file, const Override& o, toml::array& array,
                     const std::string& index) {
  const std::string range = "expected an index below " + std::to_string(array.size());
  const bool digits =
      index.find_first_not_of("0123456789") == std::string::npos && index.size() < 10;
  const size_t i = digits ? std::stoul(index) : array.size();
  if (i >= array.size()) fail(file, o, "no element " + index + " there, " + range);
  if (!array[i].is_table()) fail(file, o, "element " + index + " is not a table");
  return *array[i].as_table();
}

/// Values are moved into the tree: a copied node forgets its source, by which errors say that an
/// override is to blame.
void apply(const std::filesystem::path& file, Override o, toml::table& root) {
  // down to the table that holds the last key; tables that are missing are made
  toml::table* table = &root;
  for (size_t k = 0; k + 1 < o.path.size(); ++k) {
    toml::node* node = table->get(o.path[k]);
    if (!node) node = &table->insert(o.path[k], toml::table{}).first->second;
    // After the name of a list a number says which of its tables: body.0.mass.
    if (toml::array* array = node->as_array()) {
      table = &element(file, o, *array, o.path[++k]);
      if (k + 1 == o.path.size()) fail(file, o, "expected a key after the index");
    } else if (node->is_table()) {
      table = node->as_table();
    } else {
      fail(file, o, o.path[k] + " is not a table");
    }
  }
  o.value.get("value")->visit(
      [&](auto& value) { table->insert_or_assign(o.path.back(), std::move(value)); });
}

}  // namespace

bool NumberRange::contains(double x) const {
  if (!std::isfinite(x)) return false;
  return (low_included ? x >= low : x > low) && (high_included ? x <= high : x < high);
}

std::string expected_text(ValuePlace place, const ValueRule& rule) {
  const auto words = [&](auto* value) -> std::string {
    using Value = std::remove_pointer_t<decltype(value)>;
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
    } else {
      return std::is_same_v<Value, Vec3> ? "three finite numbers" : "a list of texts";
    }
  };
  return std::visit(words, place);
}

std::string kept_text(ValuePlace place) {
  // A number as one writes it: 5, and an exponent without zeros, 2e-4.
  const auto digits_of = [](double value) {
    std::string text = shortest_digits(value);
    if (const size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
    if (const size_t plus = text.find("e+"); plus != std::string::npos) text.erase(plus + 1, 1);
    return text;
  };
  if (const auto* vector = std::get_if<Vec3*>(&place)) {
    const Vec3& v = **vector;
    return '[' + digits_of(v.x()) + ", " + digits_of(v.y()) + ", " + digits_of(v.z()) + ']';
  }
  if (const auto* number = std::get_if<double*>(&place)) return digits_of(**number);
  toml::array one;
  std::visit([&](auto* value) { one.push_back(as_toml(*value)); }, place);
  return inline_text(one[0]);
}

TomlTable::TomlTable(std::string file, const toml::table& table, toml::table& resolved,
                     std::string path)
    : file_(std::move(file)), path_(std::move(path)), table_(&table), resolved_(&resolved) {}

void TomlTable::read(std::string_view key, const ValueRule& rule, bool is_required,
                     ValuePlace place) {
  const std::string unit = *rule.unit ? std::string(" [") + rule.unit + "]" : "";
  const std::string expected = ", expected " + expected_text(place, rule) + unit;
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

toml::table load_toml(const std::filesystem::path& file, std::span<const std::string> overrides) {
  if (is_folder(file))
    throw SceneFileError(file.string() + ": is a folder, expected a scene in TOML");
  std::string content;
  try {
    content = read_whole_file(file);
  } catch (const Error& error) {
    throw SceneFileError(error.what());
  }
  if (const auto line = line_too_deep(content))
    throw SceneFileError(file.string() + ':' + std::to_string(*line) + ": " + too_deep);
  toml::table table;
  try {
    table = toml::parse(content, file.string());
  } catch (const toml::parse_error& error) {
    throw SceneFileError(file.string() + ':' + std::to_string(error.source().begin.line) +
                         ": not valid TOML: " + std::string(error.description()));
  }
  for (const std::string& text : overrides) apply(file, parse_override(file, text), table);
  return table;
}

std::string toml_text(const toml::table& table) {
  std::string out;
  write_table(table, "", out);
  return out.starts_with('\n') ? out.substr(1) : out;
}

std::string toml_value_text(const toml::node& node, size_t limit) {
  std::string text = inline_text(node);
  if (text.size() > limit) text = text.substr(0, limit) + "...";
  return text;
}

}  // namespace ballast
