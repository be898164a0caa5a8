#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "solvers/backends/backends.hpp"
#include "solvers/gauss_seidel/any_sweep.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

/// A rule that accelerates sweeps: after each, the iterate moves on in a direction made of the
/// changes of earlier sweeps.
class SearchRule {
 public:
  virtual ~SearchRule() = default;
  /// A solve begins.
  virtual void reset() = 0;
  /// The search begins at the current iterate.
  virtual void forget() = 0;
  /// Returns the step before the next sweep. `square`: |d|^2 of the change d of the last sweep; 0
  /// before the first.
  virtual SearchStep next(double square) = 0;
  /// Told the error at each look [m/s]. True: the search ends, and the next begins at the iterate.
  virtual bool see(double error) = 0;
  /// Whether it is time for a look.
  virtual bool asks() const { return false; }
};

// With r^_k the iterate that sweep k left, and d_k its change:
//   r := r^_k + beta (r^_k - r^_k-1),  beta = j / (j + 2) in the j-th sweep of a search
//   r^_k+1 := sweep(r)
// Where iterates converge by a factor q a sweep, the best beta is about q^2: so beta is never more
// than the mean factor of |d|^2 over the last sweeps. The law is not a minimisation, and momentum
// may circle: a search ends when |d|^2 grows, and after some short searches in a row plain sweeps
// follow for a while.
class Momentum final : public SearchRule {
 public:
  void reset() override { *this = {}; }
  void forget() override { swept_ = 0; }

  SearchStep next(double square) override {
    ++total_;
    if (++swept_ == 1) return {};
    if (swept_ == 2 || resting_ > 0) {
      resting_ = std::max(0, resting_ - 1);
      begin_search(square);
      return {};
    }
    squares_[++age_ % window] = square;
    least_ = std::min(least_, square);
    if (square > rise * least_) {
      vain_ = age_ < short_search ? vain_ + 1 : 0;
      if (vain_ == most_vain) {
        vain_ = 0;
        resting_ = rest;
      }
      begin_search(square);
      return {};
    }
    return {.beta = std::min(age_ / (age_ + 2.0), mean_factor(square))};
  }

  /// Where a quarter more sweeps gained less than a tenth, momentum circles without end: plain
  /// sweeps follow, more of them each time. next() ends a search by the changes of its sweeps.
  bool see(double error) override {
    best_ = std::min(best_, error);
    if (!asks()) return false;
    if (best_ > 0.9 * best_at_mark_) resting_ = ++losses_ * total_ / 4;
    mark_ = total_;
    best_at_mark_ = best_;
    return false;
  }
  bool asks() const override {
    return resting_ == 0 && total_ >= std::max(first_mark, 5 * mark_ / 4);
  }

 private:
  void begin_search(double square) {
    age_ = 0;
    squares_[0] = least_ = square;
  }
  /// The mean over the last 1, 2, 4 or 8 sweeps: their roots are square roots, which are the same
  /// on every machine.
  double mean_factor(double square) const {
    int sweeps = 1;
    while (2 * sweeps <= std::min(age_, window - 1)) sweeps *= 2;
    double factor = square / squares_[(age_ - sweeps) % window];
    for (int root = sweeps; root > 1; root /= 2) factor = std::sqrt(factor);
    return factor;
  }

  static constexpr double rise = 1.3;     ///< of |d|^2, over the least one of its search
  static constexpr int window = 9;        ///< squares for a mean factor
  static constexpr int short_search = 6;  ///< sweeps
  static constexpr int most_vain = 3;     ///< short searches one after the other
  static constexpr int rest = 32;         ///< plain sweeps after them
  static constexpr int first_mark = 256;  ///< sweeps before momentum is judged by the error

  int swept_ = 0;                          ///< sweeps from the current start
  int age_ = 0;                            ///< sweeps since the search began
  double squares_[window]{};               ///< |d|^2, by age
  double least_ = 0.0;                     ///< of the search
  int total_ = 0, mark_ = 0, losses_ = 0;  ///< sweeps; at the last judgement; lost judgements
  double best_ = std::numeric_limits<double>::max(), best_at_mark_ = best_;  ///< errors [m/s]
  int vain_ = 0, resting_ = 0;  ///< short searches in a row; plain sweeps still to come
};

