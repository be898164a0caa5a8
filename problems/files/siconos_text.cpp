// Reads Siconos' text format (.dat).

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/files/problem_file.hpp"

namespace ballast {
namespace {

/// The file's words, one after the other, with the line for error messages.
class WordReader {
 public:
  explicit WordReader(const std::filesystem::path& file)
      : name_(file.string()), text_(read_whole_file(file)) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(name_ + ": line " + std::to_string(line_) + ": " + what);
  }
  void require(bool condition, const std::string& what) const {
    if (!condition) fail(what);
  }

  /// Returns the next word. `of` names it in error messages.
  std::string_view next(const char* of) {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])))
      line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    if (begin == at_) fail(std::string("the file ends within ") + of);
    return std::string_view(text_).substr(begin, at_ - begin);
  }

  /// Returns whether the next words are these numbers, and does not take them.
  bool next_are(std::initializer_list<int> numbers) {
    const std::size_t at = at_;
    const int line = line_;
    const bool equal = std::all_of(numbers.begin(), numbers.end(), [&](int wanted) {
      while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
      return at_ < text_.size() && parsed<int>(next("a number")) == wanted;
    });
    at_ = at;
    line_ = line;
    return equal;
  }

  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

  int integer(const char* of) { return number<int>(next(of), of); }
  double real(const char* of) {
    const double value = number<double>(next(of), of);
    if (!std::isfinite(value)) fail(of + (" = " + std::to_string(value)) + " is not finite");
    return value;
  }
  int count(const char* of) {
    const int value = integer(of);
    if (value < 0) fail(of + (" = " + std::to_string(value)) + " is negative");
    return value;
  }
  /// Reads a count of things that have a number each in the rest of the file, so that no memory is
  /// allocated for a wrong count. Three times the count fits in an int.
  int backed_count(const char* of) {
    const int value = count(of);
    if (value > std::numeric_limits<int>::max() / 3)
      fail(of + (" = " + std::to_string(value)) + " is too large");
    require_room(static_cast<std::size_t>(value), of);
    return value;
  }
  /// Fails unless so many numbers, of a digit at least, fit in the rest of the file.
  void require_room(std::size_t numbers, const char* of) const {
    if (numbers > text_.size() - at_) fail(std::string("the file ends within ") + of);
  }
  template <typename Number>
  std::vector<Number> list(std::size_t size, const char* of) {
    require_room(size, of);
    std::vector<Number> values(size);
    for (Number& value : values)
      if constexpr (std::is_same_v<Number, int>)
        value = count(of);
      else
        value = real(of);
    return values;
  }
  /// Reads words up to and including `word`.
  void skip_to(std::string_view word, const char* of) {
    while (next(of) != word) {
    }
  }

 private:
  template <typename Number>
  Number number(std::string_view word, const char* of) const {
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    const std::optional<Number> value = parsed<Number>(word);
    if (!value) fail(std::string(of) + ": '" + std::string(word) + "' is not a number");
    return *value;
  }

  std::string name_, text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

struct TextMatrix {
  int rows = 0, columns = 0;
  std::vector<Eigen::Triplet<double>> entries;

  void add(const WordReader& words, int row, int column, double value) {
    if (row < 0 || row >= rows || column < 0 || column >= columns)
      words.fail(printed("entry (%d, %d) is outside %d x %d", row, column, rows, columns));
    if (value != 0.0) entries.emplace_back(row, column, value);
  }
};

/// Reads a column-major matrix.
void read_dense(WordReader& words, TextMatrix& matrix) {
  const int rows = words.count("rows"), columns = words.count("columns");
  words.require(rows == matrix.rows && columns == matrix.columns,
                "the matrix states two different sizes");
  words.require_room(static_cast<std::size_t>(rows) * columns, "a dense matrix");
  for (int column = 0; column < columns; ++column)
    for (int row = 0; row < rows; ++row)
      matrix.add(words, row, column, words.real("a dense matrix"));
}

/// Reads the end of each of `blocks` block rows (or columns): they ascend to `size`, none is empty.
std::vector<int> read_ends(WordReader& words, int blocks, int size, const char* of) {
  const std::vector<int> end = words.list<int>(blocks, of);
  const bool ascend = std::adjacent_find(end.begin(), end.end(), std::greater_equal()) == end.end();
  words.require(blocks > 0 && ascend && end.front() > 0 && end.back() == size,
                std::string("the ") + of + " do not ascend to " + std::to_string(size));
  return end;
}

