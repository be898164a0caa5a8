#include "experiments/measure/jam_stiffness.hpp"

#include <cmath>
#include <limits>

#include "problems/algebra/contact_error.hpp"

namespace ballast {

double jam_stiffness(Solver& solver, const FrictionProblem& problem, const Impulses& start,
                     const Budget& budget, double h) {
  const int wall = driven_wall(problem);
  if (wall < 0 || start.size() == 0) return std::numeric_limits<double>::quiet_NaN();
  const int unknown = problem.dynamics.dof_begin[wall];
  const double mass = problem.dynamics.mass[static_cast<size_t>(problem.dynamics.mass_begin[wall])];
  SolverRunner runner;
  Eigen::VectorXd given;
  contact_to_body_impulse(problem.dynamics, problem.row_begin, start, given);
  if (given[unknown] == 0.0) return std::numeric_limits<double>::quiet_NaN();
  // What the grains give to the wall is what pushes it against them.
  const double impulse = -jam_load_step * given[unknown];
  FrictionProblem raised = problem;
  raised.dynamics.v_free[unknown] += impulse / mass;
  runner.run(solver, problem, start, budget);
  const double held = runner.body_velocity()[unknown];
  runner.run(solver, raised, start, budget);
  const double moved = runner.body_velocity()[unknown] - held;
  return std::abs(impulse / h) / (h * std::abs(moved));
}

}  // namespace ballast
