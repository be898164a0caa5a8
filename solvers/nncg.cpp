#include "solvers/nncg.hpp"

#include <utility>

#include "solvers/body_sweep.hpp"
#include "solvers/iteration.hpp"

namespace ballast {
namespace {

// One iteration, with r^ the iterate that the last sweep left and r the one it began from:
//   d = r^ - r (minus the gradient),  beta = |d|^2 / |d before|^2
//   beta > 1: the search restarts, p = 0, r := r^
//   else      r := r^ + beta p,  p := beta p + d
//   r^ := sweep(r)
// The body velocities are linear in r, so they take the same combination of their own past: no pass over the contacts' blocks.
// Only swept iterates, which lie in the cones, are ever judged or returned. The law is not a minimisation, and now and then the
// search circles: when the error has grown from one evaluation to the next, plain sweeps follow until the one after.
class Nncg final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    if (!problem.has_dynamics)
      throw UnsupportedProblem("nncg: the problem has no dynamics form (M, H): it sweeps over bodies");
    sweep_.prepare(problem);
  }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {4, 1.25});
    load(problem, r);
    sweep_.store(problem, r);
    double last_error = sweep_.error();
    iteration.evaluated(last_error);
    bool accelerates = true;
    while (iteration.next()) {
      if (swept_ && accelerates) extrapolate();
      remember();
      sweep_.sweep();
      swept_ = true;
      if (!iteration.error_due()) continue;
      double error = sweep_.error();
      sweep_.store(problem, r);
      if (iteration.reached(error)) {  // once more from the impulses alone, without what the updates have rounded
        load(problem, r);
        error = sweep_.error();
      }
      iteration.evaluated(error);
      accelerates = !accelerates || error < last_error;
      if (!accelerates) forget();
      last_error = error;
    }
    Solved solved;
    iteration.finish(solved);
    solved.impulses = std::move(r);
    return solved;
  }

 private:
  void load(const FrictionProblem& problem, const Impulses& r) {
    sweep_.load(problem, r);
    const size_t entries = 3 * sweep_.friction_records().size() + sweep_.one_row_records().size();
    before_.resize(entries);
    step_.resize(entries);
    forget();
    swept_ = false;
  }

  /// The next search direction is the plain sweep's.
  void forget() {
    direction_.assign(before_.size(), 0.0);
    velocity_direction_.assign(sweep_.velocities().size(), BodyVelocity{});
    last_square_ = 0.0;
  }

  /// Calls f(k, entry) for every impulse entry, k counting them.
  template <typename F>
  void for_entries(F&& f) {
    size_t k = 0;
    for (FrictionRecord& record : sweep_.friction_records())
      for (double& y : record.y) f(k++, y);
    for (OneRowRecord& record : sweep_.one_row_records()) f(k++, record.y);
  }

  void remember() {
    for_entries([&](size_t k, double y) { before_[k] = y; });
    velocity_before_ = sweep_.velocities();
  }

  void extrapolate() {
    double square = 0.0;
    for_entries([&](size_t k, double y) {
      step_[k] = y - before_[k];
      square += step_[k] * step_[k];
    });
    double beta = last_square_ > 0.0 ? square / last_square_ : 0.0;
    if (beta > 1.0) beta = 0.0;
    last_square_ = square;
    for_entries([&](size_t k, double& y) {
      direction_[k] *= beta;
      y += direction_[k];
      direction_[k] += step_[k];
    });
    std::vector<BodyVelocity>& velocities = sweep_.velocities();
    for (size_t b = 0; b < velocities.size(); ++b)
      for (int i = 0; i < body_width; ++i) {
        double& w = velocities[b].w[i];
        double& p = velocity_direction_[b].w[i];
        const double step = w - velocity_before_[b].w[i];
        p *= beta;
        w += p;
        p += step;
      }
  }

  BodySweep sweep_;
  std::vector<double> before_, step_, direction_;  // three entries per friction record, then the one-row records
  std::vector<BodyVelocity> velocity_before_, velocity_direction_;
  double last_square_ = 0.0;
  bool swept_ = false;
};

}  // namespace

std::unique_ptr<Solver> make_nncg() { return std::make_unique<Nncg>(); }

}  // namespace ballast
