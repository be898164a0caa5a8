#pragma once
// The file of golden values: tables of text cells, compared cell by cell, so that a difference has
// a name.
//
//   generation 1
//   [run: through libm] step kinetic_energy load      the table, where its bits come from, the word
//   17 3fa0 99c1                                      for its rows, its columns; then its rows

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

// What comes out today: every table of the golden file, computed in this process in a few seconds.

/// sine, cosine, hypot and pow of some thousand arguments.
Table libm_values();

/// Grains of vibrated_box_small as they are made: hulls, masses, moments of inertia.
Table grain_values();

/// Of the backends that factor over bodies: SuiteSparse finds the order for them.
inline constexpr char factoring_table[] = "backends_factoring";

/// One step of a heap whose bits go through arithmetic alone: its grains do not turn before the
/// step, overlap, and fly at each other. Contacts and problem as arrays; then what each backend of
/// our own makes of the problem in a fixed number of iterations, own factors over bodies included.
std::vector<Table> heap_values();

/// A small box of vibrated_box_small: its deposit, its packing, its drive.
std::vector<Table> box_values();

/// All of them, in the order in which one is made from the other.
File values_today();

}  // namespace ballast::golden
