#include "solvers/parts/newton_system.hpp"

#include <algorithm>
#include <array>

namespace ballast {
namespace {

/// |right - A x| over |right|, above which an LU without exchanged rows is not trusted.
constexpr double most_rest = 1e-8;

int body_of(const DynamicsForm& d, int c, int side) {
  return side == 0 ? d.body_a[c] : d.body_b[c];
}

/// H of contact c with respect to the body of one side: column-major, rows x dofs.
const double* side_block(const FrictionProblem& problem, int c, int side) {
  const DynamicsForm& d = problem.dynamics;
  const double* h = d.h.data() + d.h_begin[c];
  return side == 0 ? h : h + problem.contact_rows(c) * d.body_dofs(d.body_a[c]);
}

}  // namespace

void NewtonSystem::prepare(const ContactOperator& w) {
  operations_ = 0.0;
  if (w.problem().has_dynamics)
    prepare_bodies(w.problem());
  else
    matrix_form_.prepare(w.problem());
}

void NewtonSystem::prepare_bodies(const FrictionProblem& problem) {
  const DynamicsForm& d = problem.dynamics;
  const int bodies = d.body_count(), contacts = problem.contact_count();
  // neighbours of every body, itself among them, sorted
  std::vector<std::vector<int>> near(bodies);
  for (int b = 0; b < bodies; ++b) near[b].push_back(b);
  for (int c = 0; c < contacts; ++c) {
    const int a = d.body_a[c], b = d.body_b[c];
    if (a < 0 || b < 0) continue;
    near[a].push_back(b);
    near[b].push_back(a);
  }
  std::vector<std::vector<int>> first(bodies);  // of each neighbour's rows in a column of the body
  std::vector<int> column_entries(bodies, 0);
  for (int b = 0; b < bodies; ++b) {
    std::sort(near[b].begin(), near[b].end());
    near[b].erase(std::unique(near[b].begin(), near[b].end()), near[b].end());
    for (const int n : near[b]) {
      first[b].push_back(column_entries[b]);
      column_entries[b] += d.body_dofs(n);
    }
  }
  const auto find = [&](int row_body, int column_body) {
    const auto& list = near[column_body];
    return first[column_body][std::lower_bound(list.begin(), list.end(), row_body) - list.begin()];
  };
  // The pattern of M + H^T E H: a body's columns have the rows of all its neighbours.
  matrix_.resize(d.dof_count(), d.dof_count());
  int entries = 0;
  for (int b = 0; b < bodies; ++b) entries += column_entries[b] * d.body_dofs(b);
  matrix_.resizeNonZeros(entries);
  int* outer = matrix_.outerIndexPtr();
  int* inner = matrix_.innerIndexPtr();
  int at = 0;
  for (int b = 0; b < bodies; ++b)
    for (int k = 0; k < d.body_dofs(b); ++k) {
      outer[d.dof_begin[b] + k] = at;
      for (const int n : near[b])
        for (int i = 0; i < d.body_dofs(n); ++i) inner[at++] = d.dof_begin[n] + i;
    }
  outer[d.dof_count()] = at;
  // Where each contact's four blocks and each body's mass go.
  offset_.assign(contacts, {-1, -1, -1, -1});
  for (int c = 0; c < contacts; ++c)
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) {
        const int row = body_of(d, c, p), column = body_of(d, c, q);
        if (row >= 0 && column >= 0) offset_[c][2 * p + q] = find(row, column);
      }
  mass_offset_.resize(bodies);
  for (int b = 0; b < bodies; ++b) mass_offset_[b] = find(b, b);
  fronts_.analyse(matrix_, d.dof_begin);
  operations_ = fronts_.operations();
}

