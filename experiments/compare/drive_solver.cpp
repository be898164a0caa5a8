#include "experiments/compare/drive_solver.hpp"

#include <algorithm>
#include <utility>

#include "solvers/seam/relay.hpp"

namespace ballast {
namespace {

/// The natural map falls by at most this a round: how it compares with `fclib` changes on the way
/// down, and where impulses are large in the file's units a natural map far too small would be
/// asked for at once.
constexpr double largest_fall = 1e-3;
/// Aims a little below the tolerance, because the two measures are not quite proportional.
constexpr double aim = 0.7;
constexpr int most_rounds = 60;

/// One solver on its way to a tolerance. solvers/seam/relay.hpp goes on from the best iterate and
/// its clock runs on while iterates are judged; here each round goes on from the last one's
/// impulses, and only prepare() and solve() are timed.
class Drive {
 public:
  Drive(Solver& solver, const FrictionProblem& problem, const DriveSettings& settings)
      : solver_(solver), problem_(problem), settings_(settings) {}

  DrivenSolve to_natural_map(Impulses start) {
    round(std::move(start), settings_.tolerance * settings_.velocity_scale);
    driven_.claimed = driven_.last.solved.reason == StopReason::reached_tolerance;
    return std::move(driven_);
  }

  DrivenSolve to_fclib(Impulses start) {
    if (start.size() == 0) start.setZero(problem_.row_count());
    ContactError error = contact_error(problem_, start);
    double target = error.natural_map_rms;
    do {
      target = next_target(error, target);
      round(std::move(start), target);
      error = driven_.last.error;
      driven_.claimed = error.finite && error.fclib <= settings_.tolerance;
      start = driven_.last.solved.impulses;
    } while (!driven_.claimed && driven_.last.solved.reason == StopReason::reached_tolerance &&
             target > 0.0 && driven_.rounds < most_rounds &&
             driven_.seconds() < settings_.max_seconds);
    return std::move(driven_);
  }

 private:
  /// Where `fclib` should be below its tolerance, were the two measures proportional.
  double next_target(const ContactError& error, double last) const {
    const double proportional =
        error.fclib > 0.0 ? aim * error.natural_map_rms * settings_.tolerance / error.fclib : 0.0;
    return std::min(0.5 * last, std::max(proportional, largest_fall * error.natural_map_rms));
  }

  void round(Impulses start, double tolerance) {
    const Budget whole{tolerance, settings_.max_iterations, settings_.max_seconds, true};
    const Budget left = rest_of(whole, 0, driven_.seconds());  // iterations are of each round
    SolverRun run = driven_.rounds == 0
                        ? runner_.run(solver_, problem_, std::move(start), left)
                        : runner_.run_again(solver_, problem_, std::move(start), left);
    for (const HistoryPoint& point : run.solved.history)
      driven_.history.push_back({driven_.rounds, driven_.iterations + point.iteration,
                                 driven_.solve_seconds + point.seconds,
                                 point.error / settings_.velocity_scale});
    ++driven_.rounds;
    driven_.iterations += run.solved.iterations;
    driven_.prepare_seconds += run.prepare_seconds;
    driven_.solve_seconds += run.solve_seconds;
    driven_.last = std::move(run);
  }

  Solver& solver_;
  const FrictionProblem& problem_;
  const DriveSettings& settings_;
  SolverRunner runner_;
  DrivenSolve driven_;
};

}  // namespace

DrivenSolve drive_solver(Solver& solver, const FrictionProblem& problem, const Impulses& start,
                         const DriveSettings& settings) {
  Drive drive(solver, problem, settings);
  return settings.measure == Measure::fclib ? drive.to_fclib(start) : drive.to_natural_map(start);
}

}  // namespace ballast
