#include "solvers/seam/island_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "platform/clock.hpp"
#include "problems/algebra/islands.hpp"

namespace ballast {
namespace {

/// The whole stopped for the worst of its islands' reasons.
int badness(StopReason reason) {
  switch (reason) {
    case StopReason::reached_tolerance:
      return 0;
    case StopReason::stalled:
      return 1;
    case StopReason::iteration_limit:
      return 2;
    case StopReason::time_limit:
      return 3;
    case StopReason::numerical_failure:
      break;
  }
  return 4;
}

class IslandSolver final : public Solver {
 public:
  explicit IslandSolver(std::unique_ptr<Solver> backend) : backend_(std::move(backend)) {}

  void prepare(const FrictionProblem& problem) override {
    // A stored W does not say which bodies its contacts have: it is one island.
    is_split_ = problem.has_dynamics && !problem.has_delassus;
    if (is_split_) islands_.find(problem);
    is_split_ = is_split_ && islands_.count() > 1;
    if (!is_split_) backend_->prepare(problem);
  }

  void use_team(WorkerTeam* team) override { backend_->use_team(team); }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    if (is_split_ && budget.fclib) {  // a measure of the whole
      backend_->prepare(problem);
      is_split_ = false;
    }
    if (!is_split_) return backend_->solve(problem, std::move(start), budget);
    const Stopwatch watch;
    Solved whole;
    whole.reason = StopReason::reached_tolerance;
    whole.impulses.setZero(problem.row_count());
    double visits = 0.0, squares = 0.0, contacts = 0.0;
    for (int i = 0; i < islands_.count(); ++i) {
      Budget own = budget;
      own.keep_history = false;
      own.max_seconds = std::max(0.0, budget.max_seconds - watch.seconds());
      const Solved solved = solve_island(problem, i, start, own, whole.impulses);
      // What is said of the whole: means weighted by contacts, and the worst reason.
      const double size = static_cast<double>(islands_.contacts(i).size());
      contacts += size;
      visits += size * solved.iterations;
      squares += size * solved.own_residual * solved.own_residual;
      whole.startup_seconds += solved.startup_seconds;
      if (badness(solved.reason) > badness(whole.reason)) whole.reason = solved.reason;
    }
    whole.iterations = static_cast<int>(std::ceil(visits / contacts));
    whole.own_residual = std::sqrt(squares / contacts);
    return whole;
  }

 private:
  /// Writes the island's rows of `impulses`; they stay zero where the backend fails to return any.
  /// The result has none.
  Solved solve_island(const FrictionProblem& problem, int island, const Impulses& start,
                      const Budget& budget, Impulses& impulses) {
    // The island as a problem of its own, its rows of the start, and back.
    islands_.extract(problem, island, part_);
    islands_.gather(problem, island, start, rows_);
    backend_->prepare(part_);
    Solved solved = backend_->solve(part_, std::move(rows_), budget);
    rows_ = std::move(solved.impulses);
    if (rows_.size() == part_.row_count())
      islands_.scatter(problem, island, rows_, impulses);
    else
      solved.reason = StopReason::numerical_failure;
    return solved;
  }

  std::unique_ptr<Solver> backend_;
  bool is_split_ = false;
  Islands islands_;
  FrictionProblem part_;
  Impulses rows_;
};

}  // namespace

std::unique_ptr<Solver> make_island_solver(std::unique_ptr<Solver> backend) {
  return std::make_unique<IslandSolver>(std::move(backend));
}

}  // namespace ballast
