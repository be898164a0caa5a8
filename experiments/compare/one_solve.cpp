#include "experiments/compare/one_solve.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <utility>

#include <sys/resource.h>

#include "platform/clock.hpp"
#include "platform/pack.hpp"
#include "platform/program.hpp"

namespace ballast {
namespace {

SolverRun drive(Solver& solver, const LoadedCase& loaded, const SolveLimits& limits,
                const CompareRow& row) {
  Budget budget{.tolerance = row.tolerance * loaded.facts.velocity_scale,
                .max_iterations = limits.max_iterations,
                .max_seconds = row.max_seconds,
                .keep_history = true};
  std::optional<FclibStop> fclib;
  if (row.measure == Measure::fclib) {
    budget.fclib = &fclib.emplace(loaded.problem, row.tolerance);
    budget.tolerance = 0.0;  // the natural map stops no solve
  }
  const Impulses from = row.start == StartKind::warm ? loaded.warm_start : Impulses();
  return SolverRunner().run(solver, loaded.problem, from, budget);
}

/// Makes a new solver for each run, so that nothing but caches carries over.
void drive_repeatedly(const MakeSolver& make, const LoadedCase& loaded, const SolveLimits& limits,
                      CompareRow& row, Solved& solved) {
  double spent = 0.0;
  do {
    const Stopwatch watch;
    const std::unique_ptr<Solver> solver = make();
    const double making = watch.seconds();
    SolverRun run = drive(*solver, loaded, limits, row);
    const double seconds = run.prepare_seconds + run.solve_seconds;
    // Only the first run has the costs of loading and starting once.
    if (row.runs == 0) row.startup_seconds = making + run.startup_seconds;
    const bool is_fastest = row.runs == 0 || seconds < row.seconds();
    ++row.runs;
    spent += watch.seconds();
    if (!is_fastest) continue;
    row.reason = run.failure.empty() ? name_of(run.solved.reason) : "";
    row.note = run.failure;
    if (run.failure == std::bad_alloc().what()) row.verdict = Verdict::out_of_memory;
    row.iterations = run.solved.iterations;
    row.prepare_seconds = run.prepare_seconds;
    row.solve_seconds = run.solve_seconds;
    row.history = std::move(run.solved.history);
    for (HistoryPoint& point : row.history) point.error /= loaded.facts.velocity_scale;
    solved = std::move(run.solved);
    if (!run.failure.empty()) solved.impulses.resize(0);
  } while (solved.reason == StopReason::reached_tolerance && row.runs < limits.most_runs &&
           spent + row.seconds() < limits.min_timing_seconds);
}

/// The child's whole work: fills in its part of the row, and returns the input of the judge, reason
/// and impulses. The parent does it for an external program.
Solved solve_here(const MakeSolver& make, const LoadedCase& loaded, const SolveLimits& limits,
                  CompareRow& row) {
  const CompareRow asked = row;
  Solved solved;
  row.verdict = Verdict::unsolved;
  // A failure drops the results of earlier runs.
  const auto fail = [&](Verdict verdict, const char* note) {
    solved = {};
    row = asked;
    row.verdict = verdict;
    row.note = note;
  };
  try {
    drive_repeatedly(make, loaded, limits, row, solved);
  } catch (const UnsupportedProblem& error) {
    fail(Verdict::unsupported, error.what());
  } catch (const LostProcess& error) {
    fail(error.is_out_of_time ? Verdict::timeout : Verdict::crashed, error.what());
  } catch (const std::bad_alloc&) {
    fail(Verdict::out_of_memory, "");
  } catch (const std::exception& error) {
    fail(Verdict::unsolved, error.what());
  }
  return solved;
}

/// Sets the errors of a row without an answer to NaN, so that it has none instead of a small one.
void clear_measures(CompareRow& row) {
  row.error = std::nan("");
  row.judged = {.natural_map_rms = row.error, .natural_map_max = row.error, .fclib = row.error};
}

/// Fills in the judge's measures of an answer, and the verdict from them and the backend's reason,
/// whose name is row.reason, unless that is empty.
void judge(const LoadedCase& loaded, Solved solved, CompareRow& row) {
  clear_measures(row);
  if (solved.impulses.size() != loaded.problem.row_count()) return;
  const double scale = loaded.facts.velocity_scale;
  SolverRun run;
  run.solved = std::move(solved);
  const Impulses& impulses = run.solved.impulses;
  const StopReason reason = run.solved.reason;
  run.error = contact_error(loaded.problem, impulses);
  const ContactError& error = row.judged = run.error;
  row.worst = loaded.describe_contact(error.worst_contact);
  row.distance = answer_distance(loaded.problem, impulses, loaded.exact, scale);
  const bool by_fclib = row.measure == Measure::fclib;
  row.error = by_fclib ? error.fclib : error.natural_map_rms / scale;
  if (row.reason.empty()) return;
  run.verdict =
      verdict_of(reason, error, by_fclib ? row.tolerance : row.tolerance * scale, by_fclib);
  const std::string words = explained(loaded.problem, run, row.tolerance * scale);
  row.verdict = run.verdict;
  // The words on a denial are about the natural map, so they are no note for another measure.
  if (row.verdict == Verdict::no_solution || (row.verdict == Verdict::denied && !by_fclib))
    row.note = words;
  const bool is_late = row.seconds() > row.max_seconds;
  if ((row.verdict == Verdict::solved && is_late) ||
      (row.verdict == Verdict::unsolved && (is_late || reason == StopReason::time_limit)))
    row.verdict = Verdict::timeout;
}

}  // namespace

void solve_case(const ComparedSolver& solver, const LoadedCase& loaded, const SolveLimits& limits,
                CompareRow& row) {
  if (!solver.external_key.empty()) {
    static_cast<void>(solver.make());  // throws where its files have no folder, which ends all
    const Stopwatch watch;
    Solved solved = solve_here(solver.make, loaded, limits, row);
    row.peak_memory_MB = std::nan("");
    if (row.verdict == Verdict::timeout) row.solve_seconds = watch.seconds();
    return judge(loaded, std::move(solved), row);
  }
  // Backends look at the clock between iterations, never in prepare(): the child has some grace.
  const double most_seconds = 1.25 * row.max_seconds + 2.0 + 2.0 * limits.min_timing_seconds;
  const ChildResult child = run_in_child(most_seconds, [&] {
    const auto bytes = static_cast<rlim_t>(limits.memory_MB * 1048576.0);
    const rlimit limit{bytes, bytes};
    if (bytes > 0) setrlimit(RLIMIT_AS, &limit);
    CompareRow made = row;
    const Solved solved = solve_here(solver.make, loaded, limits, made);
    made.peak_memory_MB = std::max(peak_memory_MB(), peak_memory_MB(RUSAGE_CHILDREN));
    Packer packer;
    packer.text(to_json(made));
    packer.number(solved.reason);
    packer.list(solved.impulses);
    return packer.bytes();
  });
  if (child.end != ChildEnd::complete) {
    const bool is_late = child.end == ChildEnd::out_of_time;
    clear_measures(row);
    row.verdict = is_late ? Verdict::timeout : Verdict::crashed;
    row.note = is_late                         ? "killed: did not stop at the time limit"
               : child.end == ChildEnd::failed ? child.answer
                                               : "the child process died";
    row.solve_seconds = is_late ? most_seconds : 0.0;
    return;
  }
  const std::string origin = "ballast compare: a child's answer";
  Solved solved;
  std::string text;
  Unpacker unpacker(child.answer, origin);
  unpacker.text(text);
  unpacker.number(solved.reason);
  unpacker.list(solved.impulses);
  unpacker.finish();
  row = compare_row_of_json(text, origin, row);
  judge(loaded, std::move(solved), row);
}

}  // namespace ballast
