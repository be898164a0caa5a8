#pragma once
// What all Gauss-Seidel sweeps have alike, whatever carries motion from contact to contact: groups
// of contacts side by side (WideSweep), bodies (ScalarSweep), or a stored W (DelassusSweep).

#include <vector>

#include "solvers/gauss_seidel/group_kernels.hpp"
#include "solvers/gauss_seidel/sweep_variant.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {

class ContactSweep {
 public:
  virtual ~ContactSweep() = default;

  /// Takes the impulses; those that move nothing along their contact's normal are dropped.
  virtual void load(const FrictionProblem& problem, const Impulses& r) = 0;
  virtual void store(const FrictionProblem& problem, Impulses& r) const = 0;

  /// Every contact once, in an order of its own.
  virtual void sweep() = 0;
  /// A search along sweeps begins at the current iterate.
  virtual void start_search();
  /// The iterate moves along the search direction and is then swept. Returns |r after the sweep - r
  /// before it|^2 over contacts, in the sweep's coordinates.
  virtual double sweep_along(SearchStep step);
  /// The contacts named, in that order, another way: for comparison, not for speed. Groups of
  /// contacts are never swept so.
  virtual void sweep_by(const SweepVariant&, const std::vector<int>& /*contacts*/) {}
  /// The judge's scaled natural map at the current iterate, rms over contacts [m/s].
  virtual double error() = 0;

  /// The iterate as one vector: impulses in the sweep's coordinates, then body velocities if there
  /// are any. Both are linear in r: combinations of iterates stay consistent. Returns how many
  /// entries are impulses.
  virtual Eigen::Index save(Eigen::VectorXd& state) const = 0;
  virtual void restore(const Eigen::VectorXd& state) = 0;
  /// Square roots of W's diagonal in the same coordinates, one for each impulse of save().
  virtual void impulse_weights(Eigen::VectorXd& weights) const = 0;

  /// See WideSweep: the others sweep in double in any case.
  virtual void allow_single(bool) {}
  virtual bool finish_in_double() { return false; }

 private:
  Eigen::VectorXd swept_, before_, direction_;
};

/// Sweeps of a solve with this budget may be in single precision where it pays: casting the records
/// takes as long as a few sweeps in double. Not where the budget asks for another measure, which
/// may stop a solve between two looks of ours.
inline void allow_single(ContactSweep& sweep, const Budget& budget) {
  constexpr int it_pays_from = 16;  // iterations
  sweep.allow_single(budget.max_iterations >= it_pays_from && !budget.fclib);
}

/// Stores the iterate of `sweep` in `r` and returns its error [m/s]. An error small enough to stop
/// is evaluated once more from the impulses alone, as the judge will: thousands of updates have
/// left their rounding in the velocities. `load()` takes `r` into the sweep again. Where sweeps
/// were in single precision, the last iterate is swept once more in double: what is returned obeys
/// each contact's law to the rounding of double.
template <typename Load>
double swept_error(ContactSweep& sweep, const FrictionProblem& problem, const Iteration& iteration,
                   Impulses& r, const Load& load) {
  double error = sweep.error();
  if (iteration.ends_with(error) && sweep.finish_in_double()) error = sweep.error();
  sweep.store(problem, r);
  if (!iteration.reached(error)) return error;
  load();
  return sweep.error();
}

}  // namespace ballast
