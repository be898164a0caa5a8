#include "tests/problems/algebra/dense_oracle.hpp"

namespace ballast::oracle {

Eigen::MatrixXd dense_mass(const FrictionProblem& problem) {
  const DynamicsForm& d = problem.dynamics;
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(d.dof_count(), d.dof_count());
  for (int b = 0; b < d.body_count(); ++b) {
    const int n = d.dof_begin[b + 1] - d.dof_begin[b];
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        mass(d.dof_begin[b] + i, d.dof_begin[b] + j) = d.mass[d.mass_begin[b] + j * n + i];
  }
  return mass;
}

Eigen::MatrixXd dense_h(const FrictionProblem& problem) {
  const DynamicsForm& d = problem.dynamics;
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(problem.row_count(), d.dof_count());
  for (int c = 0; c < problem.contact_count(); ++c) {
    int entry = d.h_begin[c];
    for (const int body : {d.body_a[c], d.body_b[c]}) {
      if (body < 0) continue;
      for (int k = d.dof_begin[body]; k < d.dof_begin[body + 1]; ++k)
        for (int i = problem.row_begin[c]; i < problem.row_begin[c + 1]; ++i)
          h(i, k) = d.h[entry++];
    }
  }
  return h;
}

Eigen::MatrixXd dense_delassus(const FrictionProblem& problem) {
  const Eigen::MatrixXd h = dense_h(problem);
  return h * dense_mass(problem).llt().solve(h.transpose());
}

Eigen::VectorXd dense_q(const FrictionProblem& problem) {
  return dense_h(problem) * problem.dynamics.v_free + problem.dynamics.bias;
}

Eigen::VectorXd dense_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.partialPivLu().solve(b);
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

FrictionProblem mixed_problem() {
  FrictionProblem p;
  p.has_dynamics = true;
  DynamicsForm& d = p.dynamics;
  double next = 0.37;  // numbers without a pattern, from the logistic map
  const auto number = [&next] { return (next = 3.99 * next * (1.0 - next)) - 0.5; };
  for (const int dofs : {6, 3, 1}) {
    Eigen::MatrixXd a(dofs, dofs);
    for (double& x : a.reshaped()) x = number();
    d.add_body(a * a.transpose() + 2.0 * Eigen::MatrixXd::Identity(dofs, dofs));
  }
  const int a[] = {0, -1, 1, 2, -1, 0, -1}, b[] = {1, 0, 2, -1, -1, 2, 1},
            rows[] = {3, 3, 1, 3, 3, 3, 1};
  for (int c = 0; c < 7; ++c) {
    Eigen::MatrixXd of_a(rows[c], d.body_dofs(a[c])), of_b(rows[c], d.body_dofs(b[c]));
    for (Eigen::MatrixXd* block : {&of_a, &of_b})
      for (double& x : block->reshaped()) x = 2.0 * number();
    p.add_contact(a[c], b[c], rows[c] == 3 ? 0.1 * (c + 1) : 0.0, of_a, of_b);
  }
  d.v_free.resize(d.dof_count());
  for (double& x : d.v_free) x = number();
  d.bias.resize(p.row_count());
  for (double& x : d.bias) x = number();
  return p;
}

}  // namespace ballast::oracle
