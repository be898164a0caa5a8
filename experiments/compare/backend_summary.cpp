#include "experiments/compare/backend_summary.hpp"

#include <algorithm>
#include <cmath>

#include "platform/text.hpp"

namespace ballast {

double limit_of(std::span<const CompareRow> rows) {
  double limit = 0.0;
  for (const CompareRow& row : rows) limit = std::max(limit, row.max_seconds);
  return limit;
}

std::vector<BackendSummary> backend_summaries(const CompareTable& table, double limit) {
  std::vector<BackendSummary> summaries;
  for (size_t s = 0; s < table.solvers.size(); ++s) {
    BackendSummary summary;
    summary.solver = table.solvers[s];
    std::vector<double> times, ratios_of, best;
    for (size_t c = 0; c < table.cases.size(); ++c) {
      const CompareCell& cell = table.cells[c][s];
      if (!cell.row) continue;
      summary.law = cell.row->law;
      summary.solved += cell.solved;
      summary.unsolved += !cell.solved;
      summary.timeouts += cell.row->verdict == Verdict::timeout;
      summary.crashes +=
          cell.row->verdict == Verdict::crashed || cell.row->verdict == Verdict::out_of_memory;
      summary.unsupported += cell.row->verdict == Verdict::unsupported;
      summary.no_solutions += cell.row->verdict == Verdict::no_solution;
      summary.false_successes += cell.row->verdict == Verdict::denied;
      if (cell.solved && cell.median > 0.0)
        summary.largest_spread =
            std::max(summary.largest_spread, (cell.slowest - cell.fastest) / cell.median);
      times.push_back(std::min(cell.median, limit));
      if (std::isinf(table.fastest(c))) continue;
      ratios_of.push_back(times.back());
      best.push_back(table.fastest(c));
    }
    summary.mean_seconds = shifted_geometric_mean(times, summary_shift);
    summary.mean_ratio =
        best.empty() ? std::nan("") : shifted_geometric_ratio(ratios_of, best, summary_shift);
    summaries.push_back(std::move(summary));
  }
  std::stable_sort(
      summaries.begin(), summaries.end(), [](const BackendSummary& a, const BackendSummary& b) {
        return a.solved != b.solved ? a.solved > b.solved : a.mean_seconds < b.mean_seconds;
      });
  return summaries;
}

std::string heading_of(const CompareTable& table) {
  return printed("Tolerance %g, %s start", table.tolerance, name_of(table.start));
}

std::string compare_summary(std::span<const CompareRow> rows,
                            std::span<const ReferenceTimes> reference) {
  std::string text;
  const double limit = limit_of(rows);
  const std::vector<CompareTable> tables = compare_tables(rows);
  for (const CompareTable& table : tables) {
    text += heading_of(table) + ", " + std::to_string(table.cases.size()) + " cases\n";
    for (const BackendSummary& s : backend_summaries(table, limit)) {
      text += printed(
          "  %-16s solved %4d   mean %10.4g ms (hides %d unsolved)   over fastest %8.3g   "
          "timeouts %d, crashes %d, not taken %d, no solution %d%s\n",
          s.solver.c_str(), s.solved, 1e3 * s.mean_seconds, s.unsolved, s.mean_ratio, s.timeouts,
          s.crashes, s.unsupported, s.no_solutions, s.false_successes ? "   CLAIMS DENIED" : "");
    }
  }
  for (const ReferenceComparison& comparison : compare_with_reference(tables, reference))
    for (const double shift : mean_shifts) {
      text += printed(
          "reference, tolerance %g, shift %g ms: our fastest / theirs %.3g, auto / "
          "theirs %.3g (%zu problems, %zu not solved by us)\n",
          comparison.tolerance, 1e3 * shift, comparison.ratio(shift, limit, false),
          comparison.ratio(shift, limit, true), comparison.lines.size(), comparison.missing.size());
    }
  return text;
}

}  // namespace ballast
