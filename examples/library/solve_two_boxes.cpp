// A problem by W and q, solved and judged: one contact that sticks and one that slips.

#include <cstdio>

#include <experiments/step/time_step.hpp>
#include <problems/algebra/contact_error.hpp>
#include <problems/files/problem_file.hpp>
#include <solvers/seam/run_solver.hpp>
#include <solvers/solver_list.hpp>

int main() {
  // Two boxes of 1 kg that come down at 1 m/s, the second sliding at 2 m/s: rows normal, tangents.
  ballast::FrictionProblem problem;
  problem.row_begin = {0, 3, 6};
  problem.friction = {0.5, 0.5};
  problem.has_delassus = true;
  problem.delassus.w.resize(6, 6);
  problem.delassus.w.setIdentity();
  problem.delassus.q.resize(6);
  problem.delassus.q << -1.0, 0.0, 0.0, -1.0, 2.0, 0.0;

  const auto solver = ballast::make_solver("auto");
  const ballast::SolverRun run =
      ballast::SolverRunner().run(*solver, problem, {}, {.tolerance = 1e-10});
  std::printf("%s\n", ballast::name_of(run.verdict));
  for (const double r : run.solved.impulses) std::printf("%.6f\n", r);
  ballast::write_problem("two_boxes.hdf5", problem);
  return run.is_solved() ? 0 : 1;
}