/// Block rows: cumulative block sizes, row pointers, block columns, then each block column-major
/// after its number.
void read_blocks(WordReader& words, TextMatrix& matrix) {
  const int blocks = words.count("the number of blocks");
  const int block_rows = words.count("block rows"), block_columns = words.count("block columns");
  const std::vector<int> row_end = read_ends(words, block_rows, matrix.rows, "ends of block rows");
  const std::vector<int> column_end =
      read_ends(words, block_columns, matrix.columns, "ends of block columns");
  const int pointers = words.count("the number of row pointers"),
            indices = words.count("the number of block columns");
  const std::vector<int> begin = words.list<int>(pointers, "row pointers");
  const std::vector<int> column_of = words.list<int>(indices, "block columns");
  words.require(indices >= blocks, "there are fewer block columns than blocks");
  const auto first = [](const std::vector<int>& end, int k) { return k == 0 ? 0 : end[k - 1]; };
  for (int row = 0; row + 1 < pointers; ++row)
    for (int k = begin[row]; k < begin[row + 1]; ++k) {
      words.require(row < block_rows && k < blocks && column_of[k] < block_columns,
                    "block " + std::to_string(k) + " is outside the matrix");
      words.require(words.integer("a block's number") == k, "the blocks are not in order");
      const int row0 = first(row_end, row), column0 = first(column_end, column_of[k]);
      for (int j = column0; j < column_end[column_of[k]]; ++j)
        for (int i = row0; i < row_end[row]; ++i) matrix.add(words, i, j, words.real("a block"));
    }
}

/// Reads CSparse's printed form (six digits only). `words` stands after rows and columns.
void read_sparse(WordReader& words, TextMatrix& matrix) {
  enum Origin { triplet = 1, columns = 2, rows = 3 };
  constexpr const char* of = "a sparse matrix";
  const int origin = words.integer("the origin of a sparse matrix");
  words.require(origin >= triplet && origin <= rows,
                "sparse origin " + std::to_string(origin) + " is not supported");
  // CSparse prints for people: values are behind colons, indices before them, a line's range ahead:
  //
  //     triplet: 6-by-6, nzmax: 2 nnz: 2        6-by-6, nzmax: 2 nnz: 2, 1-norm: 2.5
  //         0 0 : 1.5                               col 0 : locations 0 to 1
  //         3 0 : 2.5                                 0 : 1.5
  words.skip_line();
  words.skip_to(origin == triplet ? "nnz:" : "nzmax:", of);
  const int lines = origin == triplet   ? words.count("the number of entries")
                    : origin == columns ? matrix.columns
                                        : matrix.rows;
  words.skip_line();
  for (int line = 0; line < lines; ++line) {
    int first = 0, last = 0, i = line;
    if (origin == triplet) {
      i = words.integer("a row");
    } else {
      words.skip_to("locations", of);
      first = words.integer("a location");
      words.skip_to("to", of);
      last = words.integer("a location");
    }
    for (int k = first; k <= last; ++k) {
      const int j = words.integer("an index");
      words.skip_to(":", of);
      const double value = words.real(of);
      origin == columns ? matrix.add(words, j, i, value) : matrix.add(words, i, j, value);
    }
  }
}

TextMatrix read_matrix(WordReader& words) {
  const int storage = words.integer("the storage of a matrix");
  words.require(storage >= 0 && storage <= 2,
                "storage " + std::to_string(storage) + " is none of 0 dense, 1 blocks, 2 sparse");
  TextMatrix matrix;
  // Every row and column has an entry in a vector that follows.
  matrix.rows = words.backed_count("rows");
  matrix.columns = words.backed_count("columns");
  constexpr void (*read[])(WordReader&, TextMatrix&) = {read_dense, read_blocks, read_sparse};
  read[storage](words, matrix);
  return matrix;
}

template <typename Sparse>
Sparse sparse(const TextMatrix& matrix) {
  Sparse made(matrix.rows, matrix.columns);
  made.setFromTriplets(matrix.entries.begin(), matrix.entries.end());
  return made;
}

}  // namespace

FrictionProblem read_siconos_text(const std::filesystem::path& file) {
  WordReader words(file);
  const int dimension = words.integer("the dimension");
  words.require(dimension == 3, "dimension " + std::to_string(dimension) + ": only 3 is supported");
  const int contacts = words.backed_count("the number of contacts");
  const TextMatrix first = read_matrix(words);
  words.require(first.rows == first.columns, "the first matrix is not square");
  // Nothing in the file says which form it has. A first matrix with three rows per contact is W,
  // followed by q, unless the head of H follows: storage, rows and columns, all whole numbers.
  bool h_follows = first.rows != 3 * contacts;
  for (int storage = 0; storage <= 2; ++storage)
    h_follows = h_follows || words.next_are({storage, first.rows, 3 * contacts});
  if (!h_follows) {
    Eigen::VectorXd q = as_eigen(words.list<double>(first.rows, "q"));
    return local_problem(sparse<SparseRows>(first), std::move(q),
                         words.list<double>(contacts, "mu"));
  }
  const TextMatrix h = read_matrix(words);
  words.require(
      h.rows == first.rows && h.columns == 3 * contacts,
      printed("H is %d x %d, must be %d x %d", h.rows, h.columns, first.rows, 3 * contacts));
  GlobalProblem global;
  global.m = sparse<Eigen::SparseMatrix<double>>(first);
  global.h = sparse<Eigen::SparseMatrix<double>>(h);
  global.f = as_eigen(words.list<double>(first.rows, "q"));
  global.w = as_eigen(words.list<double>(h.columns, "b"));
  global.mu = words.list<double>(contacts, "mu");
  return to_friction_problem(global);
}

}  // namespace ballast
