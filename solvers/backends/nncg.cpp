#include "solvers/backends/nncg.hpp"

#include <utility>

#include "solvers/gauss_seidel/body_sweep.hpp"
#include "solvers/gauss_seidel/delassus_sweep.hpp"
#include "solvers/gauss_seidel/either_form.hpp"
#include "solvers/gauss_seidel/swept_error.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

/// The sweep over bodies along its search: velocities are linear in the impulses and take the same
/// combination of their own past, so that nothing is recomputed.
struct BodySearch {
  BodySweep sweep;

  void start() { sweep.start_search(); }
  double advance(SearchStep step) { return sweep.sweep(step); }
};

/// The same over a stored W, whose sweep keeps impulses alone.
struct MatrixSearch {
  DelassusSweep sweep;
  Eigen::VectorXd swept, before, direction;

  void start() {
    sweep.save(before);
    direction.setZero(before.size());
  }
  double advance(SearchStep step) {
    sweep.save(swept);
    // p := beta p + gain (x - before), and x moves along the old p.
    before = step.gain * (swept - before);
    swept += step.beta * direction;
    direction = step.beta * direction + before;
    before = swept;
    sweep.restore(swept);
    sweep.sweep();
    sweep.save(swept);
    return (swept - before).squaredNorm();
  }
};

/// When to look at the error. The square of what a sweep changes comes for nothing, and while a
/// solve goes on it stays in one proportion to the square of the error, within a tenth.
class SweptChange {
 public:
  explicit SweptChange(double aim) : aim_(aim) {}

  /// After a look at the error [m/s].
  void seen(int sweeps, double square, double error) {
    next_ = sweeps + apart;
    enough_ = square * (near * aim_ / error) * (near * aim_ / error);
  }
  /// The error is likely to be small enough.
  bool promises(int sweeps, double square) const { return sweeps >= next_ && square <= enough_; }

 private:
  static constexpr int apart = 4;  // sweeps between two looks, at least
  static constexpr double near = 0.97;
  double aim_, enough_ = -1.0;
  int next_ = 0;
};

// One iteration, with r^ the iterate that the last sweep left and r the one it began from:
//   d = r^ - r (minus the gradient),  beta = |d|^2 / |d before|^2
//   beta > 1: the search restarts, p = 0, r := r^
//   else      r := r^ + beta p,  p := beta p + d
//   r^ := sweep(r)
// Only swept iterates, which lie in the cones, are ever judged or returned. The law is not a
// minimisation, and now and then the search circles: when the error has grown from one evaluation
// to the next, plain sweeps follow until the one after.
class Nncg final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    searches_.visit(problem, [&](auto& search) { search.sweep.prepare(problem); });
  }

  void use_team(WorkerTeam* team) override { searches_.bodies.sweep.use_team(team); }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    return searches_.visit(
        problem, [&](auto& search) { return iterate(search, problem, std::move(start), budget); });
  }

 private:
  template <typename Search>
  Solved iterate(Search& search, const FrictionProblem& problem, Impulses r, const Budget& budget) {
    Iteration iteration(budget, {8, 1.3, 1.5});
    SweptChange change(budget.aim());
    allow_single(search.sweep, budget);
    load(search, problem, r);
    search.sweep.store(problem, r);
    double last_error = search.sweep.error();
    iteration.evaluated(last_error, r);
    bool accelerates = true;
    while (iteration.next()) {
      square_ = search.advance(next_step(accelerates));
      if (!iteration.error_due() && !change.promises(iteration.count(), square_)) continue;
      const double swept = square_;
      const double error =
          swept_error(search.sweep, problem, iteration, r, [&] { load(search, problem, r); });
      iteration.evaluated(error, r);
      change.seen(iteration.count(), swept, error);
      // The search rests where the error grew, until the next look.
      accelerates = !accelerates || error < last_error;
      if (!accelerates) forget(search);
      last_error = error;
    }
    return iteration.finish(std::move(r));
  }

  template <typename Search>
  void load(Search& search, const FrictionProblem& problem, const Impulses& r) {
    search.sweep.load(problem, r);
    forget(search);
  }

  /// The next search direction is the plain sweep's.
  template <typename Search>
  void forget(Search& search) {
    search.start();
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

  EitherForm<BodySearch, MatrixSearch> searches_;
  double square_ = 0.0, last_square_ = 0.0;  ///< |d|^2 of the last sweep, and of the one before
};

}  // namespace

std::unique_ptr<Solver> make_nncg() { return std::make_unique<Nncg>(); }

}  // namespace ballast
