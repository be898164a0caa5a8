#include "experiments/compare/compare_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/run_page/report.hpp"
#include "platform/atomic_file.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {

std::string comparison_file(const std::string& name);  // in experiments/compare/answers

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A time in microseconds, milliseconds or seconds; a dash where it is not finite.
page::Text time_of(double seconds) {
  if (!std::isfinite(seconds)) return {"–", page::note};
  if (seconds < 1e-4) return page::quantity(1e6 * seconds, "µs");
  return seconds < 1.0 ? page::quantity(1e3 * seconds, "ms") : page::quantity(seconds, "s");
}

page::Table backends_table(const CompareTable& table) {
  // a count of 0 leaves its cell empty
  const auto if_any = [](int count) { return count == 0 ? page::Text() : page::exact(count); };
  page::Table result{.head = {"backend", "law", "solved", "mean time", "unsolved in it",
                              "over fastest", "timeouts", "crashes", "not taken", "no solution",
                              "claims denied", "spread"}};
  result.is_number.assign(result.head.size(), true);
  result.is_number[0] = result.is_number[1] = false;
  for (const BackendSummary& s : table.backends)
    result.rows.push_back(
        {s.solver, s.law, page::exact(s.solved) + " of " + page::exact(s.solved + s.unsolved),
         time_of(s.mean_seconds), page::styled(if_any(s.unsolved), page::bad),
         page::number(s.mean_ratio), if_any(s.timeouts), if_any(s.crashes), if_any(s.unsupported),
         if_any(s.no_solutions), page::styled(if_any(s.denied), page::bad),
         s.largest_spread > 0.0 ? page::quantity(100.0 * s.largest_spread, "%", 2) : page::Text()});
  return result;
}

/// Unreadable cases, claims that the judge denies, crashes, lack of memory, problems that a backend
/// does not take or that have no solution, and other unsolved rows with a note.
page::Table failures_table(std::span<const CompareRow> rows) {
  page::Table result{.head = {"case", "backend", "tolerance", "what happened", "error"},
                     .is_number = {false, false, true, false, true}};
  std::set<std::string> told;
  for (const CompareRow& row : rows) {
    const Verdict v = row.verdict;
    // Each reason of a backend's refusals is listed once, and so is a case without a solution.
    const bool is_refused = v == Verdict::unsupported, has_none = v == Verdict::no_solution;
    const bool is_loud = is_refused || has_none || v == Verdict::denied || v == Verdict::crashed ||
                         v == Verdict::out_of_memory;
    const bool is_quiet = row.note.empty() || row.note.starts_with(not_tried);
    if (v == Verdict::solved || (!is_loud && is_quiet)) continue;
    if ((is_refused && !told.insert(row.solver + row.note).second) ||
        (has_none && !told.insert(row.case_name + row.note).second))
      continue;
    const std::string what = v == Verdict::denied ? "claims success" : name_of(v);
    const char* otherwise = row.verdict == Verdict::denied ? ": the judge denies it" : "";
    result.rows.push_back({row.case_name, row.solver,
                           row.solver.empty() ? page::Text() : page::exact(row.tolerance),
                           what + (row.note.empty() ? otherwise : ": " + row.note),
                           row.solver.empty() ? page::Text() : page::number(row.error, 2)});
  }
  return result;
}

/// Reads manifest.json of a folder.
RunData read_origin(const fs::path& folder) {
  RunData data;
  const fs::path file = folder / "manifest.json";
  data.stored_manifest = std::make_shared<const Json>(json_object(read_whole_file(file), file));
  return data;
}

/// The summary of a comparison in its manifest, with its options.
page::Table options_table(const RunData& data) {
  page::Table table{.is_facts = true};
  if (const auto summary = data.manifest().find("summary"); summary != data.manifest().end())
    for (const auto& [name, value] : summary->items())
      table.rows.push_back({name, value.is_number()   ? page::exact(value.get<double>())
                                  : value.is_string() ? page::Text(value.get<std::string>())
                                                      : page::Text(value.dump())});
  return table;
}

