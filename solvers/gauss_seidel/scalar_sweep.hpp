#pragma once
// The sweep over bodies contact after contact, for problems of any kind: bodies with other
// unknowns than a grain's, sides that are not opposite, other orders and rules. Of what a time step
// gives, WideSweep is the faster way.

#include <span>
#include <vector>

#include "platform/worker_team.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/mass_root.hpp"
#include "problems/algebra/root_mean_square.hpp"
#include "solvers/gauss_seidel/sweep_kernels.hpp"
#include "solvers/gauss_seidel/sweep_plan.hpp"
#include "solvers/gauss_seidel/sweep_variant.hpp"

namespace ballast {

class ScalarSweep {
 public:
  /// Both outlive the sweep.
  explicit ScalarSweep(const SweepPlan& plan) : plan_(plan) {}

  /// Shares sweeps, looks and preparation; null: one thread.
  void use_team(WorkerTeam* team) { team_ = team; }

  /// As in BodySweep. The plan has been prepared for `problem`.
  void prepare(const FrictionProblem& problem);
  void load(const FrictionProblem& problem, const Impulses& r);
  void store(const FrictionProblem& problem, Impulses& r) const;
  void sweep();
  double sweep(SearchStep step);
  void start_search();
  /// The contacts named, in that order, another way: for comparison, not for speed.
  void sweep(const SweepVariant& variant, const std::vector<int>& contacts);
  double error();
  void save(Eigen::VectorXd& state) const;
  void restore(const Eigen::VectorXd& state);
  void impulse_weights(Eigen::VectorXd& weights) const;

 private:
  /// The records of one part of the plan.
  struct Range {
    int friction, friction_count, one_row, one_row_count;
    double change_square = 0.0;  ///< of the last sweep along a search
    RootMeanSquare error = {};   ///< of error(): the part's
  };
  /// Calls task(range) for the interiors, then for the interfaces; those of a kind at the same
  /// time.
  template <typename Task>
  void for_parts(const Task& task);

  void move_along(std::span<const int> bodies, SearchStep step);
  void prepare_bodies(const DynamicsForm& dynamics);
  void prepare_ranges(const FrictionProblem& problem);
  void prepare_friction(const FrictionProblem& problem, int c, int record);
  void prepare_one_row(const FrictionProblem& problem, int c, int record);

  const SweepPlan& plan_;
  WorkerTeam* team_ = nullptr;
  std::vector<MassRoot> roots_;
  std::vector<BodyVelocity>
      free_velocity_;  ///< L^T v_free; then one for each part of the plan that never moves
  std::vector<BodyVelocity> velocity_;
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
  /// What a search remembers: impulses and velocities, both linear in r, take the same steps.
  std::vector<ImpulseSearch> friction_search_;
  std::vector<OneRowSearch> one_row_search_;
  std::vector<BodyVelocity> velocity_before_, velocity_direction_;
};

}  // namespace ballast
