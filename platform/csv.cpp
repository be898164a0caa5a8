#include "platform/csv.hpp"

#include <algorithm>
#include <cmath>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {

void CsvWriter::add(std::string_view cell) {
  if (in_row_) text_ += ',';
  in_row_ = true;
  // A cell in quotes may hold commas; a quote in it is written twice.
  const bool is_quoted = cell.find_first_of(",\"\n\r") != std::string_view::npos;
  std::string text = one_line(cell, ' ');
  replace_all(text, "\"", "\"\"");
  text_ += is_quoted ? '"' + text + '"' : text;
}

void CsvWriter::add(double value, int digits) { add(printed("%.*g", digits, value)); }

void CsvWriter::add(long value) { add(std::to_string(value)); }

void CsvWriter::end_row() {
  text_ += '\n';
  in_row_ = false;
}

void CsvWriter::add_row(std::span<const std::string> cells) {
  for (const std::string& cell : cells) add(cell);
  end_row();
}

std::string number_cell(double value, int digits) {
  return std::isfinite(value) ? printed("%.*g", digits, value) : "";
}

CsvReader::CsvReader(const std::filesystem::path& file)
    : file_(file.string()), text_(read_whole_file(file)) {}

bool CsvReader::next() {
  // Lines end with \n or \r\n; the last one may lack its end.
  while (at_ < text_.size()) {
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) continue;
    split(line);
    return true;
  }
  return false;
}

void CsvReader::split(std::string_view line) {
  cells_.clear();
  // A comma is always followed by one more cell, which may be empty.
  for (size_t at = 0; cells_.empty() || at++ < line.size();) {
    std::string& cell = cells_.emplace_back();
    if (at == line.size() || line[at] != '"') {
      // A plain cell goes to the next comma.
      cell = line.substr(at, line.find(',', at) - at);
      at += cell.size();
      continue;
    }
    // A doubled quote is a quote; a single one ends the cell.
    for (++at;; ++at) {
      if (at >= line.size()) fail("a quote is not closed");
      if (line[at] == '"' && (++at >= line.size() || line[at] != '"')) break;
      cell += line[at];
    }
    if (at < line.size() && line[at] != ',') fail("a comma is missing after a quoted cell");
  }
}

double CsvReader::number(size_t cell, std::string_view column) const {
  const auto value = parsed_number(cells_[cell]);
  if (!value) fail(std::string(column) + " is not a number: \"" + cells_[cell].substr(0, 40) + '"');
  return *value;
}

void CsvReader::require_cells(size_t count) const {
  if (cells_.size() != count)
    fail(std::to_string(cells_.size()) + " fields, expected " + std::to_string(count));
}

void CsvReader::fail(const std::string& what) const {
  throw Error(file_ + ":" + std::to_string(std::max(line_, 1L)) + ": " + what);
}

}  // namespace ballast
