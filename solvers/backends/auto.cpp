#include "solvers/backends/auto.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/backends/anderson_pgs.hpp"
#include "solvers/backends/interior_point.hpp"
#include "solvers/backends/nesterov_pgs.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/backends/newton_burst.hpp"
#include "solvers/backends/nncg.hpp"
#include "solvers/backends/step_work.hpp"
#include "solvers/backends/work_pace.hpp"
#include "solvers/seam/relay.hpp"

namespace ballast {
namespace {

enum Kind : size_t { momentum, anderson, plain, proximal, burst, interior, conjugate, kinds };

/// What is known of a way before it has shown its pace.
struct Prior {
  double few, per_contact;  ///< steps that it is taken to need; of bursts, rounds
  double trust;             ///< Way::trust
};
using Priors = std::array<Prior, kinds>;

constexpr double never = 1e300;
constexpr Prior not_here{never, 0.0, 1.0};

// Over bodies bursts are the shortest way more often than not, with a stored W proximal steps are:
// that one way's turns are long. Some sweeps come before, for what is easy; the others after, for
// what misleads it. Tuned on generated piles, random graphs and captured stacks, walls, pyramids
// and heaps of boxes; tried on others.
constexpr Priors over_bodies{{{20.0, 0.0, 5.0},
                              {160.0, 0.0, 8.0},
                              {25.0, 0.0, 4.0},
                              {150.0, 0.0, 8.0},
                              {0.0, 0.0, 0.1},
                              {80.0, 0.0, 6.0},
                              not_here}};
constexpr Priors over_matrix{{{0.0, 0.0, 10.0},
                              {100.0, 0.0, 10.0},
                              {50.0, 0.03, 4.0},
                              {8.0, 0.05, 0.3},
                              not_here,
                              {60.0, 0.0, 6.0},
                              {900.0, 0.0, 8.0}}};
/// Where iterations are scarce, one is as dear as another.
constexpr Priors scarce_over_bodies{{{64.0, 0.0, 12.0},
                                     {64.0, 0.0, 12.0},
                                     {16.0, 0.1, 2.0},
                                     {10.0, 0.05, 2.0},
                                     {30.0, 0.0, 2.0},
                                     {40.0, 0.0, 2.0},
                                     not_here}};
constexpr Priors scarce_over_matrix{{{64.0, 0.0, 4.0},
                                     {64.0, 0.0, 4.0},
                                     {30.0, 0.1, 2.0},
                                     {10.0, 0.05, 2.0},
                                     not_here,
                                     {40.0, 0.0, 2.0},
                                     not_here}};

class Auto final : public Solver {
 public:
  Auto() {
    ways_[momentum].solver = make_nesterov_pgs({.returns_best = false});
    ways_[anderson].solver = make_anderson_pgs({});
    ways_[plain].solver = make_newton({.equation = ContactEquation::alart_curnier});
    ways_[proximal].solver = make_proximal_newton({.start_sweeps = 0, .first_weight = 3e-4});
    // Who gives up is decided here.
    ways_[burst].solver = make_newton_burst({.start_sweeps = 0,
                                             .burst = 50,
                                             .is_balanced = true,
                                             .descent_steps = std::numeric_limits<int>::max(),
                                             .most_steps = 1 << 20});
    ways_[interior].solver = make_interior_point();
    ways_[conjugate].solver = make_nncg();
    for (const Kind kind : {plain, proximal, interior}) ways_[kind].only_factors = true;
    for (const Kind kind : {plain, proximal, burst}) ways_[kind].is_newton = true;
  }

  void prepare(const FrictionProblem& problem) override {
    for (Way& way : ways_) way.is_prepared = false;
    prepared(ways_[momentum], problem);  // the others when their turn comes: ordering is dear
  }

