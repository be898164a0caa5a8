#pragma once
// One Gauss-Seidel sweep on the dynamics form, matrix-free: contacts push bodies, bodies carry the
// motion to other contacts.

#include <span>
#include <vector>

#include "platform/worker_team.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/mass_root.hpp"
#include "solvers/gauss_seidel/sweep_kernels.hpp"
#include "solvers/gauss_seidel/sweep_plan.hpp"
#include "solvers/gauss_seidel/sweep_variant.hpp"

namespace ballast {

/// What a search along sweeps remembers of the iterate: impulses and velocities, both linear in r,
/// take the same steps.
struct SweepSearch {
  std::vector<ImpulseSearch> friction;
  std::vector<OneRowSearch> one_row;
  std::vector<BodyVelocity> velocity_before, velocity_direction;
};

class BodySweep {
 public:
  /// Records, masses, 1/rho: everything that does not depend on the impulses. `problem` has the
  /// dynamics form.
  void prepare(const FrictionProblem& problem);
  /// Takes the impulses and the body velocities that they give.
  void load(const FrictionProblem& problem, const Impulses& r);
  void store(const FrictionProblem& problem, Impulses& r) const;

  /// How many threads share a sweep from now on (>= 1). The same bits whatever their number.
  void use_threads(int threads) { team_.resize(threads); }

  /// Every contact once, in the order of order().
  void sweep();
  /// The iterate moves along the search direction, `step`, and is then swept. Returns |r after the
  /// sweep - r before it|^2 over contacts, in the records' coordinates. `search`: of
  /// start_search(), for this problem.
  double sweep(SweepSearch& search, SearchStep step);
  void start_search(SweepSearch& search) const;
  const std::vector<int>& order() const { return plan_.contacts(); }
  /// The contacts named, in that order, another way: for comparison, not for speed.
  void sweep(const SweepVariant& variant, const std::vector<int>& contacts);
  /// The judge's scaled natural map at the current iterate, rms over contacts [m/s].
  double error();

  /// The iterate as one vector: impulses in the records' coordinates, then body velocities in which
  /// every mass is one. Both are linear in r: combinations of iterates stay consistent.
  void save(Eigen::VectorXd& state) const;
  void restore(const Eigen::VectorXd& state);
  /// Square roots of W's diagonal in the same coordinates, for the impulses alone: their number is
  /// the vector's size.
  void impulse_weights(Eigen::VectorXd& weights) const;

 private:
  /// The records of one part of the plan.
  struct Range {
    int friction, friction_count, one_row, one_row_count;
    double change_square = 0.0;  ///< of the last sweep along a search
    double error_square = 0.0;   ///< of error(): the part's sum, and over how many contacts
    int judged = 0;
  };
  /// Calls task(range) for the interiors, then for the interfaces; those of a kind at the same
  /// time.
  template <typename Task>
  void for_parts(const Task& task);

  void move_along(std::span<const int> bodies, SweepSearch& search, SearchStep step);
  void prepare_bodies(const DynamicsForm& dynamics);
  void prepare_ranges(const FrictionProblem& problem);
  void prepare_friction(const FrictionProblem& problem, int c, int record);
  void prepare_one_row(const FrictionProblem& problem, int c, int record);

  std::vector<MassRoot> roots_;
  std::vector<BodyVelocity>
      free_velocity_;  ///< L^T v_free; then one for each part of the plan that never moves
  std::vector<BodyVelocity> velocity_;
  SweepPlan plan_;
  WorkerTeam team_;
  std::vector<Range> interiors_, interfaces_;
  std::vector<FrictionRecord> friction_;
  std::vector<FrictionImpulse> friction_impulse_;
  std::vector<OneRowRecord> one_row_;
  std::vector<double> one_row_impulse_;
  std::vector<int> record_;  ///< of each contact: its number among those of its kind
  std::vector<char> is_one_row_;
  std::vector<int> nowhere_;  ///< of each contact: the velocity that stays zero, one to a part so
                              ///< that threads share no line
  std::vector<TangentTurn> turn_;   ///< per friction record
  std::vector<double> lambda_max_;  ///< per friction record, of W_cc [1/kg]
  std::vector<double> one_row_lambda_max_;
};

}  // namespace ballast
