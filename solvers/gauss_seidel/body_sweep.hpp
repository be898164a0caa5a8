#pragma once
// One Gauss-Seidel sweep on the dynamics form, matrix-free: contacts push bodies, bodies carry the
// motion to other contacts. The way that fits the problem is taken: groups of contacts side by side
// (WideSweep), or contact after contact (ScalarSweep).

#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "solvers/gauss_seidel/scalar_sweep.hpp"
#include "solvers/gauss_seidel/sweep_plan.hpp"
#include "solvers/gauss_seidel/wide_sweep.hpp"

namespace ballast {

class BodySweep {
 public:
  BodySweep() : scalar_(plan_), wide_(plan_) {}

  /// From the next prepare() on, contacts can be swept by a variant: one by one.
  void use_variants() { variants_ = true; }
  /// Whose members share a sweep from now on; null: the caller alone. The same bits whatever their
  /// number.
  void use_team(WorkerTeam* team) {
    scalar_.use_team(team);
    wide_.use_team(team);
  }

  /// Records, masses, 1/rho: everything that does not depend on the impulses. `problem` has the
  /// dynamics form.
  void prepare(const FrictionProblem& problem);
  /// See WideSweep; nothing where contacts are swept one by one.
  void allow_single(bool allowed) { wide_.allow_single(allowed); }
  bool finish_in_double() { return is_wide_ && wide_.finish_in_double(); }
  bool is_wide() const { return is_wide_; }
  /// Takes the impulses and the body velocities that they give.
  void load(const FrictionProblem& problem, const Impulses& r);
  void store(const FrictionProblem& problem, Impulses& r) const;

  /// Every contact once, in an order that SweepPlan makes.
  void sweep();
  /// A search along sweeps begins at the current iterate.
  void start_search();
  /// The iterate moves along the search direction, `step`, and is then swept. Returns |r after the
  /// sweep - r before it|^2 over contacts, in the records' coordinates.
  double sweep(SearchStep step);
  /// The contacts named, in that order, another way: for comparison, not for speed. After
  /// use_variants().
  void sweep(const SweepVariant& variant, const std::vector<int>& contacts);
  /// The judge's scaled natural map at the current iterate, rms over contacts [m/s].
  double error();

  /// The iterate as one vector: impulses in the records' coordinates, then body velocities. Both
  /// are linear in r: combinations of iterates stay consistent.
  void save(Eigen::VectorXd& state) const;
  void restore(const Eigen::VectorXd& state);
  /// Square roots of W's diagonal in the same coordinates, for the impulses alone: their number is
  /// the vector's size.
  void impulse_weights(Eigen::VectorXd& weights) const;

 private:
  SweepPlan plan_;
  ScalarSweep scalar_;
  WideSweep wide_;
  bool variants_ = false, is_wide_ = false;
};

}  // namespace ballast
