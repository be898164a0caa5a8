#include "solvers/parts/local_change.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "platform/clock.hpp"
#include "solvers/parts/one_contact.hpp"

namespace ballast {

bool ChangeNorms::within(double tolerance) const {
  constexpr double largest = 16.666;  // LMGC90's factor
  return velocity_mean < tolerance && energy_mean < tolerance && std::abs(drift) < tolerance &&
         velocity_max < largest * tolerance && energy_max < largest * tolerance;
}

ChangeNorms local_change(ContactOperator& contacts, const Impulses& r) {
  Eigen::VectorXd u;
  contacts.velocity(r, u);
  double carrying = 0.0, d_squares = 0.0, w_squares = 0.0, energies = 0.0, dm_squares = 0.0,
         drift = 0.0, largest_d = 0.0, largest_dm = 0.0;
  for (int c = 0; c < contacts.contact_count(); ++c) {
    if (!(contacts.rho()[c] > 0.0)) continue;  // no impulse moves it
    const Eigen::Matrix3d& w = contacts.diagonal()[c];
    const Eigen::Vector3d before = contacts.at(r, c), free = contacts.at(u, c) - w * before;
    Eigen::Vector3d after;
    double slip = 0.0;
    solve_one_contact(w, free, contacts.friction(c), after, slip);
    const Eigen::Vector3d d = w * (before - after), m = 0.5 * (before + after);
    if (m.isZero(0.0)) continue;
    const Eigen::Vector3d wr = w * before, wr_after = w * after;
    carrying += 1.0;
    d_squares += d.squaredNorm();
    w_squares += 0.5 * (wr.squaredNorm() + wr_after.squaredNorm());
    energies += 0.5 * (wr.dot(before) + wr_after.dot(after));
    dm_squares += d.squaredNorm() * m.squaredNorm();
    drift += m.dot(d);
    largest_d = std::max(largest_d, d.norm());
    largest_dm = std::max(largest_dm, d.norm() * m.norm());
  }
  if (!(w_squares > 0.0 && energies > 0.0)) return {};
  const double velocity = std::sqrt(w_squares / carrying), energy = energies / carrying;
  return {std::sqrt(d_squares / carrying) / velocity, largest_d / velocity,
          std::sqrt(dm_squares / carrying) / energy, largest_dm / energy, drift / energies};
}

namespace {

class ChangeStopped final : public Solver {
 public:
  ChangeStopped(std::unique_ptr<Solver> backend, const ChangeRule& rule)
      : backend_(std::move(backend)), rule_(rule) {}

  void prepare(const FrictionProblem& problem) override {
    backend_->prepare(problem);
    contacts_.prepare(problem);
  }

  void use_team(WorkerTeam* team) override { backend_->use_team(team); }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    const Stopwatch watch;
    Solved whole;
    whole.impulses = std::move(start);
    for (;;) {
      const double begun = watch.seconds() - whole.startup_seconds;
      Budget burst = budget.after(whole.iterations, begun);
      burst.tolerance = 0.0;
      burst.max_iterations = std::min(burst.max_iterations, rule_.every);
      const int asked = whole.iterations + burst.max_iterations;
      whole.go_on(backend_->solve(problem, std::move(whole.impulses), burst), begun);
      // Ends if the backend stopped early or failed, the rule is met, or no iterations are left.
      if (whole.iterations < asked || whole.impulses.size() != problem.row_count()) return whole;
      if (local_change(contacts_, whole.impulses).within(rule_.tolerance)) {
        whole.reason = StopReason::stalled;
        return whole;
      }
      if (whole.iterations >= budget.max_iterations) return whole;
    }
  }

 private:
  std::unique_ptr<Solver> backend_;
  ChangeRule rule_;
  ContactOperator contacts_;
};

}  // namespace

std::unique_ptr<Solver> make_change_stopped(std::unique_ptr<Solver> backend,
                                            const ChangeRule& rule) {
  return std::make_unique<ChangeStopped>(std::move(backend), rule);
}

}  // namespace ballast
