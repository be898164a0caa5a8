#include "problems/algebra/friction_problem.hpp"

#include <string>

#include "problems/algebra/mass_root.hpp"

namespace ballast {
namespace {

/// u += B v for a column-major block of Rows x dofs. The sums are local: the compiler cannot know
/// that u is not part of B.
template <int Rows>
[[gnu::always_inline]] inline void multiply_add(const double* block, int dofs, const double* v,
                                                double* u) {
  double sum[Rows];
  for (int i = 0; i < Rows; ++i) sum[i] = u[i];
  for (int k = 0; k < dofs; ++k)
    for (int i = 0; i < Rows; ++i) sum[i] += block[k * Rows + i] * v[k];
  for (int i = 0; i < Rows; ++i) u[i] = sum[i];
}

/// v += B^T r.
template <int Rows>
[[gnu::always_inline]] inline void transposed_multiply_add(const double* block, int dofs,
                                                           const double* r, double* v) {
  double weight[Rows];
  for (int i = 0; i < Rows; ++i) weight[i] = r[i];
  for (int k = 0; k < dofs; ++k) {
    double sum = 0.0;
    for (int i = 0; i < Rows; ++i) sum += block[k * Rows + i] * weight[i];
    v[k] += sum;
  }
}

/// One contact's rows of H v; the six unknowns of a rigid body are known to the compiler, which
/// unrolls.
template <int Rows>
inline void contact_row_velocity(const DynamicsForm& dynamics, int c, const double* v, double* u) {
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
    // A side that does not move has no block.
    if (body < 0) continue;
    const int dofs = dynamics.body_dofs(body);
    const double* vb = v + dynamics.dof_begin[body];
    if (dofs == 6)
      multiply_add<Rows>(block, 6, vb, u);
    else
      multiply_add<Rows>(block, dofs, vb, u);
    block += Rows * dofs;
  }
}

/// One contact's part of H^T r.
template <int Rows>
inline void add_contact_impulse(const DynamicsForm& dynamics, int c, const double* r, double* v) {
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
    if (body < 0) continue;
    const int dofs = dynamics.body_dofs(body);
    double* vb = v + dynamics.dof_begin[body];
    if (dofs == 6)
      transposed_multiply_add<Rows>(block, 6, r, vb);
    else
      transposed_multiply_add<Rows>(block, dofs, r, vb);
    block += Rows * dofs;
  }
}

void require_rows(const char* name, Eigen::Index size, int rows) {
  if (size != rows)
    throw InvalidProblem(std::string(name) + " has " + std::to_string(size) +
                         " entries, the contacts have " + std::to_string(rows) + " rows");
}

}  // namespace

void DynamicsForm::clear() {
  dof_begin.assign(1, 0);
  mass_begin.assign(1, 0);
  mass.clear();
  body_a.clear();
  body_b.clear();
  h_begin.assign(1, 0);
  h.clear();
}

void FrictionProblem::clear() {
  row_begin.assign(1, 0);
  friction.clear();
  has_dynamics = false;
  has_delassus = false;
  dynamics.clear();
}

void body_to_contact_velocity(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                              const Eigen::VectorXd& v, int begin, int end, Eigen::VectorXd& u) {
  // u begins as the bias, and every contact adds its rows of H v.
  for (int i = row_begin[begin]; i < row_begin[end]; ++i) u[i] = dynamics.bias[i];
  for (int c = begin; c < end; ++c) {
    double* uc = u.data() + row_begin[c];
    if (row_begin[c + 1] - row_begin[c] == 3)
      contact_row_velocity<3>(dynamics, c, v.data(), uc);
    else
      contact_row_velocity<1>(dynamics, c, v.data(), uc);
  }
}

void body_to_contact_velocity(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                              const Eigen::VectorXd& v, Eigen::VectorXd& u) {
  u.resize(row_begin.back());
  body_to_contact_velocity(dynamics, row_begin, v, 0, static_cast<int>(row_begin.size()) - 1, u);
}

/// p = H^T r, contact by contact.
void contact_to_body_impulse(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                             const Impulses& r, Eigen::VectorXd& p) {
  p.setZero(dynamics.dof_count());
  const int contacts = static_cast<int>(row_begin.size()) - 1;
  for (int c = 0; c < contacts; ++c) {
    const double* rc = r.data() + row_begin[c];
    if (row_begin[c + 1] - row_begin[c] == 3)
      add_contact_impulse<3>(dynamics, c, rc, p.data());
    else
      add_contact_impulse<1>(dynamics, c, rc, p.data());
  }
}

/// q of u = W r + q: the contacts' velocities without any impulse.
void free_contact_velocity(const FrictionProblem& problem, Eigen::VectorXd& q) {
  if (problem.has_dynamics)
    body_to_contact_velocity(problem.dynamics, problem.row_begin, problem.dynamics.v_free, q);
  else
    q = problem.delassus.q;
}

void contact_velocity(const FrictionProblem& problem, const Impulses& r, Eigen::VectorXd& u) {
  require_rows("impulses", r.size(), problem.row_count());
  // u = H v + bias with the bodies' velocities under the impulses, or u = W r + q as it is stored.
  if (problem.has_dynamics) {
    Eigen::VectorXd v;
    body_velocity(problem.dynamics, problem.row_begin, r, v);
    body_to_contact_velocity(problem.dynamics, problem.row_begin, v, u);
  } else {
    u = problem.delassus.q;
    u.noalias() += problem.delassus.w * r;
  }
}

void body_velocity(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                   const Impulses& r, Eigen::VectorXd& v) {
  require_rows("impulses", r.size(), row_begin.back());
  // M^-1 H^T r, body by body.
  contact_to_body_impulse(dynamics, row_begin, r, v);
  MassRoot root;
  for (int b = 0; b < dynamics.body_count(); ++b) {
    double* vb = v.data() + dynamics.dof_begin[b];
    if (!root.factor(dynamics.mass.data() + dynamics.mass_begin[b], dynamics.body_dofs(b)))
      throw InvalidProblem("dynamics.mass: the block of body " + std::to_string(b) +
                           " is not positive definite");
    root.solve_lower(vb);
    root.solve_upper(vb);
  }
  v += dynamics.v_free;
}

Eigen::SparseMatrix<double> sparse_mass(const DynamicsForm& dynamics) {
  // Zeros beside the diagonal are left out: most masses are diagonal.
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(dynamics.mass.size());
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const int dofs = dynamics.body_dofs(b), first = dynamics.dof_begin[b];
    const double* block = dynamics.mass.data() + dynamics.mass_begin[b];
    for (int j = 0; j < dofs; ++j)
      for (int i = 0; i < dofs; ++i)
        if (i == j || block[j * dofs + i] != 0.0)
          entries.emplace_back(first + i, first + j, block[j * dofs + i]);
  }
  Eigen::SparseMatrix<double> mass(dynamics.dof_count(), dynamics.dof_count());
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

SparseRows sparse_h(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(dynamics.h.size());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int rows = problem.contact_rows(c);
    const double* block = dynamics.h.data() + dynamics.h_begin[c];
    for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
      const int dofs = dynamics.body_dofs(body);
      for (int k = 0; k < dofs; ++k)
        for (int i = 0; i < rows; ++i)
          entries.emplace_back(problem.row_begin[c] + i, dynamics.dof_begin[body] + k,
                               block[k * rows + i]);
      block += rows * dofs;
    }
  }
  SparseRows h(problem.row_count(), dynamics.dof_count());
  h.setFromTriplets(entries.begin(), entries.end());
  return h;
}

}  // namespace ballast
