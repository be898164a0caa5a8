#include "solvers/backends/auto.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "solvers/backends/anderson_pgs.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/backends/interior_point.hpp"
#include "solvers/backends/nesterov_pgs.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/backends/newton_burst.hpp"
#include "solvers/backends/work_pace.hpp"
#include "solvers/seam/relay.hpp"

namespace ballast {
namespace {

// Work is counted, not clocked: the same problem takes the same turns and gives the same bits on
// every machine and under every load. The unit is one multiplication with its addition.

/// A sweep over bodies, per contact.
constexpr double body_visit = 40.0;
/// A sweep over a stored W, per entry and per contact: the contact's own solution.
constexpr double matrix_entry = 1.0, matrix_visit = 60.0;
/// What a sweep takes besides, whatever the size.
constexpr double small_sweep = 1000.0;
/// Anderson's mixing: its sweep over one without.
constexpr double mixing_bodies = 2.5, mixing_matrix = 1.6;
/// A Newton step: linearisation and line search per contact, assembly per unknown, and of the
/// factorisation per operation. Before those are known it is taken for the fill of packings: as
/// much as the assembly for so many unknowns.
constexpr double newton_contact = 750.0, body_unknown = 500.0, front_operation = 0.25;
constexpr double filled_unknowns = 500.0;
/// The same of a stored W (newton_matrix.hpp): dense where rows are few or W is nearly full. A
/// sparse factorisation is mostly bookkeeping, row by row.
constexpr double few_rows = 200.0, nearly_full = 0.1;
constexpr double dense_entry = 8.0, dense_cube = 0.015;
constexpr double sparse_row = 3000.0, filled_rows = 600.0;
/// An interior point's step over Newton's.
constexpr double interior_factor = 2.0;

/// Way::trust of sweeps; where iterations are scarce; of bursts, which arrive the most often of
/// Newton's ways though their error may stand for long; of others.
constexpr double moderate = 4.0, little = 12.0, reliable = 0.25, doubtful = 2.0;

class Auto final : public Solver {
 public:
  Auto() {
    ways_[momentum].solver = make_nesterov_pgs();
    ways_[anderson].solver = make_anderson_pgs({});
    ways_[plain].solver = make_newton({.equation = ContactEquation::alart_curnier});
    ways_[proximal].solver = make_proximal_newton({.start_sweeps = 0, .first_weight = 3e-4});
    set_scarce(false);
    ways_[interior].solver = make_interior_point();
    for (const Kind kind : {momentum, anderson}) ways_[kind].takes_best = 0.01;
    for (const Kind kind : {plain, proximal, burst}) ways_[kind].takes_best = 0.5;
    for (const Kind kind : {momentum, anderson, burst}) ways_[kind].only_factors = false;
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
    count_work(problem);
    // Iterations may be scarce: fewer than fair shares of work would take. Then one is as dear as
    // another; but of thousands, the first half is used by what work costs: most sweeps arrive.
    const double fair = 100.0 + 0.15 * problem.contact_count();
    const bool can_end = fair * step_ > budget.max_iterations * sweep_;
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
      const bool is_news = learn_step(prepared(next, problem), problem, budget);
      if (is_news && &ways_[most_promising(budget)] != &next) continue;
      go(next, relay, problem, budget);
    }
    return relay.finish();
  }

 private:
  enum Kind : size_t { momentum, anderson, plain, proximal, burst, interior, kinds };

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
    const double endgame = is_scarce ? 1e-2 : 1e-4;
    way.solver = make_newton_burst({.start_sweeps = 0, .burst = 50, .endgame = endgame});
    way.solver->use_team(team_);
    way.is_prepared = false;
  }

  /// What a sweep and a Newton step cost, as far as sizes tell.
  void count_work(const FrictionProblem& problem) {
    const double contacts = problem.contact_count();
    knows_step_ = false;
    if (problem.has_dynamics) {
      const double unknowns = problem.dynamics.dof_count();
      sweep_ = small_sweep + body_visit * contacts;
      step_ =
          newton_contact * contacts + body_unknown * unknowns * (1.0 + unknowns / filled_unknowns);
    } else {
      const double rows = problem.row_count();
      const double entries = static_cast<double>(problem.delassus.w.nonZeros());
      sweep_ = small_sweep + matrix_entry * entries + matrix_visit * contacts;
      const bool is_dense = rows <= few_rows || entries > nearly_full * rows * rows;
      const double dense = dense_entry * entries + dense_cube * rows * rows * rows;
      const double sparse = sparse_row * rows * (1.0 + rows / filled_rows);
      step_ = newton_contact * contacts + (is_dense ? std::min(dense, sparse) : sparse);
    }
    // Mixing is cheap with a stored W. Where a factorisation is dear it is tried before.
    mixed_part_ = problem.has_dynamics && step_ < dear_step * sweep_ ? 2.0 : 0.5;
  }

