#include "experiments/compare/compare_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "experiments/measure/curve_fit.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

using RowList = std::vector<const CompareRow*>;

/// One case by one backend, over its repeats.
struct CompareCell {
  const CompareRow* row;  ///< of the fastest repeat that solved it, else of the first
  bool solved = true;     ///< in every repeat
  double median = std::numeric_limits<double>::infinity();  ///< [s]; infinite when not solved
  double spread = 0.0;                                      ///< (slowest - fastest)/median
};

CompareCell cell_of(const RowList& repeats) {
  CompareCell cell{repeats.front()};
  std::vector<double> seconds;
  for (const CompareRow* row : repeats) {
    const bool solved = row->verdict == Verdict::solved;
    cell.solved = cell.solved && solved;
    if (solved && (cell.row->verdict != Verdict::solved || row->seconds() < cell.row->seconds()))
      cell.row = row;
    seconds.push_back(row->seconds());
  }
  if (!cell.solved) return cell;
  cell.median = quantile(seconds, 0.5);
  const auto [fastest, slowest] = std::ranges::minmax(seconds);
  if (cell.median > 0.0) cell.spread = (slowest - fastest) / cell.median;
  return cell;
}

/// A geometric mean under way; NaN for no values.
struct ShiftedMean {
  double logs = 0.0;
  int count = 0;
  void add(double value) {
    logs += std::log(value + summary_shift);
    ++count;
  }
  double with_shift() const { return count == 0 ? std::nan("") : std::exp(logs / count); }
};

/// A backend's summary under way.
struct Tally {
  BackendSummary summary;
  ShiftedMean times, beaten, fastest;

  void add(const CompareCell& cell, double best, double limit) {
    const Verdict verdict = cell.row->verdict;
    summary.law = cell.row->law;
    summary.solved += cell.solved;
    summary.unsolved += !cell.solved;
    summary.timeouts += verdict == Verdict::timeout;
    summary.crashes += verdict == Verdict::crashed || verdict == Verdict::out_of_memory;
    summary.unsupported += verdict == Verdict::unsupported;
    summary.no_solutions += verdict == Verdict::no_solution;
    summary.denied += verdict == Verdict::denied;
    summary.largest_spread = std::max(summary.largest_spread, cell.spread);
    times.add(std::min(cell.median, limit));
    if (std::isinf(best)) return;
    beaten.add(std::min(cell.median, limit));
    fastest.add(best);
  }
};

}  // namespace

std::vector<CompareTable> compare_tables(std::span<const CompareRow> rows) {
  // by start and tolerance, then by case, then by backend
  std::map<std::pair<StartKind, double>, std::map<std::string, std::map<std::string, RowList>>>
      groups;
  for (const CompareRow& row : rows)
    if (row.verdict != Verdict::unreadable)
      groups[{row.start, -row.tolerance}][row.case_name][row.solver].push_back(&row);
  const double limit = limit_of(rows);
  std::vector<CompareTable> tables;
  for (const auto& [what, cases] : groups) {
    std::map<std::string, Tally> tallies;
    for (const auto& [name, by_solver] : cases) {
      std::map<std::string, CompareCell> cells;
      for (const auto& [solver, repeats] : by_solver) cells.emplace(solver, cell_of(repeats));
      double best = std::numeric_limits<double>::infinity();
      for (const auto& [solver, cell] : cells) best = std::min(best, cell.median);
      for (const auto& [solver, cell] : cells) tallies[solver].add(cell, best, limit);
    }
    CompareTable& table = tables.emplace_back();
    table.heading = printed("Tolerance %g, %s start", -what.second, name_of(what.first));
    table.cases = cases.size();
    for (auto& [solver, tally] : tallies) {
      tally.summary.solver = solver;
      tally.summary.mean_seconds = tally.times.with_shift() - summary_shift;
      tally.summary.mean_ratio = tally.beaten.with_shift() / tally.fastest.with_shift();
      table.backends.push_back(std::move(tally.summary));
    }
    std::stable_sort(
        table.backends.begin(), table.backends.end(), [](const auto& a, const auto& b) {
          return a.solved != b.solved ? a.solved > b.solved : a.mean_seconds < b.mean_seconds;
        });
  }
  return tables;
}

double limit_of(std::span<const CompareRow> rows) {
  double limit = 0.0;
  for (const CompareRow& row : rows) limit = std::max(limit, row.max_seconds);
  return limit;
}

}  // namespace ballast
