#pragma once
// One Gauss-Seidel sweep on the dynamics form, matrix-free: contacts push bodies, bodies carry the motion to other
// contacts.

#include <vector>

#include "problems/friction_problem.hpp"
#include "problems/mass_root.hpp"
#include "solvers/sweep_kernels.hpp"
#include "solvers/sweep_variant.hpp"

namespace ballast {

class BodySweep {
 public:
  /// Records, masses, 1/rho: everything that does not depend on the impulses. `problem` has the dynamics form.
  void prepare(const FrictionProblem& problem);
  /// Takes the impulses and the body velocities that they give.
  void load(const FrictionProblem& problem, const Impulses& r);
  void store(const FrictionProblem& problem, Impulses& r) const;

  /// Every contact once, in the given order.
  void sweep();
  /// The contacts named, in that order, another way: for comparison, not for speed.
  void sweep(const SweepVariant& variant, const std::vector<int>& contacts);
  /// The judge's scaled natural map at the current iterate, rms over contacts [m/s].
  double error() const;

  /// The iterate as one vector: impulses in the records' coordinates, then body velocities in which every mass is one.
  /// Both are linear in r: combinations of iterates stay consistent.
  void save(Eigen::VectorXd& state) const;
  void restore(const Eigen::VectorXd& state);
  /// Square roots of W's diagonal in the same coordinates, for the impulses alone: their number is the vector's size.
  void impulse_weights(Eigen::VectorXd& weights) const;

  /// What the sweep works on, for methods that move the iterate between sweeps: impulses and velocities must stay
  /// consistent.
  std::vector<FrictionRecord>& friction_records() { return friction_; }
  std::vector<OneRowRecord>& one_row_records() { return one_row_; }
  std::vector<BodyVelocity>& velocities() { return velocity_; }

 private:
  /// Consecutive contacts of one kind, so that no contact branches on its kind.
  struct Run {
    bool one_row;
    int first_contact, first_record, count;
  };

  void prepare_bodies(const DynamicsForm& dynamics);
  void prepare_friction(const FrictionProblem& problem, int c, int record);
  void prepare_one_row(const FrictionProblem& problem, int c, int record);

  std::vector<MassRoot> roots_;
  std::vector<BodyVelocity> free_velocity_;  ///< L^T v_free; the last body never moves
  std::vector<BodyVelocity> velocity_;
  std::vector<FrictionRecord> friction_;
  std::vector<OneRowRecord> one_row_;
  std::vector<Run> runs_;
  std::vector<int> record_;  ///< of each contact: its number among those of its kind
  std::vector<char> is_one_row_;
  std::vector<TangentTurn> turn_;   ///< per friction record
  std::vector<double> lambda_max_;  ///< per friction record, of W_cc [1/kg]
  std::vector<double> one_row_lambda_max_;
};

}  // namespace ballast
