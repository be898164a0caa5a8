#pragma once
// u = W r + q for both forms of a problem, its natural scaling, and the judge's error at an
// iterate. Every method that treats all contacts at once needs them.

#include <vector>

#include "problems/algebra/friction_cone.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/mass_root.hpp"

namespace ballast {

/// Products are matrix-free for the dynamics form and use the stored W otherwise; none allocates.
/// Vectors have one entry per row.
class ContactOperator {
 public:
  /// `problem` must outlive the use of the operator (until the next prepare). Throws InvalidProblem
  /// for a mass block that is not positive definite.
  void prepare(const FrictionProblem& problem);

  const FrictionProblem& problem() const { return *problem_; }
  int contact_count() const { return problem_->contact_count(); }
  double friction(int c) const { return problem_->friction[c]; }

  /// u = W r + q [m/s]. `u` must not be `r`.
  void velocity(const Impulses& r, Eigen::VectorXd& u);
  /// w = W r [m/s]. `w` must not be `r`.
  void multiply(const Impulses& r, Eigen::VectorXd& w);

  /// The symmetric part of each W_cc, zero-padded for one-row contacts.
  const std::vector<Eigen::Matrix3d>& diagonal() const { return diagonal_; }
  /// 1 / lambda_max(W_cc) [kg]; 0 where no impulse moves the contact. Methods scale their steps by
  /// it.
  const std::vector<double>& rho() const { return rho_; }

  /// One contact's rows, zero-padded: a one-row contact is a frictionless one without tangential
  /// motion.
  Eigen::Vector3d at(const Eigen::VectorXd& x, int c) const {
    return rows_of_contact(*problem_, x, c);
  }
  void put(Eigen::VectorXd& x, int c, const Eigen::Vector3d& value) const {
    double* rows = x.data() + problem_->row_begin[c];
    rows[0] = value[0];
    if (problem_->contact_rows(c) == 3) {
      rows[1] = value[1];
      rows[2] = value[2];
    }
  }

  /// Moves every impulse to the nearest point of its cone; sets it to zero where rho = 0.
  void project(Impulses& r) const;
  /// Begins a method: moves r to the nearest point of its cones and sets u to the velocities that r
  /// gives. Returns error(r, u).
  double project_and_evaluate(Impulses& r, Eigen::VectorXd& u);

  /// The judge's scaled natural map, rms over contacts [m/s], of impulses r with the velocities u
  /// that they give.
  double error(const Impulses& r, const Eigen::VectorXd& u) const;

 private:
  void push_bodies(const Impulses& r);  ///< v_ = M^-1 H^T r

  const FrictionProblem* problem_ = nullptr;
  std::vector<MassRoot> roots_;
  std::vector<Eigen::Matrix3d> diagonal_;
  std::vector<double> rho_;
  Eigen::VectorXd v_;
};

}  // namespace ballast
