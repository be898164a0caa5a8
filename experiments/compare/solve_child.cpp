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
#include "solvers/seam/verdict.hpp"

namespace ballast {
namespace {

/// How the child says it ended, apart from being solved or not.
enum class ChildOutcome { driven, unsupported, out_of_memory, failed, lost, late };

/// What a child sends.
struct ChildMessage : SolveAccount {
  ChildOutcome outcome = ChildOutcome::failed;
  StopReason reason = StopReason::numerical_failure;
  Impulses impulses;

  /// Packs and unpacks: the carrier decides.
  template <typename Carrier>
  void carry(Carrier& c) {
    c.number(outcome);
    c.text(note);
    c.number(reason);
    c.number(claimed);
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
  const bool no_memory = failure == std::bad_alloc().what();
  message.outcome = no_memory         ? ChildOutcome::out_of_memory
                    : failure.empty() ? ChildOutcome::driven
                                      : ChildOutcome::failed;
  message.note = failure;
  message.reason = driven.run.solved.reason;
  message.claimed = driven.claimed;
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
  } while (message.claimed && message.runs < limits.most_runs &&
           spent + fastest < limits.warm_seconds);
}

ChildMessage solve_here(const MakeSolver& make, const LoadedCase& loaded,
                        const DriveSettings& drive, const ChildLimits& limits, StartKind start) {
  ChildMessage message;
  try {
    drive_repeatedly(make, loaded, drive, limits, start, message);
  } catch (const UnsupportedProblem& error) {
    message.outcome = ChildOutcome::unsupported;
    message.note = error.what();
  } catch (const LostProcess& error) {
    message.outcome = error.is_out_of_time ? ChildOutcome::late : ChildOutcome::lost;
    message.note = error.what();
  } catch (const std::bad_alloc&) {
    message.outcome = ChildOutcome::out_of_memory;
  } catch (const std::exception& error) {
    message.outcome = ChildOutcome::failed;
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

/// The judge's measures of the row, and what they and the backend's word come to.
Finding judge(const LoadedCase& loaded, const Impulses& impulses, StopReason reason,
              CompareRow& row) {
  if (impulses.size() != loaded.problem.row_count()) return {};
  const ContactError error = contact_error(loaded.problem, impulses);
  row.natural_map_rms = error.natural_map_rms;
  row.natural_map_max = error.natural_map_max;
  row.fclib = error.fclib;
  row.cone_violation = error.cone_violation;
  row.min_normal_velocity = error.min_normal_velocity;
  row.worst_contact = error.worst_contact;
  row.worst = loaded.describe_contact(error.worst_contact);
  row.distance =
      answer_distance(loaded.problem, impulses, loaded.exact, loaded.facts.velocity_scale);
  row.error = row.measure == Measure::fclib ? error.fclib
                                            : error.natural_map_rms / loaded.facts.velocity_scale;
  const double tolerance = row.tolerance * loaded.facts.velocity_scale;
  const bool by_fclib = row.measure == Measure::fclib;
  const StopReason said = row.claimed ? StopReason::reached_tolerance : reason;
  const Verdict verdict =
      by_fclib ? fclib_verdict_of(said, error, row.tolerance) : verdict_of(said, error, tolerance);
  row.judged = by_fclib
                   ? error.finite && error.fclib <= row.tolerance && verdict != Verdict::no_solution
                   : error.within(tolerance);
  if (verdict == Verdict::solved) return {verdict, ""};
  const Finding found = finding_on(loaded.problem, impulses, said, error, tolerance);
  if (found.verdict == Verdict::no_solution || !by_fclib) return found;
  return {verdict, ""};
}

Outcome outcome_of(const ChildMessage& message, const CompareRow& row, Verdict verdict,
                   double max_seconds) {
  switch (message.outcome) {
    case ChildOutcome::unsupported:
      return Outcome::unsupported;
    case ChildOutcome::out_of_memory:
      return Outcome::out_of_memory;
    case ChildOutcome::failed:
      return Outcome::stopped;
    case ChildOutcome::lost:
      return Outcome::crashed;
    case ChildOutcome::late:
      return Outcome::timeout;
    case ChildOutcome::driven:
      break;
  }
  if (verdict == Verdict::no_solution) return Outcome::no_solution;
  if (row.seconds() > max_seconds) return Outcome::timeout;
  if (row.claimed && row.judged) return Outcome::solved;
  return message.reason == StopReason::time_limit ? Outcome::timeout : Outcome::stopped;
}

void clear_measures(CompareRow& row) {
  row.error = row.natural_map_rms = row.natural_map_max = row.fclib = std::nan("");
}

/// What the solver's process said, and what the judge says to that.
void take_message(const ChildMessage& message, const LoadedCase& loaded, double max_seconds,
                  CompareRow& row) {
  static_cast<SolveAccount&>(row) = message;
  row.reason = message.outcome == ChildOutcome::driven ? name_of(message.reason) : "";
  const Finding found = judge(loaded, message.impulses, message.reason, row);
  row.outcome = outcome_of(message, row, found.verdict, max_seconds);
  const bool is_told = found.verdict == Verdict::denied || found.verdict == Verdict::no_solution;
  if (row.note.empty() && is_told) row.note = found.words;
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
    row.outcome = child.end == ChildEnd::out_of_time ? Outcome::timeout : Outcome::crashed;
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
  if (message.outcome == ChildOutcome::late) message.solve_seconds = watch.seconds();
  clear_measures(row);
  take_message(message, loaded, drive.max_seconds, row);
}

}  // namespace ballast
