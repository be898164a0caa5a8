#include "experiments/step/impact_law.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ballast {
namespace {

/// Adds the cost of an earlier solve of the same step to that of the last one.
void book(const SolverRun& earlier, SolverRun& run) {
  run.solved.iterations += earlier.solved.iterations;
  run.prepare_seconds += earlier.prepare_seconds;
  run.startup_seconds += earlier.startup_seconds;
  run.solve_seconds += earlier.solve_seconds;
}

}  // namespace

void ImpactLaw::set_bias(FrictionProblem& problem, std::span<const double> rebound) const {
  problem.dynamics.bias = newton_;
  for (size_t i = 0; i < islands_.size(); ++i) {
    if (e_factor_[i] == 1.0) continue;
    for (const int c : islands_[i]) {
      const int row = problem.row_begin[c];
      problem.dynamics.bias[row] = walls_[row] + e_factor_[i] * rebound[c];
    }
  }
}

/// Stores the impulses, error and contact velocities of a solve. `v`: the bodies' velocities that
/// the judge found. Afterwards the bias holds only the walls' part.
void ImpactLaw::measure(FrictionProblem& problem, const SolverRun& run, const Eigen::VectorXd& v,
                        Impact& impact) const {
  impact.r = run.solved.impulses;
  impact.error = run.error.natural_map_rms;
  problem.dynamics.bias = walls_;
  body_to_contact_velocity(problem.dynamics, problem.row_begin, v, impact.u);
}

/// The factor, at most `most`, by which the island's e must be multiplied; 1 where the island takes
/// enough energy.
double ImpactLaw::lowering_factor(const FrictionProblem& problem, size_t island,
                                  double most) const {
  // L_0 and L; and along r_0 + t (r - r_0), L(t) = L_0 - slope t - curvature t^2 / 2.
  double inelastic = 0.0, rebounding = 0.0, slope = 0.0, curvature = 0.0, impulse = 0.0;
  int rows = 0;
  // With delta = r - r_0 and W symmetric, r_0 . W delta = delta . (u_0 - u_free). Therefore the
  // slope needs only delta . u_0, and the curvature only delta . (u - u_0).
  for (const int c : islands_[island])
    for (int row = problem.row_begin[c]; row < problem.row_begin[c + 1]; ++row) {
      const double r0 = inelastic_.r[row], r1 = rebounding_.r[row];
      const double u0 = inelastic_.u[row], u1 = rebounding_.u[row];
      inelastic -= 0.5 * r0 * (u0 + u_free_[row]);
      rebounding -= 0.5 * r1 * (u1 + u_free_[row]);
      slope += (r1 - r0) * u0;
      curvature += (r1 - r0) * (u1 - u0);
      impulse += r1 * r1 + r0 * r0;
      ++rows;
    }
  // The energies are uncertain by the solves' errors times the impulses.
  const double error = inelastic_.error + rebounding_.error;
  const double known_to = 1e-9 * std::abs(inelastic) + error * std::sqrt(impulse * rows);
  const double e2 = e_[island] * e_[island];
  if (rebounding >= (1.0 - e2) * inelastic - known_to) return 1.0;
  if (!(curvature > 0.0) || !(inelastic > 0.0)) return 0.0;
  // The positive root of L(t) = (1 - e^2) L_0, that is of slope t + curvature t^2 / 2 = e^2 L_0.
  const double root = std::sqrt(slope * slope + 2.0 * curvature * e2 * inelastic);
  return std::clamp((root - slope) / curvature, 0.0, most);
}

/// Lowers e where an island gives back too much. True: some e fell, so another solve is needed.
bool ImpactLaw::lower_restitution(const FrictionProblem& problem, int times, bool to_zero) {
  // The root is exact while no contact opens or slides. The effect of forces of order h needs only
  // a factor of 1 - O(h). Where that was not enough, e falls by a twentieth at least.
  const double most = times == 1 ? 1.0 - 1e-6 : 0.95;
  bool fell = false;
  for (size_t i = 0; i < islands_.size(); ++i) {
    if (e_factor_[i] == 0.0) continue;
    const double factor = lowering_factor(problem, i, most);
    if (factor == 1.0) continue;
    e_factor_[i] *= to_zero ? 0.0 : factor;
    least_ = std::min(least_, e_factor_[i] * e_[i]);
    fell = true;
  }
  return fell;
}

SolverRun ImpactLaw::solve(SolverRunner& runner, Solver& solver, FrictionProblem& problem,
                           std::span<const double> rebound, std::span<const double> restitution,
                           Impulses start, const Budget& budget) {
  constexpr int most_lowerings = 5;
  least_ = highest_;
  if (std::none_of(rebound.begin(), rebound.end(), [](double x) { return x < 0.0; }))
    return runner.run(solver, problem, std::move(start), budget);
  // The bias holds the walls' motion and Newton's e u_N-. They are separated because the latter is
  // scaled island by island.
  newton_ = walls_ = problem.dynamics.bias;
  for (int c = 0; c < problem.contact_count(); ++c) walls_[problem.row_begin[c]] -= rebound[c];
  islands_ = contact_islands(problem);
  e_factor_.assign(islands_.size(), 1.0);
  e_.assign(islands_.size(), 0.0);
  for (size_t i = 0; i < islands_.size(); ++i)
    for (const int c : islands_[i]) e_[i] = std::max(e_[i], restitution[c]);

  // The inelastic impact gives L_0, the energy that it takes.
  problem.dynamics.bias = walls_;
  SolverRun earlier = runner.run(solver, problem, start, budget);
  measure(problem, earlier, runner.body_velocity(), inelastic_);
  body_to_contact_velocity(problem.dynamics, problem.row_begin, problem.dynamics.v_free, u_free_);
  // Newton's law, solved again with a lower e where an island gives back too much.
  set_bias(problem, rebound);
  SolverRun run = runner.run(solver, problem, std::move(start), budget);
  book(earlier, run);
  for (int k = 1; k <= most_lowerings; ++k) {
    measure(problem, run, runner.body_velocity(), rebounding_);
    const bool fell = lower_restitution(problem, k, k == most_lowerings);
    set_bias(problem, rebound);
    if (!fell) break;
    earlier = std::move(run);
    run = runner.run(solver, problem, earlier.solved.impulses, budget);
    book(earlier, run);
  }
  return run;
}

}  // namespace ballast