  /// The first solver that is prepared for factorisations over bodies knows their fill. True: that
  /// was not known before.
  bool learn_step(const Solver& solver, const FrictionProblem& problem, const Budget& budget) {
    const double operations = solver.operations();
    if (knows_step_ || operations == 0.0) return false;
    knows_step_ = true;
    step_ = newton_contact * problem.contact_count() + body_unknown * problem.dynamics.dof_count() +
            front_operation * operations;
    expect(problem, budget);
    return true;
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
    const auto steps = [&](double few, double per_contact) { return few + per_contact * contacts; };
    const double sweep = is_scarce_ ? 1.0 : sweep_, step = is_scarce_ ? 1.0 : step_;
    const double mixing = problem.has_dynamics ? mixing_bodies : mixing_matrix;
    ways_[momentum].work = sweep;
    ways_[anderson].work = is_scarce_ ? 1.0 : mixing * sweep;
    ways_[plain].work = ways_[proximal].work = step;
    ways_[burst].work = sweep;
    ways_[burst].factorisation = step - sweep;
    ways_[interior].work = is_scarce_ ? 1.0 : interior_factor * step;

    const int few = std::clamp(budget.max_iterations / 8, 1, few_sweeps);
    for (const Kind kind : {momentum, anderson}) {
      ways_[kind].expected = few * ways_[kind].work;
      ways_[kind].trust = is_scarce_ && problem.has_dynamics ? little : moderate;
    }
    // Over bodies bursts of sweeps are the shortest way more often than not; with a stored W
    // proximal steps are, and where iterations are scarce.
    const bool bursts = problem.has_dynamics && !is_scarce_;
    ways_[burst].expected = (bursts ? steps(4.0, 0.01) : 30.0) * step;
    if (!problem.has_dynamics) ways_[burst].expected = never;
    ways_[plain].expected = steps(problem.has_dynamics ? 16.0 : 30.0, 0.1) * step;
    ways_[proximal].expected =
        (bursts ? steps(20.0, 0.1) : steps(10.0, is_scarce_ ? 0.05 : 0.03)) * step;
    ways_[interior].expected = 40.0 * ways_[interior].work;
    ways_[burst].trust = is_scarce_ ? doubtful : reliable;
  }

  /// Work until `way` arrives, as far as one can tell: what its pace says, but not more than
  /// `trust` times what it has had: nobody knows what comes. So no way falls far behind another.
  static double promise(const Way& way, const Budget& budget) {
    const double sure = std::max(way.expected, way.trust * way.spent);
    const double needed = way.spent > 0.0 ? std::min(sure, way.pace.left(budget.aim())) : sure;
    return needed * std::pow(4.0, way.stalls);
  }

  size_t most_promising(const Budget& budget) {
    Way &first = ways_[momentum], &mixed = ways_[anderson];
    mixed.expected = std::max(mixed.expected, mixed_part_ * first.spent / first.work * mixed.work);
    size_t best = 0;
    for (size_t k = 1; k < kinds; ++k)
      if (promise(ways_[k], budget) < promise(ways_[best], budget)) best = k;
    return best;
  }

  /// One leg of `way`: until another is the more promising by far.
  void go(Way& way, Relay& relay, const FrictionProblem& problem, const Budget& budget) {
    const double before = way.spent;
    const bool goes_on = &way != &ways_[interior];
    // A leg that is too short shows nothing: Newton's error stands for long before it falls.
    const double resumed = (goes_on ? 1.5 : 3.0) * before;
    const double least = before > 0.0 ? resumed : way.expected;
    int factorisations = 0;
    bool has_left = false;
    const auto work = [&](int iterations) {
      return before + iterations * way.work + factorisations * way.factorisation;
    };
    const std::function<bool(int, double)> leave = [&](int iterations, double error) {
      way.spent = work(iterations);
      way.pace.add(way.spent, error);
      if (!is_scarce_ && relay.iterations() + iterations >= scarce_from_) return has_left = true;
      if (way.spent < least) return false;
      const Way& other = ways_[most_promising(budget)];
      has_left = promise(way, budget) > by_far * promise(other, budget);
      return has_left;
    };
    Solver& solver = prepared(way, problem);
    relay.run([&](Impulses best, Budget left) {
      left.leave = &leave;
      left.factorisations = &factorisations;
      const bool is_own =
          before > 0.0 ? relay.error() > way.takes_best * way.pace.error() : way.takes_best < 0.1;
      Solved part = solver.solve(problem, is_own ? way.at : std::move(best), left);
      way.spent = work(part.iterations);
      way.at = part.impulses;
      if (!has_left) ++way.stalls;
      if (budget.factorisations)
        *budget.factorisations += way.only_factors ? part.iterations : factorisations;
      return part;
    });
    if (!is_scarce_ && relay.iterations() >= scarce_from_) count_iterations(problem, budget);
  }

  // Tuned on generated piles, random graphs (seeds below 1000) and captured stacks, walls, pyramids
  // and heaps of boxes; tried on others.
  static constexpr double never = 1e300;
  /// Sweeps that are taken to be enough before they have shown their pace.
  static constexpr int few_sweeps = 64;
  /// Of so few every iteration counts from the first.
  static constexpr int few_iterations = 500;
  /// Sweeps that cost as much as a factorisation that is dear.
  static constexpr double dear_step = 120.0;
  /// Changing ways costs: the other's promise must be so much better.
  static constexpr double by_far = 2.5;
  /// How often every way may end without arriving and by itself.
  static constexpr int most_stalls = 12;

  std::array<Way, kinds> ways_;
  double sweep_ = 0.0, step_ = 0.0;  ///< work of one
  double mixed_part_ = 0.0;  ///< mixed sweeps are taken to need, of what plain ones have had
  bool knows_step_ = false;  ///< step_ is from the fill
  bool is_scarce_ = false;
  WorkerTeam* team_ = nullptr;
  int scarce_from_ = 0;  ///< so many iterations of the whole solve
};

}  // namespace

std::unique_ptr<Solver> make_auto() { return std::make_unique<Auto>(); }

}  // namespace ballast