page::Page compare_page(const RunData& data, std::span<const CompareRow> rows,
                        std::span<const CompareRow> tried) {
  page::Section backends{"backends", "The backends"};
  backends.add(
      page::words("compare.explanation", {{"shift", page::quantity(1e3 * summary_shift, "ms", 1)},
                                          {"limit", page::quantity(limit_of(tried), "s")}}));
  for (const CompareTable& table : compare_tables(tried)) {
    backends.add(page::Subheading{table.heading});
    backends.add(backends_table(table));
  }
  page::Page page{.title = "Solvers of frictional contact, compared"};
  page.lede = {
      page::words("compare.lede", {{"solvers", different(tried, &CompareRow::solver)},
                                   {"problems", different(tried, &CompareRow::case_name)},
                                   {"solves", page::exact(tried.size())},
                                   {"measure", tried.empty() ? "" : name_of(tried[0].measure)}})};
  page.add(backends);
  page.add({"failures", "What must not happen", {failures_table(rows)}});
  // The page makes these sections itself, in the reader's browser.
  if (page::has_chart_library())
    for (const auto& [id, heading] : {std::pair("matrix", "Every case by every backend"),
                                      {"profiles", "Profiles"},
                                      {"families", "Accuracy against cost, by family"},
                                      {"cost", "What cost depends on"},
                                      {"case-figures", "Accuracy against cost, case by case"}})
      page.add({id, heading, {page::words(id)}});
  page.add({"options", "Options", {options_table(data)}});
  if (!tried.empty()) page.answers = comparison_answers(data, tried);
  return page;
}

/// The most points of all histories together that a page can hold.
constexpr size_t most_points = 25000;

/// The command that makes a row again. The page fills in the names in braces.
std::string again(const RunData& data, const CompareRow& row) {
  std::string command =
      "ballast compare {case} --solvers {solver} --tolerances {tolerance} --starts {start} "
      "--measure " +
      std::string(name_of(row.measure)) + printed(" --max-seconds %g", row.max_seconds);
  const auto memory = "/summary/memory_MB"_json_pointer;
  if (data.manifest().contains(memory) && data.manifest()[memory].is_number())
    command += printed(" --memory %g", data.manifest()[memory].get<double>());
  return command + " --output results/again";
}

/// The least errors so far: seconds (with prepare) and error in turn, in the digits of a chart.
std::string history_text(const CompareRow& row, size_t limit) {
  std::vector<double> seconds, errors;
  for (const HistoryPoint& point : row.history) {
    if (!std::isfinite(point.error) || (!errors.empty() && point.error >= errors.back())) continue;
    seconds.push_back(row.prepare_seconds + point.seconds);
    errors.push_back(point.error);
  }
  thin_out(seconds, errors, limit);
  std::string text;
  for (size_t k = 0; k < seconds.size(); ++k)
    text += printed(k == 0 ? "%.3g %.2g" : " %.3g %.2g", seconds[k], errors[k]);
  return text;
}

/// A backend's summary while solves are added to it.
struct Tally {
  BackendSummary summary;
  std::vector<double> times, ratios;  ///< logarithms, shifted

  void add(const RepeatedSolve& solve, double best, double limit) {
    const Verdict verdict = solve.row->verdict;
    const double seconds = solve.solved ? std::min(solve.median, limit) : limit;
    summary.law = solve.row->law;
    summary.solved += solve.solved;
    summary.unsolved += !solve.solved;
    summary.timeouts += verdict == Verdict::timeout;
    summary.crashes += verdict == Verdict::crashed || verdict == Verdict::out_of_memory;
    summary.unsupported += verdict == Verdict::unsupported;
    summary.no_solutions += verdict == Verdict::no_solution;
    summary.denied += verdict == Verdict::denied;
    if (solve.median > 0.0)
      summary.largest_spread =
          std::max(summary.largest_spread, (solve.slowest - solve.fastest) / solve.median);
    times.push_back(std::log(seconds + summary_shift));
    if (std::isfinite(best)) ratios.push_back(times.back() - std::log(best + summary_shift));
  }
};

}  // namespace

page::Answers comparison_answers(const RunData& data, std::span<const CompareRow> rows) {
  Json json = {{"measure", name_of(rows[0].measure)},
               {"limit", limit_of(rows)},
               {"shift", summary_shift},
               {"again", again(data, rows[0])}};
  const std::vector<std::string> names = compare_columns();
  // A column is one text with a line for each cell: the browser splits it when it is first read.
  std::vector<std::string> columns(names.size());
  std::string words, can_view, histories;
  const auto add = [](std::string_view cell, std::string& column) {
    column += one_line(cell, ' ') + '\n';
  };
  const size_t points = std::clamp<size_t>(most_points / rows.size(), 8, 100);
  for (const CompareRow& row : rows) {
    const std::vector<std::string> cells = cells_of(row);
    for (size_t c = 0; c < names.size(); ++c) add(cells[c], columns[c]);
    add(shell_quoted(row.word.empty() ? row.case_name : row.word), words);
    add(row.can_view ? "yes" : "", can_view);
    add(row.history.size() > 1 ? history_text(row, points) : "", histories);
  }
  for (size_t c = 0; c < names.size(); ++c) json["columns"][names[c]] = columns[c];
  json["more"] = {{"word", words}, {"can_view", can_view}, {"history", histories}};
  page::Answers answers{.is_enabled = true};
  answers.data = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (const char* name : {"rows.js", "statistics.js", "asks.js", "views.js", "histories.js",
                           "details.js", "comparison.js"})  // each uses those before it
    answers.modules.push_back(comparison_file(name));
  return answers;
}

