#include "problems/files/fclib_file.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "platform/hdf5_file.hpp"
#include "problems/files/problem_file_error.hpp"

namespace ballast {
namespace {

/// `nz` says how a matrix is stored: the number of triplets, or one of these.
constexpr int compressed_columns = -1, compressed_rows = -2;

using Triplets = std::vector<Eigen::Triplet<double>>;

void require_size(const Hdf5Reader& file, const std::string& path, std::size_t size,
                  std::size_t expected) {
  if (size != expected)
    file.fail(path + " has " + std::to_string(size) + " entries, must have " +
              std::to_string(expected));
}

std::vector<double> read_vector(const Hdf5Reader& file, const std::string& path, std::size_t size) {
  std::vector<double> values = file.read_doubles(path);
  require_size(file, path, values.size(), size);
  for (std::size_t i = 0; i < size; ++i)
    if (!std::isfinite(values[i]))
      file.fail(path + "[" + std::to_string(i) + "] = " + std::to_string(values[i]) +
                " is not finite");
  return values;
}

/// Reads one matrix group. nzmax may exceed the datasets' length, which may exceed the entries: p,
/// or nz, decides.
class MatrixReader {
 public:
  MatrixReader(const Hdf5Reader& file, std::string group)
      : file_(file),
        group_(std::move(group)),
        rows_(file.read_int(group_ + "/m")),
        columns_(file.read_int(group_ + "/n")),
        nz_(file.read_int(group_ + "/nz")),
        p_(file.read_ints(group_ + "/p")),
        i_(file.read_ints(group_ + "/i")),
        x_(file.read_doubles(group_ + "/x")) {
    if (rows_ < 0 || columns_ < 0)
      file.fail(group_ + ": " + std::to_string(rows_) + " x " + std::to_string(columns_) +
                " is no size of a matrix");
    if (nz_ < compressed_rows)
      file.fail(group_ + "/nz = " + std::to_string(nz_) + " is no known storage");
  }

  int rows() const { return rows_; }
  int columns() const { return columns_; }

  /// Rows or columns that are stored as the matrix keeps them are copied.
  template <typename Matrix>
  Matrix matrix() const {
    constexpr int own = Matrix::IsRowMajor ? compressed_rows : compressed_columns;
    Triplets entries;
    bool is_sorted = false;
    if (nz_ >= 0)
      read_triplets(entries);
    else
      is_sorted = read_compressed(nz_ == own ? nullptr : &entries);
    if (nz_ == own && !is_sorted) read_compressed(&entries);
    Matrix matrix(rows_, columns_);
    if (nz_ != own || !is_sorted) {
      matrix.setFromTriplets(entries.begin(), entries.end());
      return matrix;
    }
    const int count = p_.back();
    matrix.resizeNonZeros(count);
    std::copy(p_.begin(), p_.end(), matrix.outerIndexPtr());
    std::copy_n(i_.begin(), count, matrix.innerIndexPtr());
    std::copy_n(x_.begin(), count, matrix.valuePtr());
    return matrix;
  }

 private:
  void require_entry(int row, int column, int k) const {
    if (row < 0 || row >= rows_ || column < 0 || column >= columns_)
      file_.fail(group_ + ": entry " + std::to_string(k) + " at (" + std::to_string(row) + ", " +
                 std::to_string(column) + ") is outside " + std::to_string(rows_) + " x " +
                 std::to_string(columns_));
    if (!std::isfinite(x_[k]))
      file_.fail(group_ + "/x[" + std::to_string(k) + "] = " + std::to_string(x_[k]) +
                 " is not finite");
  }

  void require_entries(int count) const {
    for (const auto& [name, size] : {std::pair{"/i", i_.size()}, std::pair{"/x", x_.size()}})
      if (size < static_cast<std::size_t>(count))
        file_.fail(group_ + name + " has " + std::to_string(size) + " entries, must have " +
                   std::to_string(count));
  }

  /// fclib.h says p = rows, i = columns; all files, and CSparse from which the structure comes,
  /// have p = columns, i = rows.
  void read_triplets(Triplets& entries) const {
    require_entries(nz_);
    if (p_.size() < static_cast<std::size_t>(nz_))
      file_.fail(group_ + "/p has " + std::to_string(p_.size()) + " entries, must have " +
                 std::to_string(nz_));
    for (int k = 0; k < nz_; ++k) {
      require_entry(i_[k], p_[k], k);
      entries.emplace_back(i_[k], p_[k], x_[k]);
    }
  }

