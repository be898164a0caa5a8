#include "solvers/backends/auto.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/backends/anderson_pgs.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/backends/interior_point.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/backends/nncg.hpp"
#include "solvers/seam/relay.hpp"

namespace ballast {
namespace {

// What sweeps and factorisations cost [s], for the choice between them: a model in sizes, and no
// clock, so that the same problem takes the same turns and gives the same bits on every machine.
// The numbers are rounded times of one thread of the machine on which this backend was written; no
// record says which machine that was. `ballast bench kernels` measures the like on another. Only
// their ratios matter.

/// A sweep over bodies, per contact.
constexpr double body_visit = 3e-8;
/// A sweep over a stored W, per entry and per contact.
constexpr double matrix_entry = 1e-9, matrix_visit = 2e-8;
/// A factorisation in the bodies' unknowns: of a packing of 1200 grains, and how that grows.
constexpr double packing_factor = 5e-2, packing_unknowns = 7200.0, factor_growth = 1.5;
/// A factorisation of a stored W, per square of its rows and per row.
constexpr double matrix_row_square = 1.5e-9, matrix_row = 2e-7;

class Auto final : public Solver {
 public:
  Auto()
      : matrix_opening_(make_anderson_pgs({})),
        matrix_sweeps_(make_gauss_seidel({})),
        body_sweeps_(make_nncg()),
        newton_(make_proximal_newton({.start_sweeps = 0})) {}

  void prepare(const FrictionProblem& problem) override {
    sweeps_ = problem.has_dynamics ? body_sweeps_.get() : matrix_sweeps_.get();
    opening_ = problem.has_dynamics ? body_sweeps_.get() : matrix_opening_.get();
    // Newton is prepared only when its turn comes: ordering costs as much as many sweeps.
    opening_->prepare(problem);
    if (opening_ != sweeps_) sweeps_->prepare(problem);
    newton_is_prepared_ = false;
    const double rows = problem.row_count();
    if (problem.has_dynamics) {
      sweep_cost_ = body_visit * problem.contact_count();
      factor_cost_ =
          packing_factor * std::pow(problem.dynamics.dof_count() / packing_unknowns, factor_growth);
    } else {
      sweep_cost_ =
          matrix_entry * problem.delassus.w.nonZeros() + matrix_visit * problem.contact_count();
      factor_cost_ = matrix_row_square * rows * rows + matrix_row * rows;
    }
  }

  void use_threads(int threads) override {
    matrix_sweeps_->use_threads(threads);
    body_sweeps_->use_threads(threads);
    newton_->use_threads(threads);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Relay relay(budget, std::move(start));
    sweep_while_it_pays(relay, problem, budget);
    double before = relay.error();
    int standing_still = 0;
    for (int steps = 40; !relay.over() && standing_still < patience; steps += steps / 2) {
      if (!newton_is_prepared_) newton_->prepare(problem);
      newton_is_prepared_ = true;
      // Newton's turn, and how fast the error fell in it.
      const int begin = relay.iterations();
      const double error = relay.error();
      relay.run(*newton_, problem, steps);
      if (relay.over()) break;
      // What misleads Newton is often local, and sweeps mend it. They get twice Newton's time where
      // they are the faster of the two.
      const double newton_cost = (relay.iterations() - begin) * factor_cost_;
      const double newton_rate = std::log(error / relay.error()) / newton_cost;
      const double share = newton_rate < sweep_rate_ ? 2.0 : 0.2;
      sweep(*sweeps_, relay, problem,
            std::clamp(static_cast<int>(share * newton_cost / sweep_cost_), 50, 20000));
      standing_still = relay.error() < 0.5 * before ? 0 : standing_still + 1;
      if (standing_still == from_elsewhere) {
        const std::unique_ptr<Solver> interior_point = make_interior_point();
        interior_point->prepare(problem);
        relay.run(*interior_point, problem, 2000);
      }
      before = relay.error();
    }
    return relay.finish();
  }

 private:
  /// A round of sweeps, and what it brought: ln of the error per second of the model.
  void sweep(Solver& solver, Relay& relay, const FrictionProblem& problem, int count) {
    const double before = relay.error();
    relay.run(solver, problem, count);
    sweep_rate_ = std::log(before / relay.error()) / (count * sweep_cost_);
  }

  /// Doubling rounds of sweeps, until the rate of the last one promises less than Newton costs:
  /// 20-60 factorisations on stored problems of up to 500 contacts, about a hundred on packings of
  /// 5000.
  void sweep_while_it_pays(Relay& relay, const FrictionProblem& problem, const Budget& budget) {
    relay.run(*opening_, problem, 8);
    for (int round = 8; !relay.over(); round *= 2) {
      sweep(*opening_, relay, problem, round);
      const double tolerance = budget.aim();
      const double needed = tolerance > 0.0 && sweep_rate_ > 0.0
                                ? std::log(relay.error() / tolerance) / sweep_rate_
                                : 1e300;
      const bool far_away = needed > (20.0 + 0.02 * problem.contact_count()) * factor_cost_;
      const bool fair_share = relay.iterations() * sweep_cost_ > fair_factorisations * factor_cost_;
      if (far_away && fair_share) return;
    }
  }

  /// Rounds of Newton and sweeps without halving the error.
  static constexpr int patience = 60;
  /// After so many of them, an interior point looks for another place to begin.
  static constexpr int from_elsewhere = 4;
  /// Sweeps first, for as long as this many factorisations take.
  static constexpr double fair_factorisations = 2.0;

  std::unique_ptr<Solver> matrix_opening_, matrix_sweeps_, body_sweeps_, newton_;
  Solver* opening_ = nullptr;  ///< the first sweeps: accelerated
  /// Those between Newton's: acceleration has shown by then that it does not help.
  Solver* sweeps_ = nullptr;
  bool newton_is_prepared_ = false;
  double sweep_cost_ = 0.0, factor_cost_ = 0.0;  ///< model [s]
  double sweep_rate_ = 0.0;                      ///< of the last round [1/s]
};

}  // namespace

std::unique_ptr<Solver> make_auto() { return std::make_unique<Auto>(); }

}  // namespace ballast
