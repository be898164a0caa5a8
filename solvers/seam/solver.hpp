#pragma once
// The interface between problems and solvers.

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// Why a solver stopped. It says nothing about accuracy: contact_error() does.
enum class StopReason {
  reached_tolerance,
  iteration_limit,
  time_limit,
  stalled,
  numerical_failure
};

/// The result of a solve: the solver's claim and the judge's finding, or how the solve failed.
enum class Verdict {
  solved,         ///< the solver says so and the judge agrees on every part of the law
  unsolved,       ///< the solver stopped before: stalled, at a limit, or by a failure
  denied,         ///< the solver says that it is solved, and the judge does not agree
  no_solution,    ///< r grows without bound, or it is proved that no impulses are a solution
  timeout,        ///< over the time limit of a comparison, by itself or killed
  crashed,        ///< the process that solved died
  out_of_memory,  ///< allocation refused under the memory limit
  unsupported,    ///< the backend says that it cannot take the problem
  unreadable,     ///< the problem could not be loaded: no backend was tried
};
inline constexpr const char* verdict_names[] = {"solved",        "unsolved",    "denied",
                                                "no_solution",   "timeout",     "crashed",
                                                "out_of_memory", "unsupported", "unreadable"};

/// The law that a backend solves. All backends are judged on Coulomb's law.
enum class ContactLaw { coulomb, convex_relaxation };

const char* name_of(StopReason reason);
const char* name_of(Verdict verdict);
const char* name_of(ContactLaw law);

/// Solvers stop a hair below a tolerance: the judge sums in another order than a backend does.
inline constexpr double stop_margin = 1e-3;

/// Siconos' measure of an answer (ContactError::fclib, by the judge) as a reason to stop, for code
/// that evaluates errors. Its ratio to the natural map changes while impulses grow, so that no
/// tolerance on one of them can replace a tolerance on the other.
class FclibStop {
 public:
  /// `problem` must outlive this object.
  FclibStop(const FrictionProblem& problem, double tolerance)
      : problem_(&problem), tolerance_(tolerance) {}

  double tolerance() const { return tolerance_; }
  /// Returns whether the measure is small enough to stop. After the first few calls it is worth its
  /// cost, and is evaluated, only if `natural_map` (of the same impulses) [m/s] is at most half of
  /// its value at the last evaluation or near the aim. Throws InvalidProblem for a mass block that
  /// is not positive definite.
  bool reached(const Impulses& r, double natural_map);
  /// The natural map at which the measure should be reached [m/s], estimated at the last
  /// evaluation; infinite before the first.
  double aim() const { return aim_; }

 private:
  static constexpr int first_looks = 4;
  static constexpr double near_aim = 3.0;

  const FrictionProblem* problem_;
  double tolerance_, aim_ = std::numeric_limits<double>::infinity();
  double free_norm_ = -1.0;  ///< |q|; negative: not known
  double looked_at_ = std::numeric_limits<double>::infinity();
  int looks_ = 0;
  ContactJudge judge_;
};

/// When to stop. "The error" is the judge's scaled natural map, rms over contacts, in m/s
/// (contact_error.hpp).
struct Budget {
  double tolerance = 1e-8;     ///< [m/s]; 0: run until another limit
  int max_iterations = 10000;  ///< sweeps, Newton steps, ... : the backend's outer unit of work
  double max_seconds = 1e30;   ///< wall clock
  /// Record (iteration, seconds, error) at every evaluation of the error.
  bool keep_history = false;
  /// Not null: solvers also stop on this measure, wherever they evaluate the error. One object
  /// serves one solve.
  FclibStop* fclib = nullptr;
  /// Not empty: an Iteration (seam/iteration.hpp) calls it with the iterations and the error [m/s]
  /// at every evaluation; true ends the solve as stalled. For callers that have a better use for
  /// the rest of the budget. A Course does not call it.
  std::function<bool(int iterations, double error)> gives_up = {};

  /// Not empty: asked together with the clock; true ends the solve as if its time were over.
  std::function<bool()> is_cancelled = {};

  /// The natural map to plan for [m/s]: the tolerance, or the natural map at which `fclib` expects
  /// its measure to be reached.
  double aim() const { return fclib ? fclib->aim() : tolerance; }
  /// The budget left after so many iterations and seconds; never negative.
  Budget after(int iterations, double seconds) const;
};

struct HistoryPoint {
  int iteration;
  double seconds;  ///< since solve() began, without start-up
  double error;    ///< scaled natural map rms [m/s]
};

/// A backend's result. Its own residual is recorded beside the judge's, never used as evidence.
struct Solved {
  Impulses impulses;
  StopReason reason = StopReason::numerical_failure;
  int iterations = 0;
  double own_residual = 0.0;
  /// Scaled natural map (rms) of the start and of `impulses`, as the method evaluated it; NaN: it
  /// did not.
  double start_error = std::numeric_limits<double>::quiet_NaN(), end_error = start_error;
  /// Wall clock of solve() that is not the method's: starting processes for a foreign library,
  /// converting problems to its form, judging its answers.
  double startup_seconds = 0.0;
  std::vector<HistoryPoint> history;

  /// Books both as one: `next` began where this one ended, `seconds` after this one began.
  void go_on(Solved next, double seconds);
};

/// A problem that a backend cannot take; what() names the backend and the reason.
class UnsupportedProblem : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The process that works for a backend was lost; what() says how.
class LostProcess : public std::runtime_error {
 public:
  LostProcess(const std::string& what, bool ran_out_of_time)
      : std::runtime_error(what), is_out_of_time(ran_out_of_time) {}
  const bool is_out_of_time;  ///< killed because it did not answer; false: it died
};

/// A frictional-contact solver. One object serves a sequence of problems; buffers are kept between
/// them.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Allocation, ordering, symbolic and numeric factorisation: timed separately from solve().
  /// Throws UnsupportedProblem.
  virtual void prepare(const FrictionProblem& problem) = 0;
  /// Sets the team that prepare() and solve() may use; null: the caller alone. Results have the
  /// same bits whatever its size. A backend that has no use for more than one thread ignores it.
  virtual void use_team(WorkerTeam* /*team*/) {}
  /// `start` is the first iterate (zero: cold start). Its storage comes back as Solved::impulses,
  /// so that a run of many steps does not allocate. `problem` is the one given to prepare().
  virtual Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) = 0;
};

/// A solver that another one may not need: prepared at its first use, as ordering is expensive.
struct LazySolver {
  std::unique_ptr<Solver> solver;
  bool is_prepared = false;

  Solver& prepared(const FrictionProblem& problem) {
    if (!is_prepared) solver->prepare(problem);
    is_prepared = true;
    return *solver;
  }
};

/// Makes one backend with the settings of its row in the list.
using SolverMaker = std::unique_ptr<Solver> (*)();

}  // namespace ballast
