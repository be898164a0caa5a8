#include "solvers/backends/gauss_seidel.hpp"

#include <utility>

#include "solvers/gauss_seidel/any_sweep.hpp"

namespace ballast {
namespace {

class GaussSeidel final : public Solver {
 public:
  explicit GaussSeidel(const GaussSeidelSettings& settings)
      : schedule_{settings.first_check, settings.check_growth}, variant_(settings.variant) {
    if (!variant_.plain()) sweep_.use_variants();
  }

  void prepare(const FrictionProblem& problem) override { sweep_.prepare(problem); }
  void use_team(WorkerTeam* team) override { sweep_.use_team(team); }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, schedule_);
    order_.begin(variant_, variant_.plain() ? 0 : problem.contact_count());
    allow_single(*sweep_, budget);
    const auto load = [&] { sweep_->load(problem, r); };
    load();
    sweep_->store(problem, r);  // impulses that move nothing have been dropped
    iteration.evaluated(sweep_->error(), r);
    while (iteration.next()) {
      if (variant_.plain())
        sweep_->sweep();
      else
        sweep_->sweep_by(variant_, order_.next());
      if (iteration.error_due())
        iteration.evaluated(swept_error(*sweep_, problem, iteration, r, load), r);
    }
    return iteration.finish(std::move(r));
  }

 private:
  CheckSchedule schedule_;
  SweepVariant variant_;
  ContactOrder order_;
  AnySweep sweep_;
};

}  // namespace

std::unique_ptr<Solver> make_gauss_seidel(const GaussSeidelSettings& settings) {
  return std::make_unique<GaussSeidel>(settings);
}

}  // namespace ballast
