#pragma once
// The file of golden values: tables of text cells, compared cell by cell, so that a difference has
// a name.
//
//   generation 1
//   [run: through libm] step kinetic_energy load      the table, where its bits come from, the word
//   17 3fa0 99c1                                      for its rows, its columns; then its rows

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace ballast::golden {

/// What the bits of a table go through. IEEE 754 fixes arithmetic and square roots; sine, cosine
/// and powers may differ in their last bit from one libm, and from one processor, to the next.
enum class Through { arithmetic, libm };

struct Table {
  std::string name;
  Through through = Through::arithmetic;
  std::string row_word;  ///< what a row is: "step"
  std::vector<std::string> columns{};
  std::vector<std::pair<std::string, std::vector<std::string>>> rows{};
};

struct File {
  int generation = 0;
  std::vector<Table> tables;
};

/// The name of the table that says which libm this is. It comes before all that goes through libm.
inline constexpr const char* libm_table = "libm";

std::string text_of(const File& file);
/// Throws Error naming the line.
File parsed(const std::string& text);

/// The first cell that differs, in words: "table run, step 17, kinetic_energy: 3fa0 expected, 3fa1
/// found". Nothing when all are equal. Where the table libm differs, tables through libm are left
/// out.
std::optional<std::string> first_difference(const File& expected, const File& found);
/// Whether both were made with a libm that rounds alike.
bool same_libm(const File& expected, const File& found);

/// A double to the last bit, as printf's %a writes it.
std::string exact(double value);
/// The last `digits` of the hash of all bits (16 at most).
std::string digest(std::span<const double> values, int digits = 16);

}  // namespace ballast::golden
