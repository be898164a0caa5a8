#include "experiments/compare/reference_times.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/measure/curve_fit.hpp"
#include "platform/csv.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// NaN for what is no finite number >= 0.
double time_of(std::string_view text) {
  const double value = parsed_number(text).value_or(-1.0);
  return std::isfinite(value) && value >= 0.0 ? value : not_known;
}

}  // namespace

std::string problem_stem(std::string name) {
  for (const std::string& suffix :
       {std::string(".dat"), std::string(".hdf5"), std::string(".h5"), std::string("-condensed")})
    if (name.ends_with(suffix)) name.erase(name.size() - suffix.size());
  return name;
}

std::vector<ReferenceTimes> read_reference_times(const std::filesystem::path& file) {
  CsvReader reader(file);
  reader.next();
  const size_t columns = reader.cells().size();
  if (columns < 3 || reader.cells()[0] != "problem" || columns % 2 == 0)
    reader.fail("expected the header problem,ms_<tolerance>,solver_<tolerance>,...");
  std::vector<ReferenceTimes> times;
  for (size_t k = 1; k < columns; k += 2) {
    const std::string_view name = reader.cells()[k];
    times.emplace_back().tolerance = time_of(name.substr(std::min<size_t>(3, name.size())));
    if (!name.starts_with("ms_") || std::isnan(times.back().tolerance))
      reader.fail("'" + std::string(name) + "': expected ms_<tolerance>");
  }
  while (reader.next()) {
    reader.require_cells(columns);
    const std::string problem = problem_stem(std::string(reader.cells()[0]));
    for (size_t k = 1; k < columns; k += 2) {
      const std::string_view cell = reader.cells()[k];
      const double ms = cell.empty() ? not_reached : time_of(cell);
      if (std::isnan(ms)) reader.fail("'" + std::string(cell) + "': expected milliseconds >= 0");
      times[k / 2].entries[problem] = {1e-3 * ms, std::string(reader.cells()[k + 1])};
    }
  }
  return times;
}

double ReferenceComparison::ratio(double shift, double limit, bool of_auto) const {
  std::vector<double> a, b;
  for (const Line& line : lines) {
    const double value = of_auto ? line.automatic : line.ours;
    if (std::isnan(value)) return value;
    a.push_back(std::min(value, limit));
    b.push_back(line.theirs);
  }
  return a.empty() ? not_known : shifted_geometric_ratio(a, b, shift);
}

std::vector<ReferenceComparison> compare_with_reference(std::span<const CompareTable> tables,
                                                        std::span<const ReferenceTimes> reference) {
  std::vector<ReferenceComparison> comparisons;
  for (const CompareTable& table : tables) {
    const auto times = std::ranges::find(reference, table.tolerance, &ReferenceTimes::tolerance);
    if (table.start != StartKind::cold || times == reference.end()) continue;
    ReferenceComparison& comparison = comparisons.emplace_back();
    comparison.tolerance = table.tolerance;
    for (size_t c = 0; c < table.cases.size(); ++c) {
      const auto theirs = times->entries.find(problem_stem(table.cases[c]));
      if (theirs == times->entries.end()) continue;
      ReferenceComparison::Line line{table.cases[c],         theirs->second.solver, "",
                                     theirs->second.seconds, not_reached,           not_known};
      for (size_t s = 0; s < table.solvers.size(); ++s) {
        const double seconds = table.cells[c][s].median;
        if (table.solvers[s] == "auto") line.automatic = seconds;
        if (table.solvers[s].starts_with("siconos") || !(seconds < line.ours)) continue;
        line.ours = seconds;
        line.our_solver = table.solvers[s];
      }
      if (std::isinf(line.theirs)) {
        if (std::isfinite(line.ours)) comparison.only_ours.push_back(line.case_name);
        continue;
      }
      if (std::isinf(line.ours)) comparison.missing.push_back(line.case_name);
      comparison.lines.push_back(std::move(line));
    }
  }
  return comparisons;
}

}  // namespace ballast
