#include "experiments/compare/reference_times.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return cells;
}

bool parse_number(const std::string& text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value) &&
         value >= 0.0;
}

}  // namespace

std::string problem_stem(std::string name) {
  for (const std::string& suffix :
       {std::string(".dat"), std::string(".hdf5"), std::string(".h5"), std::string("-condensed")})
    if (name.ends_with(suffix)) name.erase(name.size() - suffix.size());
  return name;
}

std::vector<ReferenceTimes> read_reference_times(const std::filesystem::path& file) {
  std::istringstream lines(read_whole_file(file));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> head = cells_of(line);
  const auto fail = [&](int number, const std::string& what) {
    throw Error(file.string() + ": line " + std::to_string(number) + ": " + what);
  };
  if (head.size() < 3 || head[0] != "problem" || head.size() % 2 == 0)
    fail(1, "expected the header problem,ms_<tolerance>,solver_<tolerance>,...");
  std::vector<ReferenceTimes> times;
  for (size_t k = 1; k < head.size(); k += 2) {
    ReferenceTimes column;
    if (head[k].rfind("ms_", 0) != 0 || !parse_number(head[k].substr(3), column.tolerance))
      fail(1, "'" + head[k] + "': expected ms_<tolerance>");
    times.push_back(column);
  }
  for (int number = 2; std::getline(lines, line); ++number) {
    if (line.empty() || line == "\r") continue;
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != head.size())
      fail(number, "expected " + std::to_string(head.size()) + " cells");
    for (size_t k = 1; k < cells.size(); k += 2) {
      double ms = 0.0;
      if (cells[k].empty()) {
        times[k / 2].unsolved.insert(problem_stem(cells[0]));
        continue;
      }
      if (!parse_number(cells[k], ms))
        fail(number, "'" + cells[k] + "': expected milliseconds >= 0");
      times[k / 2].entries[problem_stem(cells[0])] = {1e-3 * ms, cells[k + 1]};
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
