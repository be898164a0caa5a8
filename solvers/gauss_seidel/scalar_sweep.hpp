#pragma once
// The sweep over bodies contact after contact, for problems of any kind: bodies with other unknowns
// than a grain's, sides that are not opposite, few contacts. For the problems of a packing's time
// steps WideSweep is faster.
//
// Bodies are in the variables w = L^T v (M = L L^T, unit mass), contacts in the coordinates of
// PrincipalContact:
//   (u_N, u_T - c u_N) = sum over sides G w + bias,   w += G^T (y, r_T) changes,   G = A H L^-T
// so that each side is one block that is read once for both equations.

#include <vector>

#include "problems/algebra/friction_cone.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/mass_root.hpp"
#include "solvers/gauss_seidel/contact_sweep.hpp"
#include "solvers/gauss_seidel/sweep_plan.hpp"
#include "solvers/parts/one_contact.hpp"

namespace ballast {

class ScalarSweep final : public ContactSweep {
 public:
  /// The plan, whose team shares the sweep's work, must outlive it.
  explicit ScalarSweep(const SweepPlan& plan) : plan_(plan) {}

  /// The plan must have been prepared for `problem`, which has the dynamics form.
  void prepare(const FrictionProblem& problem);

  void load(const FrictionProblem& problem, const Impulses& r) override;
  void store(const FrictionProblem& problem, Impulses& r) const override;
  void sweep() override;
  void start_search() override;
  /// Moves impulses as the sweep reaches them: copying all of them costs more than a small sweep.
  double sweep_along(SearchStep step) override;
  double error() override;

  static constexpr int width = 8;  ///< numbers of a row: six, and two zeros that fill a register

  /// The data of a contact that a sweep reads. A one-row contact has zeros for its tangents.
  struct alignas(64) Record {
    double rows[2][3][width];  ///< G for body a, then b
    double bias[3];            ///< in the coordinates of the rows
    PrincipalContact local;
    int body[2];  ///< index of a and of b in velocity_
    int row_count;
  };
  /// The data of a contact that a sweep writes.
  struct alignas(32) Impulse {
    double y[3];  ///< (y, r_T)
    double slip;  ///< the last slip root, the first guess for the next one
  };
  struct alignas(64) Velocity {
    double w[width];
  };

 private:
  void prepare_record(const FrictionProblem& problem, int place, int nowhere);

  const SweepPlan& plan_;
  std::vector<MassRoot> roots_;
  /// L^T v_free. Each part of the plan has one more entry that never moves, so that threads share
  /// no cache line.
  std::vector<Velocity> free_velocity_;
  std::vector<Velocity> velocity_;
  // In the order of the plan:
  std::vector<Record> records_;
  std::vector<Impulse> impulses_;
  std::vector<TangentTurn> turn_;
  std::vector<double> lambda_max_;  ///< of W_cc [1/kg]
  std::vector<int> place_;          ///< each contact's position in that order
  std::vector<RootMeanSquare> part_error_;
  // The search: the iterate from which the last sweep started, and the direction.
  std::vector<Impulse> impulses_before_, impulse_direction_;
  std::vector<Velocity> velocity_before_, velocity_direction_;
  std::vector<double> part_square_;
};

}  // namespace ballast
