#pragma once
// The file of golden values: tables of text cells, compared cell by cell, so that a difference can
// be named.
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

/// The operations that the bits of a table depend on. IEEE 754 fixes arithmetic and square roots;
/// sine, cosine and powers may differ in the last bit between libms and between processors.
enum class Through { arithmetic, libm };

struct Table {
  std::string name;
  Through through = Through::arithmetic;
  std::string row_word;  ///< the kind of its rows: "step"
  std::vector<std::string> columns{};
  std::vector<std::pair<std::string, std::vector<std::string>>> rows{};
};

struct File {
  int generation = 0;
  std::vector<Table> tables;
};

/// The name of the table that identifies the libm. It comes before all tables through libm.
inline constexpr const char* libm_table = "libm";

std::string text_of(const File& file);
File parsed(const std::string& text);

/// The first cell that differs, in words: "table run, step 17, kinetic_energy: 3fa0 expected, 3fa1
/// found". Nothing when all are equal. If the table libm differs, tables through libm are not
/// compared.
std::optional<std::string> first_difference(const File& expected, const File& found);
/// Whether both files were made with libms that round alike.
bool same_libm(const File& expected, const File& found);

/// A double to the last bit, as printf's %a writes it.
std::string exact(double value);
/// The last `digits` digits (16 at most) of the hash of all bits.
std::string digest(std::span<const double> values, int digits = 16);

// The values of this build: every table of the golden file, computed in this process in seconds.

/// sine, cosine, hypot and pow of some thousand arguments.
Table libm_values();

/// The grains of vibrated_box_small as they are made: hulls, masses, moments of inertia.
Table grain_values();

/// The table of the backends that factor over bodies, for which SuiteSparse finds the order.
inline constexpr char factoring_table[] = "backends_factoring";

/// One step of a heap whose bits depend on arithmetic alone: its grains do not turn before the
/// step, overlap, and fly at each other. Contacts and problem as arrays; then each of our own
/// backends' results after fixed numbers of iterations, own factors over bodies included.
std::vector<Table> heap_values();

/// A smaller vibrated_box_small: its deposit, its packing, its drive.
std::vector<Table> box_values();

/// All tables, in the order in which one is made from the other.
File values_today();

}  // namespace ballast::golden