// One iteration, with r^ the iterate that the last sweep left and r the one it began from:
//   d = r^ - r (minus the gradient),  beta = |d|^2 / |d before|^2
//   beta > 1: the search restarts, p = 0, r := r^
//   else      r := r^ + beta p,  p := beta p + d
//   r^ := sweep(r)
// The law is not a minimisation, and the search may circle: when the error has grown from one look
// to the next, plain sweeps follow until the look after that.
class FletcherReeves final : public SearchRule {
 public:
  void reset() override { *this = {}; }
  void forget() override { begins_ = true; }

  /// The first sweep of a search is plain.
  SearchStep next(double square) override {
    if (begins_) last_ = 0.0;
    if (std::exchange(begins_, false) || !accelerates_) return {.beta = 0.0, .is_conjugate = true};
    double beta = last_ > 0.0 ? square / last_ : 0.0;
    if (beta > 1.0) beta = 0.0;
    last_ = square;
    return {.beta = beta, .is_conjugate = true};
  }

  bool see(double error) override {
    accelerates_ = !accelerates_ || error < last_error_;
    last_error_ = error;
    return !accelerates_;
  }

 private:
  bool begins_ = true, accelerates_ = true;
  double last_ = 0.0;  ///< |d|^2 of the sweep before the last
  double last_error_ = std::numeric_limits<double>::max();
};

/// Decides when to look at the error of sweeps along a search. The square of a sweep's change costs
/// nothing, and within a solve it stays proportional to the square of the error, within a tenth.
class SweptChange {
 public:
  /// `is_dear`: a look costs as much as some sweeps.
  SweptChange(double aim, bool is_dear) : aim_(aim), is_dear_(is_dear) {}

  /// Told the error [m/s] of each look, and `square` of the sweep before it, or of the first one.
  void seen(int sweeps, double square, double error) {
    next_ = sweeps + (sweeps == 0 ? 2 : is_dear_ ? std::max(apart, sweeps / 16) : apart);
    enough_ = square * (near * aim_ / error) * (near * aim_ / error);
  }
  /// Whether the error is likely to be small enough.
  bool promises(int sweeps, double square) const { return sweeps >= next_ && square <= enough_; }

 private:
  static constexpr int apart = 4;  // sweeps between two looks, at least
  static constexpr double near = 0.97;
  double aim_, enough_ = -1.0;
  bool is_dear_;
  int next_ = 0;
};

/// Sweeps, plain or along a search. Besides the start only swept iterates, which lie in the cones,
/// are ever judged or returned.
class GaussSeidel final : public Solver {
 public:
  /// A null rule gives plain sweeps. `returns_best`: see make_nesterov_pgs().
  GaussSeidel(std::unique_ptr<SearchRule> rule, bool returns_best)
      : rule_(std::move(rule)), returns_best_(returns_best) {}

