#include "experiments/compare/solve_child.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "platform/child_process.hpp"
#include "platform/clock.hpp"
#include "platform/pack.hpp"
#include "problems/algebra/contact_error.hpp"

namespace ballast {
namespace {

/// What a child sends.
struct ChildMessage : SolveAccount {
  bool is_driven = false;  ///< the solver came to an end: `reason` and `impulses` are its own
  Verdict verdict = Verdict::unsolved;  ///< where it did not
  StopReason reason = StopReason::numerical_failure;
  Impulses impulses;

  /// Packs and unpacks: the carrier decides.
  template <typename Carrier>
  void carry(Carrier& c) {
    c.number(is_driven);
    c.number(verdict);
    c.text(note);
    c.number(reason);
    c.number(iterations);
    c.number(runs);
    c.number(own_residual);
    c.number(prepare_seconds);
    c.number(solve_seconds);
    c.number(startup_seconds);
    c.number(first_seconds);
    c.number(peak_memory_MB);
    c.list(history, [&](auto& point) {
      c.number(point.iteration);
      c.number(point.seconds);
      c.number(point.error);
    });
    c.list(impulses);
  }
};

void limit_memory(double memory_MB) {
  if (!(memory_MB > 0.0)) return;
  const rlimit limit{static_cast<rlim_t>(memory_MB * 1048576.0),
                     static_cast<rlim_t>(memory_MB * 1048576.0)};
  setrlimit(RLIMIT_AS, &limit);
}

/// Of this process or of the largest one that it waited for [MB].
double peak_memory() {
  double peak = 0.0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    peak = std::max(peak, static_cast<double>(usage.ru_maxrss) / 1024.0);
  }
  return peak;
}

void take_result(DrivenSolve&& driven, ChildMessage& message) {
  const std::string& failure = driven.run.failure;
  message.is_driven = failure.empty();
  if (failure == std::bad_alloc().what()) message.verdict = Verdict::out_of_memory;
  message.note = failure;
  message.reason = driven.run.solved.reason;
  message.iterations = driven.run.solved.iterations;
  message.own_residual = driven.run.solved.own_residual;
  message.prepare_seconds = driven.run.prepare_seconds;
  message.solve_seconds = driven.run.solve_seconds;
  message.history = std::move(driven.history);
  message.impulses = std::move(driven.run.solved.impulses);
}

/// The whole of what the child does. A new solver for each run: nothing is carried over but caches.
void drive_repeatedly(const MakeSolver& make, const LoadedCase& loaded, const DriveSettings& drive,
                      const ChildLimits& limits, StartKind start, ChildMessage& message) {
  const Impulses from = start == StartKind::warm ? loaded.warm_start : Impulses();
  double spent = 0.0, fastest = 0.0;
  do {
    const Stopwatch watch;
    const std::unique_ptr<Solver> solver = make();
    const double making = watch.seconds();
    DrivenSolve driven = drive_solver(*solver, loaded.problem, from, drive);
    const double seconds = driven.seconds();
    // What is loaded and started once is seen in the first run alone.
    if (message.runs == 0) {
      message.first_seconds = seconds;
      message.startup_seconds = making + driven.run.startup_seconds;
    }
    if (message.runs == 0 || seconds < fastest) {
      fastest = seconds;
      take_result(std::move(driven), message);
    }
    ++message.runs;
    spent += watch.seconds();
  } while (message.reason == StopReason::reached_tolerance && message.runs < limits.most_runs &&
           spent + fastest < limits.warm_seconds);
}

ChildMessage solve_here(const MakeSolver& make, const LoadedCase& loaded,
                        const DriveSettings& drive, const ChildLimits& limits, StartKind start) {
  ChildMessage message;
  try {
    drive_repeatedly(make, loaded, drive, limits, start, message);
  } catch (const UnsupportedProblem& error) {
    message.verdict = Verdict::unsupported;
    message.note = error.what();
  } catch (const LostProcess& error) {
    message.verdict = error.is_out_of_time ? Verdict::timeout : Verdict::crashed;
    message.note = error.what();
  } catch (const std::bad_alloc&) {
    message.verdict = Verdict::out_of_memory;
  } catch (const std::exception& error) {
    message.note = error.what();
  }
  return message;
}

/// What is asked of the solver, the row's share included.
DriveSettings settings_of(const CompareRow& row, const LoadedCase& loaded, DriveSettings drive) {
  drive.measure = row.measure;
  drive.tolerance = row.tolerance;
  drive.velocity_scale = loaded.facts.velocity_scale;
  return drive;
}

/// The judge's measures of the row, and what they and the backend's word come to. Returns why it is
/// not solved, where that is the judge's to say.
std::string judge(const LoadedCase& loaded, const ChildMessage& message, CompareRow& row) {
  row.verdict = message.verdict;
  if (message.impulses.size() != loaded.problem.row_count()) return {};
  SolverRun run;
  run.solved.impulses = message.impulses;
  run.solved.reason = message.reason;
  run.error = contact_error(loaded.problem, message.impulses);
  const ContactError& error = run.error;
  row.natural_map_rms = error.natural_map_rms;
  row.natural_map_max = error.natural_map_max;
  row.fclib = error.fclib;
  row.cone_violation = error.cone_violation;
  row.min_normal_velocity = error.min_normal_velocity;
  row.worst_contact = error.worst_contact;
  row.worst = loaded.describe_contact(error.worst_contact);
  row.distance =
      answer_distance(loaded.problem, message.impulses, loaded.exact, loaded.facts.velocity_scale);
  const bool by_fclib = row.measure == Measure::fclib;
  row.error = by_fclib ? error.fclib : error.natural_map_rms / loaded.facts.velocity_scale;
  if (!message.is_driven) return {};
  const double tolerance = row.tolerance * loaded.facts.velocity_scale;
  run.verdict = by_fclib ? fclib_verdict_of(message.reason, error, row.tolerance)
                         : verdict_of(message.reason, error, tolerance);
  const std::string words = explained(loaded.problem, run, tolerance);
  row.verdict = run.verdict;
  if (row.verdict == Verdict::no_solution) return words;
  // What the natural map misses is no reason where another measure was asked for.
  return row.verdict == Verdict::denied && !by_fclib ? words : "";
}

void clear_measures(CompareRow& row) {
  row.error = row.natural_map_rms = row.natural_map_max = row.fclib = std::nan("");
}

/// What the solver's process said, and what the judge says to that.
void take_message(const ChildMessage& message, const LoadedCase& loaded, double max_seconds,
                  CompareRow& row) {
  static_cast<SolveAccount&>(row) = message;
  row.reason = message.is_driven ? name_of(message.reason) : "";
  const std::string why = judge(loaded, message, row);
  if (row.note.empty()) row.note = why;
  const bool is_late = row.seconds() > max_seconds && row.verdict == Verdict::solved;
  const bool is_stopped = message.is_driven && row.verdict == Verdict::unsolved &&
                          (row.seconds() > max_seconds || message.reason == StopReason::time_limit);
  if (is_late || is_stopped) row.verdict = Verdict::timeout;
}

}  // namespace