void NewtonSystem::add_block(const FrictionProblem& problem, int c, int p, int q,
                             const Eigen::Matrix3d& e) {
  const DynamicsForm& d = problem.dynamics;
  const int offset = offset_[c][2 * p + q];
  if (offset < 0) return;
  const int rows = problem.contact_rows(c);
  const int left = body_of(d, c, p), right = body_of(d, c, q);
  const int left_dofs = d.body_dofs(left), right_dofs = d.body_dofs(right);
  const double* hp = side_block(problem, c, p);
  const double* hq = side_block(problem, c, q);
  const int* outer = matrix_.outerIndexPtr();
  // Column by column: E times a column of H_q, then H_p^T times that.
  for (int j = 0; j < right_dofs; ++j) {
    double eh[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < rows; ++i)
      for (int k = 0; k < rows; ++k) eh[i] += e(i, k) * hq[j * rows + k];
    double* column = matrix_.valuePtr() + outer[d.dof_begin[right] + j] + offset;
    for (int i = 0; i < left_dofs; ++i)
      for (int k = 0; k < rows; ++k) column[i] += hp[i * rows + k] * eh[k];
  }
}

bool NewtonSystem::solve_matrix() {
  // Rows need not be exchanged nearly always: then the LU over bodies is up to ten times faster.
  if (fronts_.factor(matrix_)) {
    fronts_.solve(right_, dv_);
    // Refined once, as the other way is.
    rest_ = right_;
    rest_.noalias() -= matrix_ * dv_;
    fronts_.solve(rest_, correction_);
    dv_ += correction_;
    rest_.noalias() -= matrix_ * correction_;
    if (rest_.norm() <= most_rest * right_.norm()) return true;
  }
  if (!factor_.factor(matrix_)) return false;
  factor_.solve(matrix_, right_, dv_, 1);
  return dv_.allFinite();
}

bool NewtonSystem::solve_bodies(const ContactOperator& w,
                                const std::vector<ContactLinearisation>& linear,
                                const std::vector<double>& alpha, Impulses& dr) {
  const FrictionProblem& problem = w.problem();
  const DynamicsForm& d = problem.dynamics;
  // The masses.
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  for (int b = 0; b < d.body_count(); ++b) {
    const int n = d.body_dofs(b);
    const double* mass = d.mass.data() + d.mass_begin[b];
    for (int j = 0; j < n; ++j) {
      double* column =
          matrix_.valuePtr() + matrix_.outerIndexPtr()[d.dof_begin[b] + j] + mass_offset_[b];
      for (int i = 0; i < n; ++i) column[i] = mass[j * n + i];
    }
  }
  // B^-1 f and E = B^-1 by_u of every contact, and H^T E H.
  // The contacts' equations give dr = -B^-1 f - E du, du = H dv, and the bodies' M dv = H^T dr.
  gain_.resize(linear.size());
  source_.resize(linear.size());
  dr.resize(problem.row_count());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const Eigen::Matrix3d inverse = (linear[c].by_r + alpha[c] * linear[c].by_u).inverse();
    source_[c] = inverse * linear[c].f;
    gain_[c] = inverse * linear[c].by_u;
    if (problem.contact_rows(c) == 1)
      gain_[c] = Eigen::Vector3d(gain_[c](0, 0), 0.0, 0.0).asDiagonal();
    if (!source_[c].allFinite() || !gain_[c].allFinite()) return false;
    w.put(dr, c, -source_[c]);
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) add_block(problem, c, p, q, gain_[c]);
  }
  // dv, and from it the impulses that were eliminated.
  contact_to_body_impulse(d, problem.row_begin, dr, right_);
  if (!solve_matrix()) return false;
  body_to_contact_velocity(d, problem.row_begin, dv_, u_);
  // It adds the bias, which a change of velocity has not.
  u_ -= d.bias;
  for (int c = 0; c < problem.contact_count(); ++c)
    w.put(dr, c, -source_[c] - gain_[c] * w.at(u_, c));
  return true;
}

bool NewtonSystem::solve(const ContactOperator& w, const std::vector<ContactLinearisation>& linear,
                         const std::vector<double>& alpha, Impulses& dr) {
  if (w.problem().has_dynamics) return solve_bodies(w, linear, alpha, dr);
  const bool is_solved = matrix_form_.solve(linear, alpha, dr);
  operations_ = matrix_form_.operations();
  return is_solved;
}

}  // namespace ballast