std::string compare_summary(std::span<const CompareRow> rows) {
  std::string text;
  for (const CompareTable& table : compare_tables(rows)) {
    text += table.heading + ", " + std::to_string(table.cases.size()) + " cases\n";
    for (const BackendSummary& s : table.backends)
      text += printed(
          "  %-16s solved %4d   mean %10.4g ms (hides %d unsolved)   over fastest %8.3g   "
          "timeouts %d, crashes %d, not taken %d, no solution %d%s\n",
          s.solver.c_str(), s.solved, 1e3 * s.mean_seconds, s.unsolved, s.mean_ratio, s.timeouts,
          s.crashes, s.unsupported, s.no_solutions, s.denied ? "   CLAIMS DENIED" : "");
  }
  return text;
}

void write_compare_page(const fs::path& folder, std::span<const CompareRow> rows) {
  std::vector<CompareRow> tried;
  for (const CompareRow& row : rows)
    if (row.verdict != Verdict::unreadable) tried.push_back(row);
  write_with_origin(compare_page(read_origin(folder), rows, tried), folder / "compare.html");
}

void write_with_origin(page::Page page, const fs::path& file) {
  const RunData data = read_origin(file.parent_path());
  if (const std::string made = made_by(data); !made.empty()) page.lede.push_back(made);
  page.add({"provenance", "Program and machine", {provenance_table(data)}});
  page::draw_pictures(page, file.parent_path());
  write_whole_file(file, html_of(page));
}

RepeatedSolve over_repeats(const std::vector<const CompareRow*>& repeats) {
  RepeatedSolve solve{repeats.front()};
  std::vector<double> seconds;
  for (const CompareRow* row : repeats) {
    const bool solved = row->verdict == Verdict::solved;
    solve.solved = solve.solved && solved;
    if (solved && (solve.row->verdict != Verdict::solved || row->seconds() < solve.row->seconds()))
      solve.row = row;
    seconds.push_back(row->seconds());
  }
  if (!solve.solved) return solve;
  solve.fastest = std::ranges::min(seconds);
  solve.slowest = std::ranges::max(seconds);
  solve.median = quantile(seconds, 0.5);
  return solve;
}

std::vector<CompareTable> compare_tables(std::span<const CompareRow> rows) {
  // by start and tolerance, then by case, then by backend
  std::map<std::pair<StartKind, double>,
           std::map<std::string, std::map<std::string, std::vector<const CompareRow*>>>>
      groups;
  for (const CompareRow& row : rows)
    if (row.verdict != Verdict::unreadable)
      groups[{row.start, -row.tolerance}][row.case_name][row.solver].push_back(&row);
  const double limit = limit_of(rows);
  std::vector<CompareTable> tables;
  for (const auto& [what, cases] : groups) {
    CompareTable& table = tables.emplace_back();
    std::map<std::string, Tally> tallies;
    for (const auto& [name, by_solver] : cases) {
      std::map<std::string, RepeatedSolve>& solves = table.cases[name];
      double best = std::numeric_limits<double>::infinity();
      for (const auto& [solver, repeats] : by_solver) {
        const RepeatedSolve& solve = solves[solver] = over_repeats(repeats);
        if (solve.solved) best = std::min(best, solve.median);
      }
      for (const auto& [solver, solve] : solves) tallies[solver].add(solve, best, limit);
    }
    table.heading = printed("Tolerance %g, %s start", -what.second, name_of(what.first));
    table.start = what.first;
    table.tolerance = -what.second;
    for (auto& [solver, tally] : tallies) {
      tally.summary.solver = solver;
      tally.summary.mean_seconds = std::exp(statistics(tally.times).mean) - summary_shift;
      tally.summary.mean_ratio = std::exp(statistics(tally.ratios).mean);
      table.backends.push_back(std::move(tally.summary));
    }
    std::ranges::stable_sort(table.backends, {}, [](const BackendSummary& s) {
      return std::pair(-s.solved, s.mean_seconds);
    });
  }
  return tables;
}

page::Text different(std::span<const CompareRow> rows, std::string CompareRow::*name) {
  std::set<std::string> names;
  for (const CompareRow& row : rows) names.insert(row.*name);
  return page::exact(names.size());
}

double limit_of(std::span<const CompareRow> rows) {
  double limit = 0.0;
  for (const CompareRow& row : rows) limit = std::max(limit, row.max_seconds);
  return limit;
}

}  // namespace ballast