  /// Whether the entries of every line ascend; they are added to `entries` unless that is null.
  bool read_compressed(Triplets* entries) const {
    const bool by_rows = nz_ == compressed_rows;
    const int lines = by_rows ? rows_ : columns_;
    require_size(file_, group_ + "/p", p_.size(), static_cast<std::size_t>(lines) + 1);
    if (p_[0] != 0) file_.fail(group_ + "/p[0] = " + std::to_string(p_[0]) + ", must be 0");
    for (int line = 0; line < lines; ++line)
      if (p_[line + 1] < p_[line])
        file_.fail(group_ + "/p[" + std::to_string(line + 1) +
                   "] = " + std::to_string(p_[line + 1]) + " decreases");
    require_entries(p_[lines]);
    bool is_sorted = true;
    // A line has the entries from p[line] to before p[line + 1]; i says where in it each stands.
    for (int line = 0; line < lines; ++line)
      for (int k = p_[line]; k < p_[line + 1]; ++k) {
        const int row = by_rows ? line : i_[k], column = by_rows ? i_[k] : line;
        require_entry(row, column, k);
        is_sorted = is_sorted && (k == p_[line] || i_[k] > i_[k - 1]);
        if (entries) entries->emplace_back(row, column, x_[k]);
      }
    return is_sorted;
  }

