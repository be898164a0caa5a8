#include <algorithm>
#include <utility>

#include "solvers/backends/backends.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

/// sweeps_of_step() for a stored W, counted in multiplications. A sweep costs W's entries and each
/// contact's own solution; a step the linearisation and a factorisation, which is dense where rows
/// are few or W is nearly full, else mostly bookkeeping, row by row, and fill.
double stored_step(const FrictionProblem& problem) {
  const double contacts = problem.contact_count(), rows = problem.row_count();
  const double entries = static_cast<double>(problem.delassus.w.nonZeros());
  const double sweep = 1000.0 + entries + 60.0 * contacts;
  const double dense = 8.0 * entries + 0.026 * rows * rows * rows;
  const double sparse = 3400.0 * rows * (1.0 + rows / 900.0);
  const bool is_dense = rows <= 200.0 || entries > 0.1 * rows * rows;
  return (1700.0 * contacts + (is_dense ? std::min(dense, sparse) : sparse)) / sweep;
}

class Auto final : public Solver {
 public:
  void prepare(const FrictionProblem&) override {
    for (LazySolver* way : {&sweeps_, &burst_, &proximal_, &interior_}) way->is_prepared = false;
  }

  void use_team(WorkerTeam* team) override {
    for (LazySolver* way : {&sweeps_, &burst_, &proximal_, &interior_}) way->solver->use_team(team);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Course course(budget, std::move(start));
    if (course.best().isZero(0.0) && nothing_presses(problem)) {
      course.offer(course.best(), 0.0);
      return course.finish();
    }
    const bool is_scarce = budget.max_iterations <= few_iterations;
    const double step = is_scarce ? 1.0
                        : problem.has_dynamics
                            ? std::max(first_step, sweeps_of_step(problem.contact_count()))
                            : stored_step(problem);
    LazySolver& newton = problem.has_dynamics && !is_scarce ? burst_ : proximal_;

    course.run(sweeps_.prepared(problem), problem, budget.max_iterations,
               sweep_stop_rule(step, 0.25 * budget.max_iterations, budget));
    int idle = 0;
    for (double steps = first_steps; !course.over() && idle < 2; steps *= 2.0) {
      const double before = course.error();
      course.run(newton, problem, &newton == &burst_ ? 1e9 : steps);
      course.run(sweeps_, problem, steps * step);
      course.run(interior_, problem, 0.5 * steps);  // one of its steps costs about two
      idle = course.error() < 0.9 * before ? 0 : idle + 1;
    }
    return course.finish();
  }

 private:
  /// Whether no contact closes without impulses: zero impulses are then a solution.
  static bool nothing_presses(const FrictionProblem& problem) {
    Eigen::VectorXd q;
    free_contact_velocity(problem, q);
    for (int c = 0; c < problem.contact_count(); ++c)
      if (!(q[problem.row_begin[c]] >= 0.0)) return false;
    return true;
  }

  static constexpr double first_steps = 40.0;  ///< Newton steps in the first turn
  /// Sweeps that cost as much as a step over few bodies: most of the step's cost is ordering.
  static constexpr double first_step = 25.0;
  /// Where a budget has so few iterations, a sweep is as dear as a factorisation.
  static constexpr int few_iterations = 1000;

  LazySolver sweeps_{make_nesterov_pgs(/*returns_best=*/false)};
  LazySolver burst_{make_newton_burst(/*begins_with_sweeps=*/false)};
  LazySolver proximal_{make_proximal_newton({.start_sweeps = 0, .first_weight = 3e-4})};
  LazySolver interior_{make_interior_point()};
};

}  // namespace

std::unique_ptr<Solver> make_auto() { return std::make_unique<Auto>(); }

}  // namespace ballast
