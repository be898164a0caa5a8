#include "problems/files/fclib_file.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include "problems/algebra/delassus.hpp"
#include "problems/algebra/mass_root.hpp"

namespace ballast {
namespace {

using SparseColumns = Eigen::SparseMatrix<double>;

/// Groups unknowns into bodies of `size` each and a last one of one unknown that is left. False: M
/// or H forbid it. A constant `size` speeds up the division that every entry of H needs.
template <int size>
bool group(const GlobalProblem& global, Division& division) {
  const int unknowns = static_cast<int>(global.m.rows());
  if (unknowns % size > 1) return false;
  for (int column = 0; column < unknowns; ++column)
    for (SparseColumns::InnerIterator entry(global.m, column); entry; ++entry)
      if (entry.value() != 0.0 && entry.row() / size != column / size) return false;
  division = {};
  for (int first = 0; first < unknowns; first += size)
    division.dof_begin.push_back(std::min(first + size, unknowns));
  const size_t contacts = global.mu.size();
  division.rows.assign(contacts, 3);
  division.body_a.assign(contacts, -1);
  division.body_b.assign(contacts, -1);
  // Column 3 c + k of H is row k of contact c; the unknowns in it say which bodies it touches.
  for (int column = 0; column < global.h.outerSize(); ++column) {
    int &a = division.body_a[column / 3], &b = division.body_b[column / 3];
    for (SparseColumns::InnerIterator entry(global.h, column); entry; ++entry) {
      const int body = static_cast<int>(entry.row()) / size;
      if (entry.value() == 0.0 || body == a || body == b) continue;
      if (b == -1)
        b = body;
      else if (a == -1)
        a = body;
      else
        return false;
    }
  }
  return true;
}

/// W = H^T M^-1 H and q = H^T M^-1 f + w. Uses LU: stored iteration matrices need not be quite
/// symmetric.
FrictionProblem condense(const GlobalProblem& global) {
  // Zero times an entry that is not finite is NaN.
  if (!(global.m * Eigen::VectorXd::Zero(global.m.cols()) +
        global.h * Eigen::VectorXd::Zero(global.h.cols()) + global.f)
           .allFinite() ||
      !global.w.allFinite())
    throw InvalidProblem("M, H, f or w has an entry that is not finite");
  const SparseColumns transposed = global.m.transpose();
  const Eigen::SimplicialLLT<SparseColumns> root(global.m + transposed);
  Eigen::SparseLU<SparseColumns> factor(global.m);
  if (root.info() != Eigen::Success || factor.info() != Eigen::Success)
    throw InvalidProblem("M is not positive definite");
  const SparseColumns solved = factor.solve(global.h);
  return local_problem(global.h.transpose() * solved,
                       global.h.transpose() * factor.solve(global.f) + global.w, global.mu);
}

/// Returns the place of each row of the problem among three per contact.
std::vector<int> file_rows(const FrictionProblem& problem) {
  std::vector<int> rows(problem.row_count());
  for (int c = 0; c < problem.contact_count(); ++c)
    for (int row = problem.row_begin[c]; row < problem.row_begin[c + 1]; ++row)
      rows[row] = 3 * c + row - problem.row_begin[c];
  return rows;
}

}  // namespace

FrictionProblem divided(const GlobalProblem& global, const Division& division) {
  FrictionProblem problem;
  problem.has_dynamics = true;
  DynamicsForm& dynamics = problem.dynamics;
  // M is block diagonal: a body's mass is its diagonal block.
  const std::vector<int>& begin = division.dof_begin;
  for (size_t b = 0; b + 1 < begin.size(); ++b) {
    const int dofs = begin[b + 1] - begin[b];
    dynamics.add_body(global.m.block(begin[b], begin[b], dofs, dofs));
  }
  // FCLIB has u = H^T v + w: a contact is three columns of its H. Their parts in the rows of either
  // body, transposed, are the blocks of our H.
  for (size_t c = 0; c < global.mu.size(); ++c) {
    const int first = 3 * static_cast<int>(c), rows = division.rows[c];
    const auto block_of = [&](int body) -> Eigen::MatrixXd {
      if (body < 0) return Eigen::MatrixXd(rows, 0);
      return global.h.block(begin[body], first, dynamics.body_dofs(body), rows).transpose();
    };
    const int a = division.body_a[c], b = division.body_b[c];
    problem.add_contact(a, b, global.mu[c], block_of(a), block_of(b));
  }
  dynamics.bias = own_rows(problem, global.w);
  return problem;
}

FrictionProblem to_friction_problem(const GlobalProblem& global) {
  const auto sizes = {global.m.rows(), global.m.cols(), global.h.rows(), global.f.size()};
  const Eigen::Index contact_rows = 3 * static_cast<Eigen::Index>(global.mu.size());
  if (std::ranges::count(sizes, global.f.size()) != 4 || global.h.cols() != contact_rows ||
      global.w.size() != contact_rows)
    throw InvalidProblem("the sizes of M, H, f, w and mu do not agree");
  // Takes the first grouping that M and H allow, rigid bodies or points; without one, forms W.
  Division division;
  if (!group<6>(global, division) && !group<3>(global, division)) return condense(global);
  FrictionProblem problem = divided(global, division);
  // f = M v_free is an impulse: v_free is solved for block by block, with the masses' own factors.
  DynamicsForm& dynamics = problem.dynamics;
  dynamics.v_free = global.f;
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const int first = dynamics.dof_begin[b];
    const double* block = dynamics.mass.data() + dynamics.mass_begin[b];
    MassRoot root;
    if (!root.factor(block, dynamics.body_dofs(b)))
      throw InvalidProblem("M(" + std::to_string(first) + ", " + std::to_string(first) + ") = " +
                           std::to_string(block[0]) + ": the block is not positive definite");
    root.solve(dynamics.v_free.data() + first);
  }
  return problem;
}