  const Hdf5Reader& file_;
  std::string group_;
  int rows_, columns_, nz_;
  std::vector<int> p_, i_;
  std::vector<double> x_;
};

void require_shape(const Hdf5Reader& file, const std::string& group, const MatrixReader& matrix,
                   int rows, int columns) {
  if (matrix.rows() != rows || matrix.columns() != columns)
    file.fail(group + " is " + std::to_string(matrix.rows()) + " x " +
              std::to_string(matrix.columns()) + ", must be " + std::to_string(rows) + " x " +
              std::to_string(columns));
}

/// Plane problems and equality constraints are other problems than ours.
void require_unilateral_3d(const Hdf5Reader& file, const std::string& root) {
  const int dimension = file.read_int(root + "/spacedim");
  if (dimension != 3)
    file.fail(root + "/spacedim = " + std::to_string(dimension) + ": only 3 is supported");
  for (const char* bilateral : {"/V", "/R", "/G"})
    if (file.has(root + bilateral))
      file.fail(root + bilateral + ": bilateral constraints are not supported");
}

int contact_count(const Hdf5Reader& file, const std::string& group, int rows) {
  if (rows % 3 != 0)
    file.fail(group + " has " + std::to_string(rows) + " contact rows, which is no multiple of 3");
  return rows / 3;
}

/// W, q and mu of u = W r + q: three rows a contact, normal first.
LocalProblem read_local(const Hdf5Reader& file) {
  const std::string root = "/fclib_local";
  require_unilateral_3d(file, root);
  const MatrixReader w(file, root + "/W");
  const int contacts = contact_count(file, root + "/W", w.rows());
  require_shape(file, root + "/W", w, 3 * contacts, 3 * contacts);
  LocalProblem local;
  // The vectors first: the sizes of the matrices are theirs, and not only what a header claims.
  local.q = as_eigen(read_vector(file, root + "/vectors/q", w.rows()));
  local.mu = read_vector(file, root + "/vectors/mu", contacts);
  local.w = w.matrix<SparseRows>();
  return local;
}

/// M, H, f, w and mu of M v = H r + f, u = H^T v + w: H has unknowns
/// for rows, contacts for columns.
GlobalProblem read_global(const Hdf5Reader& file) {
  const std::string root = "/fclib_global";
  require_unilateral_3d(file, root);
  const MatrixReader m(file, root + "/M"), h(file, root + "/H");
  const int contacts = contact_count(file, root + "/H", h.columns());
  require_shape(file, root + "/M", m, m.rows(), m.rows());
  require_shape(file, root + "/H", h, m.rows(), 3 * contacts);
  GlobalProblem global;
  global.f = as_eigen(read_vector(file, root + "/vectors/f", m.rows()));
  global.w = as_eigen(read_vector(file, root + "/vectors/w", 3 * contacts));
  global.mu = read_vector(file, root + "/vectors/mu", contacts);
  global.m = m.matrix<Eigen::SparseMatrix<double>>();
  global.h = h.matrix<Eigen::SparseMatrix<double>>();
  return global;
}

/// Compressed: unlike triplets, the order of whose index arrays the format leaves open.
template <typename Matrix>
void write_matrix(Hdf5Writer& file, const std::string& group, const Matrix& matrix) {
  if (!matrix.isCompressed()) {
    Matrix copy = matrix;
    copy.makeCompressed();
    return write_matrix(file, group, copy);
  }
  const int entries = static_cast<int>(matrix.nonZeros());
  const auto add = [&](const std::string& name, const auto* values, Eigen::Index size) {
    const auto count = static_cast<std::size_t>(size);
    file.add(group + name, std::span(values, count), {count});
  };
  file.add_group(group);
  file.add(group + "/m", std::vector<int>{static_cast<int>(matrix.rows())});
  file.add(group + "/n", std::vector<int>{static_cast<int>(matrix.cols())});
  file.add(group + "/nz",
           std::vector<int>{Matrix::IsRowMajor ? compressed_rows : compressed_columns});
  file.add(group + "/nzmax", std::vector<int>{entries});
  add("/p", matrix.outerIndexPtr(), matrix.outerSize() + 1);
  add("/i", matrix.innerIndexPtr(), entries);
  add("/x", matrix.valuePtr(), entries);
}

void write_head(Hdf5Writer& file, const std::string& root) {
  file.add_group(root);
  file.add(root + "/spacedim", std::vector<int>{3});
  file.add_group(root + "/vectors");
  file.add_group(root + "/info");
  file.add_text(root + "/info/title", "ballast");
  file.add_text(root + "/info/description", "frictional contact problem, normal first");
  file.add_text(root + "/info/math_info", "-");
}

void add_fclib(Hdf5Writer& file, const LocalProblem& local) {
  write_head(file, "/fclib_local");
  write_matrix(file, "/fclib_local/W", local.w);
  file.add("/fclib_local/vectors/q", as_vector(local.q));
  file.add("/fclib_local/vectors/mu", local.mu);
}

void add_fclib(Hdf5Writer& file, const GlobalProblem& global) {
  write_head(file, "/fclib_global");
  write_matrix(file, "/fclib_global/M", global.m);
  write_matrix(file, "/fclib_global/H", global.h);
  file.add("/fclib_global/vectors/f", as_vector(global.f));
  file.add("/fclib_global/vectors/w", as_vector(global.w));
  file.add("/fclib_global/vectors/mu", global.mu);
}

}  // namespace

std::variant<LocalProblem, GlobalProblem> read_fclib(const std::filesystem::path& path) {
  using Stored = std::variant<LocalProblem, GlobalProblem>;
  return with_problem_file_errors([&]() -> Stored {
    const Hdf5Reader file(path);
    if (file.has("/fclib_global")) return read_global(file);
    if (file.has("/fclib_local")) return read_local(file);
    file.fail("has neither /fclib_local nor /fclib_global");
  });
}

void write_fclib(const std::filesystem::path& path,
                 const std::variant<LocalProblem, GlobalProblem>& problem,
                 const std::function<void(Hdf5Writer&)>& add) {
  with_problem_file_errors([&] {
    Hdf5Writer file(path, Hdf5Storage::plain);
    std::visit([&](const auto& form) { add_fclib(file, form); }, problem);
    if (add) add(file);
    file.commit();
  });
}

void write_problem_forms(const std::filesystem::path& file, const FrictionProblem& problem,
                         const std::function<void(Hdf5Writer&)>& add) {
  problem.validate();
  const LocalProblem local = condensed(problem);
  if (!problem.has_dynamics) return write_fclib(file, local, add);
  write_fclib(file, to_global_problem(problem), [&](Hdf5Writer& opened) {
    add_fclib(opened, local);
    if (add) add(opened);
  });
}

void write_problem(const std::filesystem::path& file, const FrictionProblem& problem,
                   const std::function<void(Hdf5Writer&)>& add) {
  problem.validate();
  if (problem.has_dynamics)
    write_fclib(file, to_global_problem(problem), add);
  else
    write_fclib(file, to_local_problem(problem), add);
}

}  // namespace ballast