  void use_team(WorkerTeam* team) override {
    for (Way& way : ways_) way.solver->use_team(team);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    for (Way& way : ways_) {
      way.pace.begin();
      way.spent = 0.0;
      way.stalls = 0;
      way.at = start;
    }
    const Ending ending{ways_};
    work_.count(problem);
    // Iterations may be scarce: fewer than fair shares of work would take. Then one is as dear as
    // another; but of thousands, the first half is used by what work costs: most sweeps arrive.
    const double fair = 100.0 + 0.15 * problem.contact_count();
    const bool can_end = fair * work_.burst_step() > budget.max_iterations * work_.sweep();
    const int part = budget.max_iterations <= few_iterations ? 0 : budget.max_iterations / 2;
    scarce_from_ = can_end ? part : std::numeric_limits<int>::max();
    is_scarce_ = scarce_from_ == 0;
    expect(problem, budget);
    Relay relay(budget, std::move(start));
    // Always the most promising way; its leg ends where another promises more.
    go(ways_[momentum], relay, problem, budget);
    while (!relay.over()) {
      Way& next = ways_[most_promising(budget)];
      if (next.stalls > most_stalls) break;
      const bool is_news = work_.learn(prepared(next, problem).operations());
      if (is_news) expect(problem, budget);
      if (is_news && &ways_[most_promising(budget)] != &next) continue;
      go(next, relay, problem, budget);
    }
    return relay.finish();
  }

 private:
  /// No way's solve outlives the problem.
  struct Ending {
    std::array<Way, kinds>& ways;
    ~Ending() {
      for (Way& way : ways) way.going.reset();
    }
  };

  static Solver& prepared(Way& way, const FrictionProblem& problem) {
    if (!way.is_prepared) way.solver->prepare(problem);
    way.is_prepared = true;
    return *way.solver;
  }

  /// From here on iterations are what is scarce. Every way begins to count anew.
  void count_iterations(const FrictionProblem& problem, const Budget& budget) {
    is_scarce_ = true;
    for (Way& way : ways_) {
      way.going.reset();
      way.pace.begin();
      way.spent = 0.0;
    }
    expect(problem, budget);
  }

  const Priors& priors(bool has_bodies) const {
    if (is_scarce_) return has_bodies ? scarce_over_bodies : scarce_over_matrix;
    return has_bodies ? over_bodies : over_matrix;
  }

  /// What each way is taken to need before it has shown its pace.
  void expect(const FrictionProblem& problem, const Budget& budget) {
    const bool has_bodies = problem.has_dynamics;
    const double sweep = work_.sweep(), newton = work_.newton_step(), mixed = work_.mixed_sweep();
    const double costs[kinds] = {sweep, mixed, newton, newton, sweep, work_.interior_step(), sweep};
    for (size_t k = 0; k < kinds; ++k) {
      Way& way = ways_[k];
      const Prior& prior = priors(has_bodies)[k];
      way.work = is_scarce_ ? 1.0 : costs[k];
      way.trust = prior.trust;
      double steps = prior.few + prior.per_contact * problem.contact_count();
      // Sweeps come first, until they have cost as much as a Newton step would besides.
      if (k == momentum && !is_scarce_) steps += (has_bodies ? work_.burst_step() : newton) / sweep;
      if (k <= anderson) steps = std::min(steps, std::max(1.0, budget.max_iterations / 8.0));
      way.expected = steps * way.work;
      // Another's iterate misleads more often than it helps, but for proximal steps on a stored W.
      way.takes_best = k == interior ? 0.0 : 0.01;
      if (way.is_newton && is_scarce_) way.takes_best = 0.5;
      if (way.is_newton && !is_scarce_ && !has_bodies) way.takes_best = 0.4;
    }
    if (is_scarce_) {
      ways_[burst].factorisation = 0.0;
      return;
    }
    ways_[burst].factorisation = work_.burst_step() - sweep;
    if (!has_bodies) return;
    ways_[burst].expected = 0.5 * std::sqrt(problem.contact_count()) * work_.burst_step();
    // Where a step costs as much as hundreds of sweeps, those get as much of the work.
    ways_[burst].trust = std::clamp(work_.burst_step() / (150.0 * sweep), ways_[burst].trust, 1.0);
  }

  /// Work until `way` arrives, as far as one can tell: what its pace says, but not more than
  /// `trust` times what it has had: nobody knows what comes. So no way falls far behind another.
  static double promise(const Way& way, const Budget& budget) {
    const double sure = std::max(way.expected, way.trust * way.spent);
    const double needed = way.spent > 0.0 ? std::min(sure, way.pace.left(budget.aim())) : sure;
    return needed * std::pow(10.0, way.stalls);
  }

