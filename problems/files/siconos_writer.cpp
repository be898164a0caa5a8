// write_siconos_text: W by blocks of 3 x 3, as Siconos writes its own.

#include <algorithm>
#include <string>

#include "platform/atomic_file.hpp"
#include "problems/files/problem_file_error.hpp"
#include "problems/files/siconos_text.hpp"

namespace ballast {
namespace {

/// Which blocks of a row of contacts hold entries, in order.
std::vector<int> blocks_of(const SparseRows& w, int contact) {
  std::vector<int> columns;
  for (int row = 3 * contact; row < 3 * contact + 3; ++row)
    for (SparseRows::InnerIterator entry(w, row); entry; ++entry)
      columns.push_back(static_cast<int>(entry.col()) / 3);
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  return columns;
}

void print_vector(AtomicFile& file, const std::vector<double>& values) {
  for (const double value : values) file.print(" %.17g", value);
  file.write("\n");
}

void print_counts(AtomicFile& file, const std::vector<int>& values) {
  for (const int value : values) file.print(" %d", value);
  file.write("\n");
}

void print_blocks(AtomicFile& file, const SparseRows& w) {
  const int contacts = static_cast<int>(w.rows()) / 3;
  std::vector<int> ends, begins{0}, columns;
  for (int c = 0; c < contacts; ++c) {
    ends.push_back(3 * c + 3);
    for (const int column : blocks_of(w, c)) columns.push_back(column);
    begins.push_back(static_cast<int>(columns.size()));
  }
  const int blocks = static_cast<int>(columns.size());
  file.print("1\n%d\n%d\n%d\n%d %d\n", 3 * contacts, 3 * contacts, blocks, contacts, contacts);
  print_counts(file, ends);
  print_counts(file, ends);
  file.print("%d %d\n", contacts + 1, blocks);
  print_counts(file, begins);
  print_counts(file, columns);
  // Each block's number, then its entries column by column.
  for (int c = 0; c < contacts; ++c)
    for (int k = begins[static_cast<std::size_t>(c)]; k < begins[static_cast<std::size_t>(c) + 1];
         ++k) {
      file.print("%d\n", k);
      for (int entry = 0; entry < 9; ++entry)
        file.print(" %.17g", w.coeff(3 * c + entry % 3,
                                     3 * columns[static_cast<std::size_t>(k)] + entry / 3));
      file.write("\n");
    }
}

}  // namespace

void write_siconos_text(const std::filesystem::path& path, const LocalProblem& local) {
  with_problem_file_errors([&] {
    AtomicFile file(path);
    file.print("3\n%zu\n", local.mu.size());
    print_blocks(file, local.w);
    print_vector(file, as_vector(local.q));
    print_vector(file, local.mu);
    file.commit();
  });
}

}  // namespace ballast
