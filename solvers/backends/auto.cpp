#include "solvers/backends/auto.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "solvers/backends/anderson_pgs.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/backends/interior_point.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/backends/newton_burst.hpp"
#include "solvers/backends/nncg.hpp"
#include "solvers/seam/relay.hpp"

namespace ballast {
namespace {

// Work is counted, not clocked: the same problem takes the same turns and gives the same bits on
// every machine and under every load. The unit is one multiplication with its addition.

/// A sweep over bodies, per contact.
constexpr double body_visit = 40.0;
/// A sweep over a stored W, per entry and per contact: the contact's own solution.
constexpr double matrix_entry = 1.0, matrix_visit = 60.0;
/// A Newton step: linearisation and line search per contact; the factorisation over bodies per
/// unknown, twice that where there are so many that the fill tells.
constexpr double newton_contact = 300.0, body_unknown = 1000.0, filled_unknowns = 1500.0;
/// Newton's part in an iteration of `burst`, which counts its sweeps and its steps alike.
constexpr double burst_steps = 0.05;
/// The same of a stored W (newton_matrix.hpp): dense where rows are few or W is nearly full. A
/// sparse factorisation is mostly bookkeeping, row by row.
constexpr double few_rows = 200.0, nearly_full = 0.1;
constexpr double dense_entry = 15.0, dense_cube = 0.05, sparse_row = 8000.0;

/// How fast one way's error has come down.
class Pace {
 public:
  void begin() { points_.clear(); }
  void add(int iteration, double error) {
    if (!points_.empty()) error = std::min(error, points_.back().error);
    points_.push_back({iteration, error});
  }
  double error() const { return points_.empty() ? 1e300 : points_.back().error; }
  /// ln of the error per iteration, over the later half of the iterations; 0: it stands still.
  double rate() const {
    if (points_.empty()) return 0.0;
    const Point& last = points_.back();
    size_t k = points_.size() - 1;
    while (k > 0 && 2 * points_[k].iteration > last.iteration) --k;
    const double iterations = last.iteration - points_[k].iteration;
    return iterations > 0.0 && last.error > 0.0
               ? std::log(points_[k].error / last.error) / iterations
               : 0.0;
  }
  /// Iterations to `aim` at that rate.
  double left(double aim) const {
    if (!(error() > aim)) return 0.0;
    const double pace = rate();
    return pace > 0.0 && aim > 0.0 ? std::log(error() / aim) / pace : 1e300;
  }

 private:
  struct Point {
    int iteration;
    double error;
  };
  std::vector<Point> points_;
};

/// One way to the solution, from an iterate of its own: where another way has come to misleads
/// accelerated sweeps more often than it helps them.
struct Way {
  std::unique_ptr<Solver> solver;
  /// It goes on from the best iterate where that is so much better than its own.
  double takes_best = 0.0;
  double least_part = 0.5;  ///< of what is expected: the shortest leg
  bool is_prepared = false;
  double work = 0.0;      ///< of an iteration
  double expected = 0.0;  ///< iterations, as long as it has not shown its pace
  Pace pace;
  int iterations = 0, stalls = 0;
  Impulses at;
};

class Auto final : public Solver {
 public:
  Auto() {
    ways_[conjugate].solver = make_nncg();
    ways_[anderson].solver = make_anderson_pgs({});
    ways_[newton].solver = make_proximal_newton({.start_sweeps = 0, .first_weight = 1e-4});
    ways_[burst].solver = make_newton_burst({.start_sweeps = 0, .burst = 50, .endgame = 1e-2});
    ways_[interior_point].solver = make_interior_point();
    for (const Kind kind : {conjugate, anderson}) ways_[kind].takes_best = 0.01;
    for (const Kind kind : {newton, burst}) ways_[kind].takes_best = 0.5;
    ways_[burst].least_part = 5.0;
    for (const Kind kind : {newton, interior_point}) ways_[kind].least_part = 2.5;
  }

  void prepare(const FrictionProblem& problem) override {
    for (Way& way : ways_) way.is_prepared = false;
    // The others are prepared when their turn comes: ordering costs as much as many sweeps.
    prepared(ways_[conjugate], problem);
    count_work(problem);
  }

  void use_threads(int threads) override {
    for (Way& way : ways_) way.solver->use_threads(threads);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    for (Way& way : ways_) {
      way.pace.begin();
      way.iterations = way.stalls = 0;
      way.at = start;
    }
    most_promising(budget, 0);
    Relay relay(budget, std::move(start));
    // Always the most promising way; its leg ends where another promises more. Whatever the budget,
    // the first leg says how good the start is.
    go(ways_[conjugate], relay, problem, budget);
    while (!relay.over()) {
      Way& next = ways_[most_promising(budget, relay.iterations())];
      if (next.stalls > most_stalls) break;
      go(next, relay, problem, budget);
    }
    return relay.finish();
  }

 private:
  enum Kind : size_t { conjugate, anderson, newton, burst, interior_point, kinds };

  static Solver& prepared(Way& way, const FrictionProblem& problem) {
    if (!way.is_prepared) way.solver->prepare(problem);
    way.is_prepared = true;
    return *way.solver;
  }