Eigen::VectorXd three_rows(const FrictionProblem& problem, const Eigen::VectorXd& x) {
  Eigen::VectorXd wide = Eigen::VectorXd::Zero(3 * problem.contact_count());
  wide(file_rows(problem)) = x;
  return wide;
}

Eigen::VectorXd own_rows(const FrictionProblem& problem, const Eigen::VectorXd& wide) {
  return wide(file_rows(problem));
}

GlobalProblem to_global_problem(const FrictionProblem& problem) {
  GlobalProblem global;
  // The file's H is ours transposed. Tangents that a one-row contact lacks are empty columns.
  const SparseRows h = sparse_h(problem);
  const std::vector<int> rows = file_rows(problem);
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < problem.row_count(); ++row)
    for (SparseRows::InnerIterator entry(h, row); entry; ++entry)
      entries.emplace_back(static_cast<int>(entry.col()), rows[row], entry.value());
  global.h.resize(h.cols(), 3 * problem.contact_count());
  global.h.setFromTriplets(entries.begin(), entries.end());
  global.m = sparse_mass(problem.dynamics);
  global.f = global.m * problem.dynamics.v_free;
  global.w = three_rows(problem, problem.dynamics.bias);
  global.mu = problem.friction;
  return global;
}

FrictionProblem condensed(const FrictionProblem& problem) {
  SparseRows w = delassus_matrix(problem);
  Eigen::VectorXd q;
  free_contact_velocity(problem, q);
  const int wide = 3 * problem.contact_count();
  if (problem.row_count() < wide) {
    const std::vector<int> rows = file_rows(problem);
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < problem.row_count(); ++row)
      for (SparseRows::InnerIterator entry(w, row); entry; ++entry)
        entries.emplace_back(rows[row], rows[entry.col()], entry.value());
    w.resize(wide, wide);
    w.setFromTriplets(entries.begin(), entries.end());
    q = three_rows(problem, q);
  }
  return local_problem(std::move(w), std::move(q), problem.friction);
}

// The layout.

