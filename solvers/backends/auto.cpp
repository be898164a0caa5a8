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
/// unknown.
constexpr double newton_contact = 1500.0, body_unknown = 6000.0;
/// The same of a stored W (newton_matrix.hpp): dense where rows are few or W is nearly full. A
/// sparse factorisation is mostly bookkeeping, row by row.
constexpr double few_rows = 200.0, nearly_full = 0.1;
constexpr double dense_entry = 15.0, dense_cube = 0.05, sparse_row = 8000.0;

/// How fast a leg has come down: what it shows by itself.
class Pace {
 public:
  void begin() { points_.clear(); }
  void add(int iteration, double error) {
    if (!points_.empty()) error = std::min(error, points_.back().error);
    points_.push_back({iteration, error});
  }
  int iterations() const { return points_.empty() ? 0 : points_.back().iteration; }
  double error() const { return points_.back().error; }
  /// ln of the error per iteration, over the later half of the iterations; 0: it stands still.
  double rate() const {
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

class Auto final : public Solver {
 public:
  Auto()
      : anderson_(make_anderson_pgs({})),
        conjugate_(make_nncg()),
        newton_(make_proximal_newton({.start_sweeps = 0})) {}

  void prepare(const FrictionProblem& problem) override {
    // Over bodies Anderson's mixing costs more than a sweep; so it does for a handful of contacts.
    const bool is_conjugate = problem.has_dynamics || problem.contact_count() <= handful;
    turns_ = {{{(is_conjugate ? conjugate_ : anderson_).get(), false},
               {(is_conjugate ? anderson_ : conjugate_).get(), false},
               {newton_.get(), false}}};
    prepared(0, problem);
    count_work(problem);
  }

  void use_threads(int threads) override {
    conjugate_->use_threads(threads);
    newton_->use_threads(threads);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Relay relay(budget, std::move(start));
    sweep_while_it_pays(relay, problem, budget);
    take_turns(relay, problem, budget);
    return relay.finish();
  }

 private:
  /// Prepared when its turn comes: ordering costs as much as many sweeps.
  Solver& prepared(size_t turn, const FrictionProblem& problem) {
    if (!turns_[turn].is_prepared) turns_[turn].solver->prepare(problem);
    turns_[turn].is_prepared = true;
    return *turns_[turn].solver;
  }

  /// What a sweep and a Newton step cost: of a factorisation, as many operations as of one whose
  /// bandwidth is the mean filled row's.
  void count_work(const FrictionProblem& problem) {
    const double contacts = problem.contact_count();
    if (problem.has_dynamics) {
      sweep_work_ = body_visit * contacts;
      newton_work_ = body_unknown * problem.dynamics.dof_count() + newton_contact * contacts;
    } else {
      const double rows = problem.row_count();
      const double entries = static_cast<double>(problem.delassus.w.nonZeros());
      sweep_work_ = matrix_entry * entries + matrix_visit * contacts;
      const bool is_dense = rows <= few_rows || entries > nearly_full * rows * rows;
      const double dense = dense_entry * entries + dense_cube * rows * rows * rows;
      const double sparse = sparse_row * rows;
      newton_work_ = newton_contact * contacts + (is_dense ? std::min(dense, sparse) : sparse);
    }
  }

  /// One leg of `solver`, which it leaves when `enough(pace)` says so.
  void leg(Solver& solver, Relay& relay, const FrictionProblem& problem, int most, Pace& pace,
           const std::function<bool()>& enough) {
    pace.begin();
    const std::function<bool(int, double)> leave = [&](int iteration, double error) {
      pace.add(iteration, error);
      return enough();
    };
    relay.run([&](Impulses start, Budget left) {
      left.max_iterations = std::min(most, left.max_iterations);
      left.leave = &leave;
      return solver.solve(problem, std::move(start), left);
    });
  }

  /// Sweeps of both kinds, each until what they promise to need still is more than Newton would,
  /// and they have had a fair share.
  void sweep_while_it_pays(Relay& relay, const FrictionProblem& problem, const Budget& budget) {
    const double newton_steps =
        expected_steps + expected_steps_per_contact * problem.contact_count();
    // What one kind of acceleration cannot do the other may.
    for (size_t kind = 0; kind < 2 && !relay.over(); ++kind)
      leg(prepared(kind, problem), relay, problem, 1 << 30, sweep_pace_, [&] {
        const double spent = sweep_pace_.iterations() * sweep_work_;
        if (sweep_pace_.iterations() < least_sweeps || spent < fair_steps * newton_work_)
          return false;
        return sweep_pace_.left(budget.aim()) * sweep_work_ > newton_steps * newton_work_;
      });
  }

  void take_turns(Relay& relay, const FrictionProblem& problem, const Budget& budget) {
    double before = relay.error();
    int standing_still = 0;
    size_t kind = 0;
    for (int steps = 40; !relay.over() && standing_still < patience; steps += steps / 2) {
      const int begin = relay.iterations();
      double halved = relay.error();
      int halved_at = 0;
      leg(prepared(2, problem), relay, problem, steps, newton_pace_, [&] {
        if (newton_pace_.error() < 0.5 * halved) {
          halved = newton_pace_.error();
          halved_at = newton_pace_.iterations();
        }
        return newton_pace_.iterations() - halved_at > newton_patience;
      });
      if (relay.over()) break;
      // What misleads Newton is often local, and sweeps mend it. They go on for as long as Newton
      // took, or while they are on their way.
      const double spent = (relay.iterations() - begin) * newton_work_;
      const int least = static_cast<int>(std::clamp(spent / sweep_work_, 50.0, 1e8));
      kind = 1 - kind;
      leg(prepared(kind, problem), relay, problem, 1 << 30, sweep_pace_, [&] {
        if (sweep_pace_.iterations() < least) return false;
        return sweep_pace_.left(budget.aim()) * sweep_work_ > spent;
      });
      if (relay.over()) break;
      standing_still = relay.error() < 0.5 * before ? 0 : standing_still + 1;
      if (standing_still == from_elsewhere) {
        const std::unique_ptr<Solver> interior_point = make_interior_point();
        interior_point->prepare(problem);
        relay.run(*interior_point, problem, most_from_elsewhere);
      }
      before = relay.error();
    }
  }

  /// Tuned on generated piles (pile:family, seeds 1 to 100), tried on others.
  /// Contacts up to which mixing costs more than it saves.
  static constexpr int handful = 4;
  /// Before so many sweeps nothing is said about their pace; and they get the time of so many
  /// Newton steps in any case.
  static constexpr int least_sweeps = 100;
  static constexpr double fair_steps = 3.0;
  /// What Newton is expected to need.
  static constexpr double expected_steps = 10.0, expected_steps_per_contact = 0.05;
  /// Newton steps without halving the error, after which sweeps have their turn.
  static constexpr int newton_patience = 15;
  /// Rounds of Newton and sweeps without halving the error.
  static constexpr int patience = 60;
  /// After so many of them, an interior point looks for another place to begin.
  static constexpr int from_elsewhere = 8, most_from_elsewhere = 300;

  struct Turn {
    Solver* solver;
    bool is_prepared;
  };
  std::unique_ptr<Solver> anderson_, conjugate_, newton_;
  /// The sweeps that begin, those of the other kind, Newton.
  std::array<Turn, 3> turns_{};
  double sweep_work_ = 0.0, newton_work_ = 0.0;
  Pace sweep_pace_, newton_pace_;
};

}  // namespace

std::unique_ptr<Solver> make_auto() { return std::make_unique<Auto>(); }

}  // namespace ballast
