#include "tests/golden/golden_values.hpp"

#include <algorithm>
#include <sstream>

#include "platform/text.hpp"

namespace ballast::golden {
namespace {

constexpr std::string_view libm_mark = ": through libm";

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Parses "[run: through libm] step time load" into a table without rows.
Table table_of(const std::string& line) {
  const size_t end = line.find(']');
  std::vector<std::string> words = words_of(line.substr(end + 1));
  Table table{
      line.substr(1, end - 1), Through::arithmetic, words.at(0), {words.begin() + 1, words.end()}};
  if (!table.name.ends_with(libm_mark)) return table;
  table.through = Through::libm;
  table.name.resize(table.name.size() - libm_mark.size());
  return table;
}

std::string named(const Table& table, const std::string& what) {
  return "table " + table.name + ", " + what;
}

std::optional<std::string> difference(const Table& expected, const Table& found) {
  if (expected.name != found.name)
    return named(expected, "expected; '" + found.name + "' stands in its place");
  if (expected.columns != found.columns || expected.through != found.through)
    return named(expected, "has other columns now");
  for (size_t k = 0; k < std::min(expected.rows.size(), found.rows.size()); ++k) {
    const auto& [label, cells] = expected.rows[k];
    const std::string row = expected.row_word + " " + label;
    if (found.rows[k].first != label)
      return named(expected, row + " expected, " + found.rows[k].first + " found");
    if (cells.size() != found.rows[k].second.size())
      return named(expected, row + " has another number of cells");
    for (size_t c = 0; c < cells.size(); ++c)
      if (cells[c] != found.rows[k].second[c])
        return named(expected, row + ", " + expected.columns[c] + ": " + cells[c] + " expected, " +
                                   found.rows[k].second[c] + " found");
  }
  if (expected.rows.size() != found.rows.size())
    return named(expected, std::to_string(expected.rows.size()) + " rows expected, " +
                               std::to_string(found.rows.size()) + " found");
  return std::nullopt;
}

}  // namespace

std::string text_of(const File& file) {
  std::string text =
      "# Golden values of Ballast: docs/house/checks.md says what they are and how they are made "
      "anew.\ngeneration " +
      std::to_string(file.generation) + "\n";
  for (const Table& table : file.tables) {
    text += "\n[" + table.name;
    if (table.through == Through::libm) text += libm_mark;
    text += "] " + table.row_word;
    for (const std::string& column : table.columns) text += " " + column;
    text += "\n";
    for (const auto& [label, cells] : table.rows) {
      text += label;
      for (const std::string& cell : cells) text += " " + cell;
      text += "\n";
    }
  }
  return text;
}

File parsed(const std::string& text) {
  File file;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words[0] == "#") continue;
    if (words[0] == "generation")
      file.generation = std::atoi(words.at(1).c_str());
    else if (line[0] == '[')
      file.tables.push_back(table_of(line));
    else
      file.tables.at(file.tables.size() - 1)
          .rows.push_back({words[0], {words.begin() + 1, words.end()}});
  }
  return file;
}

bool same_libm(const File& expected, const File& found) {
  const auto libm = [](const File& file) {
    return std::ranges::find(file.tables, libm_table, &Table::name);
  };
  return libm(expected) != expected.tables.end() && libm(found) != found.tables.end() &&
         !difference(*libm(expected), *libm(found));
}

std::optional<std::string> first_difference(const File& expected, const File& found) {
  if (expected.generation != found.generation)
    return "generation " + std::to_string(expected.generation) + " expected, " +
           std::to_string(found.generation) + " found";
  const bool libm = same_libm(expected, found);
  for (size_t k = 0; k < std::min(expected.tables.size(), found.tables.size()); ++k) {
    const Table& table = expected.tables[k];
    if (!libm && (table.through == Through::libm || table.name == libm_table)) continue;
    if (auto different = difference(table, found.tables[k])) return different;
  }
  if (expected.tables.size() != found.tables.size())
    return std::to_string(expected.tables.size()) + " tables expected, " +
           std::to_string(found.tables.size()) + " found";
  return std::nullopt;
}

std::string exact(double value) { return printed("%a", value); }

std::string digest(std::span<const double> values, int digits) {
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return content_key(bytes).substr(static_cast<size_t>(16 - digits));
}

}  // namespace ballast::golden
