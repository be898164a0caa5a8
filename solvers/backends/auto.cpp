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

/// Way::trust of sweeps; where iterations are scarce; of others.
constexpr double moderate = 4.0, little = 12.0, doubtful = 2.0;

class Auto final : public Solver {
 public:
  Auto() {
    ways_[momentum].solver = make_nesterov_pgs();
    ways_[anderson].solver = make_anderson_pgs({});
    ways_[plain].solver = make_newton({.equation = ContactEquation::alart_curnier});
    ways_[proximal].solver = make_proximal_newton({.start_sweeps = 0, .first_weight = 3e-4});
    set_scarce(false);
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
    team_ = team;
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
    if (is_scarce_ != (scarce_from_ == 0)) set_scarce(!is_scarce_);
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
  enum Kind : size_t { momentum, anderson, plain, proximal, burst, interior, conjugate, kinds };

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

  /// Are iterations what is scarce? Then hardly any bursts; else until proximal steps are much
  /// faster.
  void set_scarce(bool is_scarce) {
    is_scarce_ = is_scarce;
    Way& way = ways_[burst];
    way.going.reset();
    const double endgame = is_scarce ? 1e-2 : 1e-4;
    way.solver = make_newton_burst(
        {.start_sweeps = 0, .burst = 50, .endgame = endgame, .descends_first = true});
    way.solver->use_team(team_);
    way.is_prepared = false;
  }

  /// From here on iterations are what is scarce. Every way begins to count anew.
  void count_iterations(const FrictionProblem& problem, const Budget& budget) {
    set_scarce(true);
    for (Way& way : ways_) {
      way.pace.begin();
      way.spent = 0.0;
    }
    expect(problem, budget);
  }

  /// What each way is taken to need before it has shown its pace.
  void expect(const FrictionProblem& problem, const Budget& budget) {
    const double contacts = problem.contact_count();
    const bool has_bodies = problem.has_dynamics;
    const double sweep = work_.sweep(), newton = work_.newton_step();
    const double costs[kinds] = {sweep, work_.mixed_sweep(),   newton, newton,
                                 sweep, work_.interior_step(), sweep};
    for (size_t k = 0; k < kinds; ++k) {
      Way& way = ways_[k];
      way.work = is_scarce_ ? 1.0 : costs[k];
      way.trust = way.is_newton || k == interior ? doubtful : moderate;
      if (is_scarce_ && has_bodies && k <= anderson) way.trust = little;
      // Another's iterate misleads more often than it helps, but for proximal steps on a stored W.
      way.takes_best = k == interior ? 0.0 : 0.01;
      if (way.is_newton && is_scarce_) way.takes_best = 0.5;
      if (way.is_newton && !is_scarce_ && !has_bodies) way.takes_best = 0.4;
    }
    if (!is_scarce_ && !has_bodies) ways_[proximal].trust = 1.0;
    ways_[burst].factorisation = is_scarce_ ? 0.0 : work_.burst_step() - sweep;

    // So many steps; over bodies bursts of sweeps are the shortest way more often than not, with a
    // stored W proximal steps are, and where iterations are scarce.
    const auto steps = [&](Kind kind, double few, double per_contact) {
      ways_[kind].expected = (few + per_contact * contacts) * ways_[kind].work;
    };
    const int few = std::clamp(budget.max_iterations / 8, 1, is_scarce_ ? 64 : 160);
    for (const Kind kind : {momentum, anderson}) steps(kind, few, 0.0);
    steps(interior, is_scarce_ ? 40.0 : 80.0, 0.0);
    steps(plain, has_bodies ? 16.0 : 30.0, is_scarce_ || !has_bodies ? 0.1 : 0.07);
    if (is_scarce_)
      steps(proximal, 10.0, 0.05);
    else
      steps(proximal, has_bodies ? 20.0 : 10.0, has_bodies ? 0.5 : 0.035);
    const double rounds = is_scarce_ ? 30.0 : 4.0 + 0.01 * contacts;
    ways_[burst].expected = rounds * (is_scarce_ ? 1.0 : work_.burst_step());
    // Of many contacts bursts arrive nearly always, though their error may stand for long.
    if (!is_scarce_) ways_[burst].trust = std::min(4.0, 100.0 / std::pow(contacts, 1.5));
    steps(conjugate, 600.0, 0.0);
    if (has_bodies || is_scarce_) ways_[conjugate].expected = never;
    if (!has_bodies) ways_[burst].expected = never;
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

  // Tuned on generated piles, random graphs (seeds below 1000) and captured stacks, walls, pyramids
  // and heaps of boxes; tried on others.
  static constexpr double never = 1e300;
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
  WorkerTeam* team_ = nullptr;
  int scarce_from_ = 0;  ///< so many iterations of the whole solve
};

}  // namespace

std::unique_ptr<Solver> make_auto() { return std::make_unique<Auto>(); }

}  // namespace ballast
