#include "solvers/backends/nncg.hpp"

#include <utility>

#include "solvers/gauss_seidel/body_sweep.hpp"
#include "solvers/gauss_seidel/swept_error.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

// One iteration, with r^ the iterate that the last sweep left and r the one it began from:
//   d = r^ - r (minus the gradient),  beta = |d|^2 / |d before|^2
//   beta > 1: the search restarts, p = 0, r := r^
//   else      r := r^ + beta p,  p := beta p + d
//   r^ := sweep(r)
// The body velocities are linear in r, so they take the same combination of their own past: no pass
// over the contacts' blocks. Only swept iterates, which lie in the cones, are ever judged or
// returned. The law is not a minimisation, and now and then the search circles: when the error has
// grown from one evaluation to the next, plain sweeps follow until the one after.
class Nncg final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    if (!problem.has_dynamics)
      throw UnsupportedProblem(
          "nncg: the problem has no dynamics form (M, H): it sweeps over bodies");
    sweep_.prepare(problem);
  }

  void use_threads(int threads) override { sweep_.use_threads(threads); }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {8, 1.2, 1.5});
    load(problem, r);
    sweep_.store(problem, r);
    double last_error = sweep_.error();
    iteration.evaluated(last_error);
    bool accelerates = true;
    while (iteration.next()) {
      square_ = sweep_.sweep(search_, next_step(accelerates));
      if (!iteration.error_due()) continue;
      const double error = swept_error(sweep_, problem, iteration, r, [&] { load(problem, r); });
      iteration.evaluated(error);
      // The search rests where the error grew, until the next look.
      accelerates = !accelerates || error < last_error;
      if (!accelerates) forget();
      last_error = error;
    }
    return iteration.finish(std::move(r));
  }

 private:
  void load(const FrictionProblem& problem, const Impulses& r) {
    sweep_.load(problem, r);
    forget();
  }

  /// The next search direction is the plain sweep's.
  void forget() {
    sweep_.start_search(search_);
    square_ = last_square_ = 0.0;
  }

  /// Plain: the sweep begins where the last one ended, and is remembered. The first sweep after a
  /// load or a restart is plain in any case.
  SearchStep next_step(bool accelerates) {
    if (!accelerates || square_ == 0.0) return {0.0, 0.0};
    double beta = last_square_ > 0.0 ? square_ / last_square_ : 0.0;
    if (beta > 1.0) beta = 0.0;
    last_square_ = square_;
    return {beta, 1.0};
  }

  BodySweep sweep_;
  SweepSearch search_;
  double square_ = 0.0, last_square_ = 0.0;  ///< |d|^2 of the last sweep, and of the one before
};

}  // namespace

std::unique_ptr<Solver> make_nncg() { return std::make_unique<Nncg>(); }

}  // namespace ballast
