#include "problems/files/fclib_file.hpp"

#include <cmath>
#include <span>

namespace ballast {
namespace {

/// `nz` says how a matrix is stored: the number of triplets, or one of these.
constexpr int compressed_columns = -1, compressed_rows = -2;

/// So many finite numbers; of any count where `size` is negative.
std::vector<double> read_vector(const Hdf5Reader& file, const std::string& path, int size = -1) {
  std::vector<double> values = file.read_doubles(path);
  if (size >= 0) values = sized(file, path, std::move(values), static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      file.fail(path + "[" + std::to_string(i) + "] = " + std::to_string(values[i]) +
                " is not finite");
  return values;
}

/// One matrix group, which must have this size. nzmax may exceed the datasets' length, which may
/// exceed the entries: p, or nz, decides.
template <typename Matrix>
Matrix read_matrix(const Hdf5Reader& file, const std::string& group, int rows, int columns) {
  const auto by = [](int m, int n) { return std::to_string(m) + " x " + std::to_string(n); };
  const int m = file.read_int(group + "/m"), n = file.read_int(group + "/n");
  if (m != rows || n != columns)
    file.fail(group + " is " + by(m, n) + ", must be " + by(rows, columns));
  const int nz = file.read_int(group + "/nz");
  if (nz < compressed_rows)
    file.fail(group + "/nz = " + std::to_string(nz) + " is no known storage");
  const std::vector<int> p = file.read_ints(group + "/p"), i = file.read_ints(group + "/i");
  const std::vector<double> x = file.read_doubles(group + "/x");

  const bool by_rows = nz == compressed_rows;
  const int lines = nz >= 0 ? 0 : by_rows ? rows : columns;
  if (nz < 0) {
    sized(file, group + "/p", std::span(p), static_cast<std::size_t>(lines) + 1);
    if (p[0] != 0) file.fail(group + "/p[0] = " + std::to_string(p[0]) + ", must be 0");
    for (int line = 0; line < lines; ++line)
      if (p[line + 1] < p[line])
        file.fail(group + "/p[" + std::to_string(line + 1) + "] = " + std::to_string(p[line + 1]) +
                  " decreases");
  }
  const int count = nz >= 0 ? nz : p[lines];
  const auto require = [&](const char* name, std::size_t size) {
    if (size < static_cast<std::size_t>(count))
      file.fail(group + name + " has " + std::to_string(size) + " entries, must have " +
                std::to_string(count));
  };
  if (nz >= 0) require("/p", p.size());
  require("/i", i.size());
  require("/x", x.size());

  const auto each_entry = [&](const auto& visit) {
    // A line has the entries from p[line] to before p[line + 1]; i says where in it each stands.
    for (int line = 0; line < lines; ++line)
      for (int k = p[line]; k < p[line + 1]; ++k)
        visit(k, by_rows ? line : i[k], by_rows ? i[k] : line);
    // fclib.h says p = rows, i = columns of triplets; all files, and CSparse from which the
    // structure comes, have p = columns, i = rows.
    for (int k = 0; k < nz; ++k) visit(k, i[k], p[k]);
  };
  // Lines that are stored as the matrix keeps them, and ascend, are copied.
  bool is_own = nz == (Matrix::IsRowMajor ? compressed_rows : compressed_columns);
  std::pair<int, int> last{-1, -1};
  each_entry([&](int k, int row, int column) {
    if (row < 0 || row >= rows || column < 0 || column >= columns)
      file.fail(group + ": entry " + std::to_string(k) + " at (" + std::to_string(row) + ", " +
                std::to_string(column) + ") is outside " + by(rows, columns));
    if (!std::isfinite(x[k]))
      file.fail(group + "/x[" + std::to_string(k) + "] = " + std::to_string(x[k]) +
                " is not finite");
    const std::pair here = by_rows ? std::pair(row, column) : std::pair(column, row);
    is_own = is_own && last < here;
    last = here;
  });
  if (is_own) return Eigen::Map<const Matrix>(rows, columns, count, p.data(), i.data(), x.data());
  std::vector<Eigen::Triplet<double>> entries;
  each_entry([&](int k, int row, int column) { entries.emplace_back(row, column, x[k]); });
  Matrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
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

// The vectors come first: the sizes of the matrices are theirs, and not what a header claims.

/// W, q and mu of u = W r + q: three rows a contact, normal first.
LocalProblem read_local(const Hdf5Reader& file) {
  const std::string root = "/fclib_local";
  require_unilateral_3d(file, root);
  LocalProblem local;
  local.mu = read_vector(file, root + "/vectors/mu");
  const int rows = 3 * static_cast<int>(local.mu.size());
  local.q = as_eigen(read_vector(file, root + "/vectors/q", rows));
  local.w = read_matrix<SparseRows>(file, root + "/W", rows, rows);
  return local;
}

/// M, H, f, w and mu of M v = H r + f, u = H^T v + w: H has unknowns for rows, contacts for
/// columns.
GlobalProblem read_global(const Hdf5Reader& file) {
  const std::string root = "/fclib_global";
  require_unilateral_3d(file, root);
  using Columns = Eigen::SparseMatrix<double>;
  GlobalProblem global;
  global.mu = read_vector(file, root + "/vectors/mu");
  global.f = as_eigen(read_vector(file, root + "/vectors/f"));
  const int rows = 3 * static_cast<int>(global.mu.size());
  const int unknowns = static_cast<int>(global.f.size());
  global.w = as_eigen(read_vector(file, root + "/vectors/w", rows));
  global.m = read_matrix<Columns>(file, root + "/M", unknowns, unknowns);
  global.h = read_matrix<Columns>(file, root + "/H", unknowns, rows);
  return global;
}

/// Compressed: unlike triplets, the order of whose index arrays the format leaves open.
template <typename Matrix>
void write_matrix(Hdf5Writer& file, const std::string& group, Matrix matrix) {
  matrix.makeCompressed();
  const int entries = static_cast<int>(matrix.nonZeros());
  const auto add = [&](const char* name, const auto* values, Eigen::Index size) {
    const auto count = static_cast<std::size_t>(size);
    file.add(group + name, std::span(values, count), {count});
  };
  const auto add_int = [&](const char* name, Eigen::Index value) {
    const int number = static_cast<int>(value);
    add(name, &number, 1);
  };
  file.add_group(group);
  add_int("/m", matrix.rows());
  add_int("/n", matrix.cols());
  add_int("/nz", Matrix::IsRowMajor ? compressed_rows : compressed_columns);
  add_int("/nzmax", entries);
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

void add_local(Hdf5Writer& file, const LocalProblem& local) {
  write_head(file, "/fclib_local");
  write_matrix(file, "/fclib_local/W", local.w);
  file.add("/fclib_local/vectors/q", as_vector(local.q));
  file.add("/fclib_local/vectors/mu", local.mu);
}

void add_global(Hdf5Writer& file, const GlobalProblem& global) {
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

void write_problem(const std::filesystem::path& path, const FrictionProblem& problem,
                   StoredForms forms, const std::function<void(Hdf5Writer&)>& add) {
  problem.validate();
  const bool has_bodies = problem.has_dynamics && forms != StoredForms::delassus;
  with_problem_file_errors([&] {
    Hdf5Writer file(path, Hdf5Storage::plain);
    if (has_bodies) add_global(file, to_global_problem(problem));
    if (!has_bodies || forms == StoredForms::both) add_local(file, condensed(problem));
    if (add) add(file);
    file.commit();
  });
}

void write_solution(const std::filesystem::path& path, const FrictionProblem& problem,
                    const StoredSolution& solution) {
  Eigen::VectorXd u, v;
  contact_velocity(problem, solution.r, u);
  with_problem_file_errors([&] {
    Hdf5Writer file(path, Hdf5Storage::plain);
    file.add_group("/solution");
    file.add("/solution/r", as_vector(three_rows(problem, solution.r)));
    file.add("/solution/u", as_vector(three_rows(problem, u)));
    if (problem.has_dynamics) {
      body_velocity(problem.dynamics, problem.row_begin, solution.r, v);
      file.add("/solution/v", as_vector(v));
    }
    file.add_group("/ballast_answer");
    for (const auto& [name, value] : solution.numbers)
      file.add("/ballast_answer/" + name, std::vector<double>{value});
    for (const auto& [name, text] : solution.texts) file.add_text("/ballast_answer/" + name, text);
    file.commit();
  });
}

Impulses read_solution(const std::filesystem::path& path, const FrictionProblem& problem) {
  return with_problem_file_errors([&] {
    const int rows = 3 * problem.contact_count();
    return own_rows(problem, as_eigen(read_vector(Hdf5Reader(path), "/solution/r", rows)));
  });
}

}  // namespace ballast
