// load_toml: parsing, and overrides merged into the parsed table.

#include <algorithm>
#include <string_view>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file_error.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {
namespace {

constexpr size_t most_parts = 32;  // of a dotted key, and of brackets in brackets
constexpr const char* too_deep = "more than 32 levels of tables in one another";

struct Depth {
  bool is_too_deep = false;
  long line = 1;  ///< where
};

/// Each dot of a key and each bracket is a level of tables, and for each level the parser and the
/// destructors of its tables call themselves: some ten thousand of them leave the stack. What
/// stands in quotes and in comments does not count.
Depth depth_of(std::string_view text) {
  Depth depth;
  size_t dots = 0, brackets = 0;
  for (size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      // A text of one line, or of several between three quotes each.
      const std::string three(3, c);
      const bool is_long = text.substr(at, 3) == three;
      at += is_long ? 3 : 1;
      while (at < text.size() && (is_long ? text.substr(at, 3) != three : text[at] != c)) {
        if (text[at] == '\n' && !is_long) break;
        depth.line += text[at] == '\n';
        at += c == '"' && text[at] == '\\' ? 2 : 1;
      }
      if (is_long) at += 2;
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size() - 1);
      if (text[at] != '\n') break;
    }
    if (c == '.')
      ++dots;
    else if (c == '\n' || c == '=' || c == ',')
      dots = 0;
    else if (c == '[' || c == '{')
      ++brackets;
    else if ((c == ']' || c == '}') && brackets > 0)
      --brackets;
    if (dots > most_parts || brackets > most_parts) {
      depth.is_too_deep = true;
      return depth;
    }
    depth.line += text[at] == '\n';
  }
  return depth;
}

void refuse_depth(const std::filesystem::path& file, std::string_view text) {
  if (const Depth depth = depth_of(text); depth.is_too_deep)
    throw SceneFileError(file.string() + ':' + std::to_string(depth.line) + ": " + too_deep);
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
    return toml::parse("value = " + value, std::string_view("--set"));
  } catch (const toml::parse_error& error) {
    // a bare word, where no TOML was meant
    if (value.empty() || value.find_first_of("\"'[{\\") != std::string::npos)
      fail(file, o, "not a TOML value: " + std::string(error.description()));
    return toml::parse("value = \"" + value + "\"", std::string_view("--set"));
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
  if (o.path.size() > most_parts) fail(file, o, too_deep);
  if (depth_of(text.substr(equals + 1)).is_too_deep) fail(file, o, too_deep);
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

toml::table load_toml(const std::filesystem::path& file, std::span<const std::string> overrides) {
  if (is_folder(file))
    throw SceneFileError(file.string() + ": is a folder, expected a scene in TOML");
  std::string content;
  try {
    content = read_whole_file(file);
  } catch (const Error& error) {
    throw SceneFileError(error.what());
  }
  refuse_depth(file, content);
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

}  // namespace ballast