void solve_in_child(const MakeSolver& make, const LoadedCase& loaded, const DriveSettings& settings,
                    const ChildLimits& limits, CompareRow& row) {
  const DriveSettings drive = settings_of(row, loaded, settings);
  // Backends look at the clock between iterations, prepare() never does: some grace before the
  // child is killed.
  const double most_seconds = 1.25 * drive.max_seconds + 2.0 + 2.0 * limits.warm_seconds;
  const ChildResult child = run_in_child(most_seconds, [&] {
    limit_memory(limits.memory_MB);
    ChildMessage message = solve_here(make, loaded, drive, limits, row.start);
    message.peak_memory_MB = peak_memory();
    Packer packer;
    message.carry(packer);
    return packer.bytes();
  });
  clear_measures(row);
  if (child.end != ChildEnd::complete) {
    row.verdict = child.end == ChildEnd::out_of_time ? Verdict::timeout : Verdict::crashed;
    row.note = child.end == ChildEnd::out_of_time ? "killed: did not stop at the time limit"
                                                  : "the child process died";
    row.solve_seconds = child.end == ChildEnd::out_of_time ? most_seconds : 0.0;
    return;
  }
  ChildMessage message;
  Unpacker unpacker(child.answer, "ballast compare: a child's answer");
  message.carry(unpacker);
  unpacker.finish();
  take_message(message, loaded, drive.max_seconds, row);
}

void solve_outside(const MakeSolver& make, const LoadedCase& loaded, const DriveSettings& settings,
                   const ChildLimits& limits, CompareRow& row) {
  const DriveSettings drive = settings_of(row, loaded, settings);
  const Stopwatch watch;
  ChildMessage message = solve_here(make, loaded, drive, limits, row.start);
  message.peak_memory_MB = std::nan("");
  if (message.verdict == Verdict::timeout) message.solve_seconds = watch.seconds();
  clear_measures(row);
  take_message(message, loaded, drive.max_seconds, row);
}

}  // namespace ballast
