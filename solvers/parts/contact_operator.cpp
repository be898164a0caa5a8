#include "solvers/parts/contact_operator.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"

namespace ballast {

void ContactOperator::prepare(const FrictionProblem& problem) {
  problem_ = &problem;
  delassus_diagonal(problem, roots_, diagonal_);
  rho_.resize(diagonal_.size());
  for (std::size_t c = 0; c < rho_.size(); ++c) {
    const double lambda_max = largest_eigenvalue(diagonal_[c]);
    rho_[c] = lambda_max > 0.0 ? 1.0 / lambda_max : 0.0;
  }
}

void ContactOperator::push_bodies(const Impulses& r) {
  contact_to_body_impulse(problem_->dynamics, problem_->row_begin, r, v_);
  solve_masses(problem_->dynamics, roots_, v_);
}

void ContactOperator::velocity(const Impulses& r, Eigen::VectorXd& u) {
  if (!problem_->has_dynamics) {
    u = problem_->delassus.q;
    u.noalias() += problem_->delassus.w * r;
    return;
  }
  push_bodies(r);
  // u = H (v_free + M^-1 H^T r) + bias.
  v_ += problem_->dynamics.v_free;
  body_to_contact_velocity(problem_->dynamics, problem_->row_begin, v_, u);
}

void ContactOperator::multiply(const Impulses& r, Eigen::VectorXd& w) {
  if (!problem_->has_dynamics) {
    w.noalias() = problem_->delassus.w * r;
    return;
  }
  push_bodies(r);
  body_to_contact_velocity(problem_->dynamics, problem_->row_begin, v_, w);
  // body_to_contact_velocity() adds the bias, which is no part of the product.
  w -= problem_->dynamics.bias;
}

void ContactOperator::project(Impulses& r) const {
  for (int c = 0; c < contact_count(); ++c)
    put(r, c, rho_[c] > 0.0 ? project_cone(at(r, c), friction(c)) : Eigen::Vector3d::Zero());
}

double ContactOperator::project_and_evaluate(Impulses& r, Eigen::VectorXd& u) {
  project(r);
  velocity(r, u);
  return error(r, u);
}

double ContactOperator::error(const Impulses& r, const Eigen::VectorXd& u) const {
  RootMeanSquare mean;
  // As in the judge's measure, contacts that no impulse moves are left out.
  for (int c = 0; c < contact_count(); ++c)
    if (rho_[c] > 0.0)
      mean.add(ContactJudge::scaled_natural_map(at(r, c), at(u, c), friction(c), 1.0 / rho_[c]));
  return mean.value();
}

}  // namespace ballast
