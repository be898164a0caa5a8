#include "experiments/compare/compare_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "experiments/measure/curve_fit.hpp"

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
  if (repeats.empty()) {
    cell.median = cell.fastest = cell.slowest = infinity;
    return cell;
  }
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
  if (cell.solved) {
    cell.median = quantile(seconds, 0.5);
    cell.fastest = *std::min_element(seconds.begin(), seconds.end());
    cell.slowest = *std::max_element(seconds.begin(), seconds.end());
  } else {
    cell.median = cell.fastest = cell.slowest = infinity;
  }
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

std::vector<std::vector<double>> CompareTable::times() const {
  std::vector<std::vector<double>> times;
  for (const std::vector<CompareCell>& line : cells) {
    times.emplace_back();
    for (const CompareCell& cell : line) times.back().push_back(cell.median);
  }
  return times;
}

double CompareTable::fastest(size_t case_index) const {
  double least = infinity;
  for (const CompareCell& cell : cells[case_index]) least = std::min(least, cell.median);
  return least;
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

std::vector<StepCurve> performance_profiles(const std::vector<std::vector<double>>& times,
                                            double last) {
  const size_t solvers = times.empty() ? 0 : times[0].size();
  std::vector<StepCurve> curves;
  for (size_t s = 0; s < solvers; ++s) {
    std::vector<double> ratios;
    for (const std::vector<double>& line : times) {
      const double best = *std::min_element(line.begin(), line.end());
      ratios.push_back(std::isfinite(line[s]) ? (best > 0.0 ? line[s] / best : 1.0) : infinity);
    }
    curves.push_back(counted(std::move(ratios), 1.0, last));
  }
  return curves;
}

std::vector<StepCurve> data_profiles(const std::vector<std::vector<double>>& times,
                                     std::span<const double> sizes, double first, double last) {
  const size_t solvers = times.empty() ? 0 : times[0].size();
  std::vector<StepCurve> curves;
  for (size_t s = 0; s < solvers; ++s) {
    std::vector<double> costs;
    for (size_t c = 0; c < times.size(); ++c)
      costs.push_back(times[c][s] / std::max(1.0, sizes[c]));
    curves.push_back(counted(std::move(costs), first, last));
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

std::vector<double> mean_error_at(std::span<const StepCurve> curves,
                                  std::span<const double> times) {
  std::vector<double> means;
  for (const double time : times) {
    double sum = 0.0;
    long count = 0;
    for (const StepCurve& curve : curves) {
      if (curve.x.empty()) continue;
      const auto after = std::upper_bound(curve.x.begin(), curve.x.end(), time);
      const size_t k =
          after == curve.x.begin() ? 0 : static_cast<size_t>(after - curve.x.begin()) - 1;
      sum += std::log(std::max(curve.y[k], 1e-16));
      ++count;
    }
    means.push_back(count ? std::exp(sum / static_cast<double>(count))
                          : std::numeric_limits<double>::quiet_NaN());
  }
  return means;
}

}  // namespace ballast