namespace {

/// `nz` says how a matrix is stored: the number of triplets, or one of these.
constexpr int compressed_columns = -1, compressed_rows = -2;

/// Reads one matrix group, which must have this size. nzmax may exceed the length of the datasets,
/// which may exceed the number of entries: that one is given by p, or by nz.
template <typename Matrix>
Matrix read_matrix(const Hdf5Reader& file, const std::string& group, int rows, int columns) {
  const auto by = [](int m, int n) { return std::to_string(m) + " x " + std::to_string(n); };
  const int m = file.read_int(group + "/m"), n = file.read_int(group + "/n");
  if (m != rows || n != columns)
    file.fail(group + " is " + by(m, n) + ", must be " + by(rows, columns));
  const int nz = file.read_int(group + "/nz");
  if (nz < compressed_rows)
    file.fail(group + "/nz = " + std::to_string(nz) + " is no known storage");
  const bool by_rows = nz == compressed_rows;
  const int lines = nz >= 0 ? 0 : by_rows ? rows : columns;
  const auto ends = nz < 0 ? std::optional(static_cast<std::size_t>(lines) + 1) : std::nullopt;
  const std::vector<int> p = file.read<int>(group + "/p", ends), i = file.read<int>(group + "/i");
  const std::vector<double> x = file.read<double>(group + "/x");

  if (nz < 0) {
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

  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(count));
  const auto add = [&](int k, int row, int column) {
    if (row < 0 || row >= rows || column < 0 || column >= columns)
      file.fail(group + ": entry " + std::to_string(k) + " at (" + std::to_string(row) + ", " +
                std::to_string(column) + ") is outside " + by(rows, columns));
    if (!std::isfinite(x[k]))
      file.fail(group + "/x[" + std::to_string(k) + "] = " + std::to_string(x[k]) +
                " is not finite");
    entries.emplace_back(row, column, x[k]);
  };
  // A line has the entries from p[line] to before p[line + 1]; i says where in it each stands.
  for (int line = 0; line < lines; ++line)
    for (int k = p[line]; k < p[line + 1]; ++k)
      add(k, by_rows ? line : i[k], by_rows ? i[k] : line);
  // fclib.h says p = rows, i = columns of triplets; all files, and CSparse from which the structure
  // comes, have p = columns, i = rows.
  for (int k = 0; k < nz; ++k) add(k, i[k], p[k]);
  Matrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Refuses plane problems and equality constraints, which are other problems than ours.
void require_unilateral_3d(const Hdf5Reader& file, const std::string& root) {
  const int dimension = file.read_int(root + "/spacedim");
  if (dimension != 3)
    file.fail(root + "/spacedim = " + std::to_string(dimension) + ": only 3 is supported");
  for (const char* bilateral : {"/V", "/R", "/G"})
    if (file.has(root + bilateral))
      file.fail(root + bilateral + ": bilateral constraints are not supported");
}

// The vectors are read first: they set the sizes of the matrices, not the claims of a header.

/// Reads W, q and mu of u = W r + q, with three rows per contact, normal first.
FrictionProblem read_local(const Hdf5Reader& file) {
  const std::string root = "/fclib_local";
  require_unilateral_3d(file, root);
  std::vector<double> mu = read_vector(file, root + "/vectors/mu");
  const int rows = 3 * static_cast<int>(mu.size());
  Eigen::VectorXd q = as_eigen(read_vector(file, root + "/vectors/q", rows));
  return local_problem(read_matrix<SparseRows>(file, root + "/W", rows, rows), std::move(q),
                       std::move(mu));
}

/// Writes compressed storage, since the format leaves the order of a triplet's index arrays open.
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

void add_local(Hdf5Writer& file, const FrictionProblem& local) {
  write_head(file, "/fclib_local");
  write_matrix(file, "/fclib_local/W", local.delassus.w);
  file.add("/fclib_local/vectors/q", local.delassus.q);
  file.add("/fclib_local/vectors/mu", local.friction);
}

void add_global(Hdf5Writer& file, const GlobalProblem& global) {
  write_head(file, "/fclib_global");
  write_matrix(file, "/fclib_global/M", global.m);
  write_matrix(file, "/fclib_global/H", global.h);
  file.add("/fclib_global/vectors/f", global.f);
  file.add("/fclib_global/vectors/w", global.w);
  file.add("/fclib_global/vectors/mu", global.mu);
}

}  // namespace

GlobalProblem read_global(const Hdf5Reader& file) {
  const std::string root = "/fclib_global";
  require_unilateral_3d(file, root);
  GlobalProblem global;
  global.mu = read_vector(file, root + "/vectors/mu");
  global.f = as_eigen(read_vector(file, root + "/vectors/f"));
  const int rows = 3 * static_cast<int>(global.mu.size());
  const int unknowns = static_cast<int>(global.f.size());
  global.w = as_eigen(read_vector(file, root + "/vectors/w", rows));
  global.m = read_matrix<SparseColumns>(file, root + "/M", unknowns, unknowns);
  global.h = read_matrix<SparseColumns>(file, root + "/H", unknowns, rows);
  return global;
}

FrictionProblem read_fclib(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  if (file.has("/fclib_global")) return to_friction_problem(read_global(file));
  if (file.has("/fclib_local")) return read_local(file);
  file.fail("has neither /fclib_local nor /fclib_global");
}

void write_problem(const std::filesystem::path& path, const FrictionProblem& problem,
                   StoredForms forms, const std::function<void(Hdf5Writer&)>& add) {
  problem.validate();
  const bool has_bodies = problem.has_dynamics && forms != StoredForms::delassus;
  Hdf5Writer file(path, Hdf5Storage::plain);
  if (has_bodies) add_global(file, to_global_problem(problem));
  if (!has_bodies || forms == StoredForms::both) add_local(file, condensed(problem));
  if (add) add(file);
  file.commit();
}

void write_solution(const std::filesystem::path& path, const FrictionProblem& problem,
                    const StoredSolution& solution) {
  Eigen::VectorXd u, v;
  contact_velocity(problem, solution.r, u);
  Hdf5Writer file(path, Hdf5Storage::plain);
  file.add_group("/solution");
  file.add("/solution/r", three_rows(problem, solution.r));
  file.add("/solution/u", three_rows(problem, u));
  if (problem.has_dynamics) {
    body_velocity(problem.dynamics, problem.row_begin, solution.r, v);
    file.add("/solution/v", v);
  }
  file.add_group("/ballast_answer");
  for (const auto& [name, value] : solution.numbers)
    file.add("/ballast_answer/" + name, std::vector<double>{value});
  for (const auto& [name, text] : solution.texts) file.add_text("/ballast_answer/" + name, text);
  file.commit();
}

std::vector<double> read_vector(const Hdf5Reader& file, const std::string& path,
                                std::optional<std::size_t> size) {
  std::vector<double> values = file.read<double>(path, size);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      file.fail(path + "[" + std::to_string(i) + "] = " + std::to_string(values[i]) +
                " is not finite");
  return values;
}

Impulses read_impulses(const Hdf5Reader& file, const std::string& dataset,
                       const FrictionProblem& problem) {
  const int rows = 3 * problem.contact_count();
  return own_rows(problem, as_eigen(read_vector(file, dataset, rows)));
}

Impulses read_solution(const std::filesystem::path& path, const FrictionProblem& problem) {
  return read_impulses(Hdf5Reader(path), "/solution/r", problem);
}

}  // namespace ballast