  /// What an iteration of each way costs: of a factorisation, as many operations as of one whose
  /// bandwidth is the mean filled row's.
  void count_work(const FrictionProblem& problem) {
    const double contacts = problem.contact_count();
    double sweep = 0.0, step = 0.0;
    if (problem.has_dynamics) {
      sweep = body_visit * contacts;
      const double unknowns = problem.dynamics.dof_count();
      step = body_unknown * unknowns * (1.0 + unknowns / filled_unknowns);
      step += newton_contact * contacts;
    } else {
      const double rows = problem.row_count();
      const double entries = static_cast<double>(problem.delassus.w.nonZeros());
      sweep = matrix_entry * entries + matrix_visit * contacts;
      const bool is_dense = rows <= few_rows || entries > nearly_full * rows * rows;
      const double dense = dense_entry * entries + dense_cube * rows * rows * rows;
      const double sparse = sparse_row * rows;
      step = newton_contact * contacts + (is_dense ? std::min(dense, sparse) : sparse);
    }
    ways_[conjugate].work = sweep;
    ways_[anderson].work = mixing * sweep;
    ways_[newton].work = step;
    ways_[burst].work = sweep + burst_steps * step;
    ways_[interior_point].work = interior_factor * step;
    ways_[newton].expected = expected_steps + expected_steps_per_contact * contacts;
    ways_[burst].expected = problem.has_dynamics ? expected_burst : never;
    ways_[interior_point].expected = expected_interior;
  }

  /// Work until `way` arrives, as far as one can tell: what its pace says, but not more than twice
  /// what it has had: nobody knows what comes. So no way falls far behind another.
  double promise(const Way& way, const Budget& budget, int spent) const {
    const double rest = budget.max_iterations - spent;
    if (way.iterations == 0 && way.least_part * way.expected > rest) return never;
    const double sure = std::max(way.expected, 2.0 * way.iterations);
    const double needed = way.iterations > 0 ? std::min(sure, way.pace.left(budget.aim())) : sure;
    return needed * (is_scarce_ ? 1.0 : way.work) * std::pow(4.0, way.stalls);
  }

  size_t most_promising(const Budget& budget, int spent) {
    // Sweeps of either kind are first taken to need what the first kind has had.
    const int few = std::clamp(budget.max_iterations / 8, 1, few_sweeps);
    const Way& first = ways_[conjugate];
    ways_[conjugate].expected = few;
    ways_[anderson].expected = std::max(1.0 * few, 0.6 * first.iterations);
    // Iterations may be what is scarce: fewer than fair shares of work would take. Then one is as
    // dear as another.
    const Way& steps = ways_[newton];
    is_scarce_ = 3.0 * steps.expected * steps.work > (budget.max_iterations - spent) * first.work;
    size_t best = 0;
    for (size_t k = 1; k < kinds; ++k)
      if (promise(ways_[k], budget, spent) < promise(ways_[best], budget, spent)) best = k;
    return best;
  }

  /// One leg of `way`: until another is the more promising by far.
  void go(Way& way, Relay& relay, const FrictionProblem& problem, const Budget& budget) {
    const int before = way.iterations, all_before = relay.iterations();
    const bool goes_on = &way != &ways_[interior_point];
    // A leg that is too short shows nothing: Newton's error stands for long before it falls.
    const double resumed = goes_on ? 0.5 * before : 2.0 * before;
    const double least = std::max(way.least_part * way.expected, resumed);
    bool has_left = false;
    const std::function<bool(int, double)> leave = [&](int iteration, double error) {
      way.iterations = before + iteration;
      way.pace.add(way.iterations, error);
      if (iteration < least) return false;
      const int spent = all_before + iteration;
      const Way& other = ways_[most_promising(budget, spent)];
      has_left = promise(way, budget, spent) > by_far * promise(other, budget, spent);
      return has_left;
    };
    Solver& solver = prepared(way, problem);
    relay.run([&](Impulses best, Budget left) {
      left.leave = &leave;
      const bool is_own =
          before > 0 ? relay.error() > way.takes_best * way.pace.error() : way.takes_best < 0.1;
      Solved part = solver.solve(problem, is_own ? way.at : std::move(best), left);
      way.iterations = before + part.iterations;
      way.at = part.impulses;
      if (!has_left) ++way.stalls;
      return part;
    });
  }

  /// Tuned on generated piles (pile:family, seeds 1 to 40) and on captured stacks, walls, pyramids
  /// and heaps of boxes; tried on others.
  static constexpr double never = 1e300;
  /// Sweeps that are taken to be enough before they have shown their pace.
  static constexpr int few_sweeps = 64;
  /// A sweep with Anderson's mixing over one without.
  static constexpr double mixing = 1.5;
  /// What Newton is expected to need.
  static constexpr double expected_steps = 10.0, expected_steps_per_contact = 0.05;
  /// What Newton with bursts of sweeps is taken to need at least.
  static constexpr double expected_burst = 20.0;
  /// What an interior point is expected to need, and its step over Newton's.
  static constexpr double expected_interior = 50.0, interior_factor = 1.5;
  /// Changing ways costs: the other's promise must be so much better.
  static constexpr double by_far = 1.5;
  /// How often every way may end without arriving and by itself.
  static constexpr int most_stalls = 12;

  std::array<Way, kinds> ways_;
  bool is_scarce_ = false;
};

}  // namespace

std::unique_ptr<Solver> make_auto() { return std::make_unique<Auto>(); }

}  // namespace ballast