  size_t most_promising(const Budget& budget) {
    Way &first = ways_[momentum], &mixed = ways_[anderson];
    mixed.expected =
        std::max(mixed.expected, work_.mixed_after() * first.spent / first.work * mixed.work);
    size_t best = 0;
    for (size_t k = 1; k < kinds; ++k)
      if (promise(ways_[k], budget) < promise(ways_[best], budget)) best = k;
    return best;
  }

  /// One leg of `way`: until another is the more promising by far.
  void go(Way& way, Relay& relay, const FrictionProblem& problem, const Budget& budget) {
    const double before = way.spent;
    // A leg that is too short shows nothing: Newton's error stands for long before it falls.
    const double resumed = (&way == &ways_[interior] ? 3.0 : 1.5) * before;
    const double least = before > 0.0 ? resumed : way.expected;
    const int factored = way.factorisations;
    // A solve that can pause may overrun the last few iterations; a first leg of sweeps seldom has
    // a second.
    const int most = budget.max_iterations - last_iterations;
    const bool pauses = !is_scarce_ && relay.iterations() < most && (before > 0.0 || way.is_newton);
    bool has_left = false;
    Solver& solver = prepared(way, problem);
    const auto count = [&](int iterations) {
      way.spent =
          before + iterations * way.work + (way.factorisations - factored) * way.factorisation;
    };
    const auto leaves = [&](int iterations, double error) {
      if (!problem.has_dynamics && !is_scarce_ && way.is_newton && solver.operations() > 0.0)
        way.work = work_.stored_step(solver.operations());
      count(iterations);
      way.pace.add(way.spent, error);
      const int all = relay.iterations() + iterations;
      if ((!is_scarce_ && all >= scarce_from_) || (pauses && all >= most)) return has_left = true;
      if (way.spent < least) return false;
      const Way& other = ways_[most_promising(budget)];
      has_left = promise(way, budget) > by_far * promise(other, budget);
      return has_left;
    };
    const LeaveRule leave = [&](int k, double error, const Impulses&) { return leaves(k, error); };
    relay.run([&](Impulses best, Budget left) {
      // A way's first leg begins where the solve did; that of Newton's ways where iterations are
      // scarce at the best, and with a stored W where the sweeps have come to.
      const Way& first = ways_[momentum];
      const bool is_first = before == 0.0;
      const bool is_own =
          is_first ? way.takes_best < 0.1 : relay.error() > way.takes_best * way.pace.error();
      if (!is_own || !pauses) way.going.reset();
      if (is_own)
        best = way.at;
      else if (is_first && !is_scarce_ && relay.error() > 0.01 * first.pace.error())
        best = first.at;
      left.factorisations = &way.factorisations;
      left.leave = &leave;
      if (!way.going && pauses)
        way.going = std::make_unique<PausedSolve>(solver, problem, best, left);
      Solved part =
          pauses ? way.going->go_on(leaves) : solver.solve(problem, std::move(best), left);
      if (way.going && way.going->is_over()) way.going.reset();
      count(part.iterations);
      way.at = part.impulses;
      if (!has_left) ++way.stalls;
      if (budget.factorisations)
        *budget.factorisations +=
            way.only_factors ? part.iterations : way.factorisations - factored;
      return part;
    });
    if (!is_scarce_ && relay.iterations() >= scarce_from_) count_iterations(problem, budget);
  }

  /// Of so few every iteration counts from the first.
  static constexpr int few_iterations = 500;
  /// Before so many are left no solve pauses: some look at their error once in hundreds.
  static constexpr int last_iterations = 1000;
  /// Changing ways costs: the other's promise must be so much better.
  static constexpr double by_far = 1.6;
  /// How often every way may end without arriving and by itself.
  static constexpr int most_stalls = 12;

  std::array<Way, kinds> ways_;
  StepWork work_;
  bool is_scarce_ = false;
  int scarce_from_ = 0;  ///< so many iterations of the whole solve
};

}  // namespace

std::unique_ptr<Solver> make_auto() { return std::make_unique<Auto>(); }

}  // namespace ballast
