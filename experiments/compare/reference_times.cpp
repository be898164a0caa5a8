#include "experiments/compare/reference_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// A finite number >= 0; anything else is NaN.
double time_of(std::string_view text) {
  const double value = parsed_number(text).value_or(-1.0);
  return std::isfinite(value) && value >= 0.0 ? value : std::numeric_limits<double>::quiet_NaN();
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
      if (cell.empty()) {
        times[k / 2].unsolved.insert(problem);
        continue;
      }
      const double ms = time_of(cell);
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
  return a.empty() ? std::numeric_limits<double>::quiet_NaN()
                   : shifted_geometric_ratio(a, b, shift);
}

namespace {

bool is_ours(const std::string& solver) { return !solver.starts_with("siconos"); }

/// Fills in our fastest.
void take_fastest(const CompareTable& table, size_t c, ReferenceComparison::Line& line) {
  line.ours = std::numeric_limits<double>::infinity();
  for (size_t s = 0; s < table.solvers.size(); ++s) {
    if (!is_ours(table.solvers[s]) || !(table.cells[c][s].median < line.ours)) continue;
    line.ours = table.cells[c][s].median;
    line.our_solver = table.solvers[s];
  }
}

}  // namespace

std::vector<ReferenceComparison> compare_with_reference(std::span<const CompareTable> tables,
                                                        std::span<const ReferenceTimes> reference) {
  std::vector<ReferenceComparison> comparisons;
  for (const CompareTable& table : tables) {
    const auto times =
        std::find_if(reference.begin(), reference.end(),
                     [&](const ReferenceTimes& r) { return r.tolerance == table.tolerance; });
    if (table.start != StartKind::cold || times == reference.end()) continue;
    const auto automatic = std::find(table.solvers.begin(), table.solvers.end(), "auto");
    ReferenceComparison comparison;
    comparison.tolerance = table.tolerance;
    for (size_t c = 0; c < table.cases.size(); ++c) {
      ReferenceComparison::Line line;
      line.case_name = table.cases[c];
      take_fastest(table, c, line);
      const std::string stem = problem_stem(table.cases[c]);
      const auto theirs = times->entries.find(stem);
      if (theirs == times->entries.end()) {
        if (std::isfinite(line.ours) && times->unsolved.contains(stem))
          comparison.only_ours.push_back(table.cases[c]);
        continue;
      }
      if (std::isinf(line.ours)) comparison.missing.push_back(table.cases[c]);
      line.their_solver = theirs->second.solver;
      line.theirs = theirs->second.seconds;
      line.automatic = std::numeric_limits<double>::quiet_NaN();
      if (automatic != table.solvers.end())
        line.automatic =
            table.cells[c][static_cast<size_t>(automatic - table.solvers.begin())].median;
      comparison.lines.push_back(std::move(line));
    }
    comparisons.push_back(std::move(comparison));
  }
  return comparisons;
}

}  // namespace ballast
