#include "experiments/compare/compare_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "experiments/measure/curve_fit.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

size_t index_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

CompareCell cell_of(const std::vector<const CompareRow*>& repeats) {
  CompareCell cell;
  if (repeats.empty()) return cell;
  std::vector<double> seconds;
  cell.row = repeats.front();
  cell.solved = true;
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

/// Steps up by 1/n at every finite value.
StepCurve counted(std::vector<double> values, double first, double last) {
  const double n = static_cast<double>(values.size());
  std::sort(values.begin(), values.end());
  StepCurve curve{{first}, {0.0}};
  for (size_t k = 0; k < values.size() && values[k] <= last; ++k) {
    const double fraction = static_cast<double>(k + 1) / n;
    if (values[k] <= curve.x.back()) {
      curve.y.back() = fraction;
    } else {
      curve.x.push_back(values[k]);
      curve.y.push_back(fraction);
    }
  }
  return curve;
}

}  // namespace

const CaseFacts& CompareTable::facts(size_t case_index) const {
  const auto is_tried = [](const CompareCell& cell) { return cell.row != nullptr; };
  return std::ranges::find_if(cells[case_index], is_tried)->row->facts;
}

double CompareTable::fastest(size_t case_index) const {
  double least = not_reached;
  for (const CompareCell& cell : cells[case_index]) least = std::min(least, cell.median);
  return least;
}

CompareCosts CompareTable::time_ratios() const {
  CompareCosts costs;
  for (size_t c = 0; c < cases.size(); ++c) {
    costs.emplace_back();
    const double best = fastest(c);
    for (const CompareCell& cell : cells[c])
      costs[c].push_back(cell.solved ? (best > 0.0 ? cell.median / best : 1.0) : not_reached);
  }
  return costs;
}

CompareCosts CompareTable::times_per_contact() const {
  CompareCosts costs;
  for (size_t c = 0; c < cases.size(); ++c) {
    costs.emplace_back();
    for (const CompareCell& cell : cells[c])
      costs[c].push_back(cell.median / std::max(1, facts(c).contacts));
  }
  return costs;
}

std::string CompareTable::heading() const {
  return printed("Tolerance %g, %s start", tolerance, name_of(start));
}

std::vector<CompareTable> compare_tables(std::span<const CompareRow> rows) {
  std::map<std::pair<StartKind, double>,
           std::map<std::pair<size_t, size_t>, std::vector<const CompareRow*>>>
      groups;
  std::vector<std::string> cases, solvers;
  for (const CompareRow& row : rows) {
    if (row.verdict == Verdict::unreadable) continue;
    const size_t c = index_of(cases, row.case_name), s = index_of(solvers, row.solver);
    groups[{row.start, -row.tolerance}][{c, s}].push_back(&row);
  }
  std::vector<CompareTable> tables;
  for (const auto& [what, repeats] : groups) {
    CompareTable table{what.first, -what.second, {}, solvers, {}};
    for (size_t c = 0; c < cases.size(); ++c) {
      std::vector<CompareCell> line;
      for (size_t s = 0; s < solvers.size(); ++s) {
        const auto found = repeats.find({c, s});
        line.push_back(
            cell_of(found == repeats.end() ? std::vector<const CompareRow*>() : found->second));
      }
      // a case without a warm start is in no warm table
      if (std::none_of(line.begin(), line.end(),
                       [](const CompareCell& cell) { return cell.row != nullptr; }))
        continue;
      table.cases.push_back(cases[c]);
      table.cells.push_back(std::move(line));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

CompareTable tried_by_all(const CompareTable& table) {
  CompareTable common{table.start, table.tolerance, {}, table.solvers, {}};
  for (size_t c = 0; c < table.cases.size(); ++c) {
    if (!std::ranges::all_of(table.cells[c], &CompareCell::row)) continue;
    common.cases.push_back(table.cases[c]);
    common.cells.push_back(table.cells[c]);
  }
  return common;
}

double shifted_geometric_mean(std::span<const double> values, double shift) {
  double sum = 0.0;
  for (const double value : values) sum += std::log(value + shift);
  return std::exp(sum / static_cast<double>(values.size())) - shift;
}

double shifted_geometric_ratio(std::span<const double> a, std::span<const double> b, double shift) {
  double sum = 0.0;
  for (size_t k = 0; k < a.size(); ++k) sum += std::log((a[k] + shift) / (b[k] + shift));
  return std::exp(sum / static_cast<double>(a.size()));
}

std::vector<StepCurve> cost_profiles(const CompareCosts& costs, double first, double last) {
  std::vector<StepCurve> curves;
  for (size_t s = 0; !costs.empty() && s < costs[0].size(); ++s) {
    std::vector<double> values;
    for (const std::vector<double>& line : costs) values.push_back(line[s]);
    curves.push_back(counted(std::move(values), first, last));
  }
  return curves;
}

StepCurve best_so_far(const CompareRow& row) {
  StepCurve curve;
  for (const HistoryRow& point : row.history) {
    if (!std::isfinite(point.error) || (!curve.y.empty() && point.error >= curve.y.back()))
      continue;
    curve.x.push_back(row.prepare_seconds + point.seconds);
    curve.y.push_back(point.error);
  }
  return curve;
}

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
      summary.denied += cell.row->verdict == Verdict::denied;
      summary.largest_spread = std::max(summary.largest_spread, cell.spread);
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

}  // namespace ballast
