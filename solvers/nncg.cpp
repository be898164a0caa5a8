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

  void use_threads(int threads) override { sweep_.use_threads(threads); }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {8, 1.2, 1.5});
    load(problem, r);
    sweep_.store(problem, r);
    double last_error = sweep_.error();
    iteration.evaluated(last_error);
    bool accelerates = true;
    while (iteration.next()) {
      if (swept_ && accelerates)
        extrapolate();
      else
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
    return iteration.finish(std::move(r));
  }

 private:
  void load(const FrictionProblem& problem, const Impulses& r) {
    sweep_.load(problem, r);
    before_.resize(sweep_.friction_impulses().size());
    one_row_before_.resize(sweep_.one_row_impulses().size());
    velocity_before_.resize(sweep_.velocities().size());
    forget();
    swept_ = false;
  }

  /// The next search direction is the plain sweep's.
  void forget() {
    direction_.assign(before_.size(), FrictionImpulse{});
    one_row_direction_.assign(one_row_before_.size(), 0.0);
    velocity_direction_.assign(velocity_before_.size(), BodyVelocity{});
    last_square_ = 0.0;
  }

  static size_t chunk_begin(size_t count, int chunk) { return count * static_cast<size_t>(chunk) / chunks; }

  double chunk_square(int chunk) {
    const auto& y = sweep_.friction_impulses();
    const auto& z = sweep_.one_row_impulses();
    double square = 0.0;
    for (size_t k = chunk_begin(y.size(), chunk); k < chunk_begin(y.size(), chunk + 1); ++k)
      for (int i = 0; i < 3; ++i) square += (y[k].y[i] - before_[k].y[i]) * (y[k].y[i] - before_[k].y[i]);
    for (size_t k = chunk_begin(z.size(), chunk); k < chunk_begin(z.size(), chunk + 1); ++k)
      square += (z[k] - one_row_before_[k]) * (z[k] - one_row_before_[k]);
    return square;
  }

  /// x := x + beta p, p := beta p + (x - before), before := the new x.
  static void advance(double beta, double& x, double& p, double& before) {
    const double step = x - before;
    p *= beta;
    x += p;
    p += step;
    before = x;
  }

  void advance_chunk(double beta, int chunk) {
    auto& y = sweep_.friction_impulses();
    for (size_t k = chunk_begin(y.size(), chunk); k < chunk_begin(y.size(), chunk + 1); ++k)
      for (int i = 0; i < 3; ++i) advance(beta, y[k].y[i], direction_[k].y[i], before_[k].y[i]);
    auto& z = sweep_.one_row_impulses();
    for (size_t k = chunk_begin(z.size(), chunk); k < chunk_begin(z.size(), chunk + 1); ++k)
      advance(beta, z[k], one_row_direction_[k], one_row_before_[k]);
    auto& v = sweep_.velocities();
    for (size_t b = chunk_begin(v.size(), chunk); b < chunk_begin(v.size(), chunk + 1); ++b)
      for (int i = 0; i < body_width; ++i)
        advance(beta, v[b].w[i], velocity_direction_[b].w[i], velocity_before_[b].w[i]);
  }

  void remember() {
    before_ = sweep_.friction_impulses();
    one_row_before_ = sweep_.one_row_impulses();
    velocity_before_ = sweep_.velocities();
  }

  /// Moves the iterate along the search direction, and remembers where the next sweep begins.
  void extrapolate() {
    // in chunks whose number doesn't depend on the threads: the same sums
    sweep_.team().run(chunks, [this](int chunk) { squares_[chunk] = chunk_square(chunk); });
    double square = 0.0;
    for (const double part : squares_) square += part;
    double beta = last_square_ > 0.0 ? square / last_square_ : 0.0;
    if (beta > 1.0) beta = 0.0;
    last_square_ = square;
    sweep_.team().run(chunks, [this, beta](int chunk) { advance_chunk(beta, chunk); });
  }

  static constexpr int chunks = 8;
  BodySweep sweep_;
  std::vector<FrictionImpulse> before_, direction_;  // y alone
  std::vector<double> one_row_before_, one_row_direction_;
  double squares_[chunks];
  std::vector<BodyVelocity> velocity_before_, velocity_direction_;
  double last_square_ = 0.0;
  bool swept_ = false;
};

}  // namespace

std::unique_ptr<Solver> make_nncg() { return std::make_unique<Nncg>(); }

}  // namespace ballast
