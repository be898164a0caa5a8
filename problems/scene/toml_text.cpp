#include "problems/scene/toml_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "platform/text.hpp"

namespace ballast {
namespace {

/// Shortest digits that read back to the same bits, with a point or an exponent, so that it stays a
/// float.
std::string float_text(double x) {
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr;
  std::string text(digits.data(), end);
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
  if (const auto* value = node.as_date()) date << value->get();
  if (const auto* value = node.as_time()) date << value->get();
  if (const auto* value = node.as_date_time()) date << value->get();
  return date.str();
}

bool is_array_of_tables(const toml::node& node) {
  const auto* array = node.as_array();
  return array && !array->empty() && array->is_homogeneous(toml::node_type::table);
}

/// Plain keys first, then subtables, then arrays of tables: the order that TOML needs.
void write_table(const toml::table& table, const std::string& path, std::string& out) {
  for (const auto& [key, value] : table)
    if (!value.is_table() && !is_array_of_tables(value))
      out += key_text(key.str()) + " = " + inline_text(value) + '\n';
  for (const auto& [key, value] : table) {
    const std::string name = path.empty() ? key_text(key.str()) : path + '.' + key_text(key.str());
    if (const auto* child = value.as_table()) {
      out += "\n[" + name + "]\n";
      write_table(*child, name, out);
    }
  }
  for (const auto& [key, value] : table) {
    const std::string name = path.empty() ? key_text(key.str()) : path + '.' + key_text(key.str());
    if (!is_array_of_tables(value)) continue;
    for (const toml::node& element : *value.as_array()) {
      out += "\n[[" + name + "]]\n";
      write_table(*element.as_table(), name, out);
    }
  }
}

}  // namespace

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
