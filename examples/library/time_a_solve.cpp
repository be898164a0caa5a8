// A stored problem, solved again and again: the processor time of each call in seconds, a line
// each. The tolerance is relative, as in `ballast solve`.
//
//   time_a_solve PROBLEM SOLVER TOLERANCE COUNT

#include <cstdio>
#include <cstdlib>

#include <platform/clock.hpp>
#include <problems/algebra/contact_error.hpp>
#include <problems/files/problem_file.hpp>
#include <solvers/seam/run_solver.hpp>
#include <solvers/solver_list.hpp>

int main(int count, char** words) {
  if (count != 5) return 2;
  const ballast::FrictionProblem problem = ballast::read_problem(words[1]);
  for (int k = 0; k < std::atoi(words[4]); ++k) {
    const double begin = ballast::processor_seconds();
    const ballast::Impulses zero = ballast::Impulses::Zero(problem.row_count());
    const double scale = ballast::contact_error(problem, zero).velocity_scale;
    const double tolerance = std::atof(words[3]) * scale;
    const auto solver = ballast::make_solver(words[2]);
    const ballast::SolverRun run = ballast::SolverRunner().run(
        *solver, problem, {}, {.tolerance = tolerance, .max_iterations = 10000});
    if (!run.is_solved()) return 1;
    std::printf("%.9f\n", ballast::processor_seconds() - begin);
  }
}
