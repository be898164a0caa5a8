#include "solvers/backends/gauss_seidel.hpp"

#include <utility>

#include "solvers/gauss_seidel/body_sweep.hpp"
#include "solvers/gauss_seidel/delassus_sweep.hpp"
#include "solvers/gauss_seidel/swept_error.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

class GaussSeidel final : public Solver {
 public:
  explicit GaussSeidel(const GaussSeidelSettings& settings)
      : schedule_{settings.first_check, settings.check_growth}, variant_(settings.variant) {
    if (!variant_.plain()) bodies_.use_variants();
  }

  void prepare(const FrictionProblem& problem) override {
    // A stored W is swept along its rows. Otherwise the bodies' velocities carry from contact to
    // contact what an impulse changes, and W is never formed.
    if (problem.has_delassus && !problem.has_dynamics)
      delassus_.prepare(problem);
    else
      bodies_.prepare(problem);
  }

  void use_team(WorkerTeam* team) override { bodies_.use_team(team); }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    return problem.has_delassus && !problem.has_dynamics
               ? iterate(delassus_, problem, std::move(start), budget)
               : iterate(bodies_, problem, std::move(start), budget);
  }

 private:
  template <typename Sweep>
  Solved iterate(Sweep& sweep, const FrictionProblem& problem, Impulses r, const Budget& budget) {
    Iteration iteration(budget, schedule_);
    order_.begin(variant_, variant_.plain() ? 0 : problem.contact_count());
    allow_single(sweep, budget);
    // Stored at once: impulses that move nothing have been dropped.
    sweep.load(problem, r);
    sweep.store(problem, r);
    iteration.evaluated(sweep.error(), r);
    while (iteration.next()) {
      if (variant_.plain())
        sweep.sweep();
      else
        sweep.sweep(variant_, order_.next());
      if (!iteration.error_due()) continue;
      iteration.evaluated(
          swept_error(sweep, problem, iteration, r, [&] { sweep.load(problem, r); }), r);
    }
    return iteration.finish(std::move(r));
  }

  CheckSchedule schedule_;
  SweepVariant variant_;
  ContactOrder order_;
  BodySweep bodies_;
  DelassusSweep delassus_;
};

}  // namespace

std::unique_ptr<Solver> make_gauss_seidel(const GaussSeidelSettings& settings) {
  return std::make_unique<GaussSeidel>(settings);
}

}  // namespace ballast