  void prepare(const FrictionProblem& problem) override { sweep_.prepare(problem); }
  void use_team(WorkerTeam* team) override { sweep_.use_team(team); }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    // The cost of looking at the error stays below about 15 %.
    Iteration iteration(budget, rule_ ? CheckSchedule{8, 1.6, 2.0} : CheckSchedule{4, 1.25});
    SweptChange change(budget.aim(), /*is_dear=*/budget.fclib);
    if (rule_) rule_->reset();
    // No single precision where the budget asks for another measure, which may stop a solve between
    // two looks of ours.
    sweep_->allow_single(!budget.fclib);
    load(problem, r);
    Impulses best(returns_best_ ? problem.row_count() : 0);  // of all looks at storable iterates
    bool is_best = false, is_stored = false;
    double least = std::numeric_limits<double>::infinity(), square = 0.0;
    const auto looked = [&](double error) {
      is_best = returns_best_ && error < least && sweep_->is_storable();
      is_stored = is_best || budget.fclib;
      if (is_stored) sweep_->store(problem, r);
      iteration.evaluated(error, r);
      if (rule_ && rule_->see(error)) begin_search();
      if (!is_best) return;
      least = error;
      best.swap(r);  // the next look fills r anew
    };
    const double first = sweep_->error();
    looked(first);
    while (iteration.next()) {
      if (rule_)
        square = sweep_->sweep_along(rule_->next(square));
      else
        sweep_->sweep();
      if (iteration.count() == 1) change.seen(0, square, first);
      const bool is_asked = rule_ && (change.promises(iteration.count(), square) || rule_->asks());
      if (!iteration.is_error_due() && !is_asked) continue;
      const double error = sweep_->rough_error();
      looked(iteration.ends_with(error) ? last_error(problem, iteration, r) : error);
      if (iteration.is_over() && !sweep_->is_storable()) looked(last_error(problem, iteration, r));
      change.seen(iteration.count(), square, error);
    }
    if (!is_stored) sweep_->store(problem, r);  // drops impulses that move nothing
    Solved solved = iteration.finish(std::move(is_best ? best : r));
    if (least < solved.own_residual && solved.reason != StopReason::reached_tolerance) {
      solved.impulses = std::move(best);
      solved.own_residual = solved.end_error = least;
      if (!solved.history.empty()) solved.history.back().error = least;
    }
    return solved;
  }

 private:
  void load(const FrictionProblem& problem, const Impulses& r) {
    sweep_->load(problem, r);
    if (rule_) begin_search();
  }
  void begin_search() {
    rule_->forget();
    sweep_->start_search();
  }

  /// The error [m/s] of an iterate that may be returned. In double an error small enough to stop is
  /// evaluated again from the impulses alone, as the judge will: thousands of updates have left
  /// their rounding in the velocities.
  double last_error(const FrictionProblem& problem, const Iteration& iteration, Impulses& r) {
    const double error = sweep_->error();
    if (sweep_->is_single() || !iteration.reached(error)) return error;
    sweep_->store(problem, r);
    load(problem, r);
    return sweep_->error();
  }

  std::unique_ptr<SearchRule> rule_;
  bool returns_best_;
  AnySweep sweep_;
};

using Looks = std::vector<std::pair<int, double>>;  ///< sweeps, error

/// Adds a look and returns the number of further sweeps from this error to the aim. Errors fall
/// about like a power of the number of sweeps; the exponent, small in jams, comes from the later
/// half of the sweeps.
double sweeps_left(Looks& looks, int sweeps, double error, double aim) {
  constexpr double unknown = 1e300;
  if (sweeps == 0) return unknown;
  looks.emplace_back(sweeps, error);
  size_t k = looks.size() - 1;
  while (k > 0 && 2 * looks[k].first > sweeps) --k;
  const auto& [then, before] = looks[k];
  if (2 * then > sweeps || !(before > error)) return unknown;
  const double exponent = std::log(before / error) / std::log(1.0 * sweeps / then);
  return sweeps * (std::pow(error / aim, 1.0 / exponent) - 1.0);
}

}  // namespace

std::unique_ptr<Solver> make_gauss_seidel() {
  return std::make_unique<GaussSeidel>(/*rule=*/nullptr, /*returns_best=*/false);
}

std::unique_ptr<Solver> make_nesterov_pgs(bool returns_best) {
  return std::make_unique<GaussSeidel>(std::make_unique<Momentum>(), returns_best);
}

std::unique_ptr<Solver> make_nncg() {
  return std::make_unique<GaussSeidel>(std::make_unique<FletcherReeves>(), /*returns_best=*/false);
}

double sweeps_of_step(int contacts) { return 1.3 * std::sqrt(contacts * std::sqrt(contacts)); }

decltype(Budget::gives_up) sweep_stop_rule(double step, double at_most, const Budget& budget) {
  const int least_near = static_cast<int>(std::min(8.0 * step, at_most)),
            least_far = std::min(500, least_near);
  return [=, &budget, looks = Looks(), refusals = 0](int sweeps, double error) mutable {
    constexpr double near = 30.0;  // in units of budget.aim()
    // A single look may have caught the error while it rose.
    refusals = sweeps_left(looks, sweeps, error, budget.aim()) > 12.0 * step ? refusals + 1 : 0;
    return refusals > 1 && sweeps >= (error < near * budget.aim() ? least_near : least_far);
  };
}

}  // namespace ballast
