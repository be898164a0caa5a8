#include "experiments/compare/compare_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/page/html.hpp"
#include "experiments/run_page/report.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {

std::string comparison_file(const std::string& name);  // of experiments/compare/answers

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

page::Text count_of(size_t count) { return page::exact(static_cast<double>(count)); }

/// Milliseconds or seconds; a dash for what is not finite.
page::Text time_of(double seconds) {
  if (!std::isfinite(seconds)) return {"–", page::note};
  if (seconds < 1e-4) return page::quantity(1e6 * seconds, "µs");
  return seconds < 1.0 ? page::quantity(1e3 * seconds, "ms") : page::quantity(seconds, "s");
}

/// Why a row is not solved, in a few words.
std::string reason_of(const CompareRow& row) {
  switch (row.verdict) {
    case Verdict::denied:
      return "denied";
    case Verdict::timeout:
      return row.reason.empty() ? "killed" : "time limit";
    case Verdict::crashed:
      return "crashed";
    case Verdict::out_of_memory:
      return "memory";
    case Verdict::unsupported:
      return "not taken";
    case Verdict::no_solution:
      return "no solution";
    default:
      break;
  }
  std::string reason = row.reason.empty() ? "failed" : row.reason;
  std::replace(reason.begin(), reason.end(), '_', ' ');
  return reason;
}

/// Case by backend: the time, or why there is none and how near it came.
page::Table matrix_table(const CompareTable& table) {
  page::Table result{.head = {"case"}, .is_number = {false}};
  for (const std::string& solver : table.solvers) {
    result.head.push_back(page::Text(solver, page::code));
    result.is_number.push_back(true);
  }
  for (size_t c = 0; c < table.cases.size(); ++c) {
    std::vector<page::Text>& line = result.rows.emplace_back();
    line.push_back(table.cases[c]);
    for (const CompareCell& cell : table.cells[c]) {
      page::Text& text = line.emplace_back();
      if (!cell.row) continue;
      text = cell.solved ? time_of(cell.median) : page::Text(reason_of(*cell.row), page::bad);
      if (!cell.solved && std::isfinite(cell.row->error))
        text += " " + page::number(cell.row->error, 1);
    }
  }
  return result;
}

/// Cases that could not be had, claims that the judge denies, crashes, memory, what is not taken,
/// and whatever left a note.
page::Table failures_table(std::span<const CompareRow> rows) {
  page::Table result{.head = {"case", "backend", "tolerance", "what happened", "error"},
                     .is_number = {false, false, true, false, true}};
  std::set<std::string> told;
  for (const CompareRow& row : rows) {
    const Verdict v = row.verdict;
    // What a backend does not take says why once, and so does a case without a solution.
    const bool is_refused = v == Verdict::unsupported, has_none = v == Verdict::no_solution;
    const bool is_loud = is_refused || has_none || v == Verdict::denied || v == Verdict::crashed ||
                         v == Verdict::out_of_memory;
    if (v == Verdict::solved || (!is_loud && row.note.empty())) continue;
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

page::Table ratios_table(const ReferenceComparison& comparison, double limit) {
  page::Table ratios{
      .head = {"shift of the mean", "our fastest over theirs", page::marked("`auto` over theirs")},
      .is_number = {true, true, true}};
  for (const double shift : mean_shifts)
    ratios.rows.push_back({page::quantity(1e3 * shift, "ms"),
                           page::number(comparison.ratio(shift, limit, false)),
                           page::number(comparison.ratio(shift, limit, true))});
  return ratios;
}

page::Table reference_lines(const ReferenceComparison& comparison) {
  page::Table lines{.head = {"case", "theirs", "by", "ours", "by", "ratio",
                             page::Text("auto", page::code), "ratio"},
                    .is_number = {false, true, false, true, false, true, true, true}};
  for (const ReferenceComparison::Line& line : comparison.lines) {
    const auto ratio = [&](double ours) {
      return line.theirs > 0.0 ? page::number(ours / line.theirs) : page::Text();
    };
    lines.rows.push_back({line.case_name, time_of(line.theirs), line.their_solver,
                          time_of(line.ours), line.our_solver, ratio(line.ours),
                          time_of(line.automatic), ratio(line.automatic)});
  }
  return lines;
}

void add_reference(const ReferenceComparison& comparison, double limit, page::Section& section) {
  section.add(page::Subheading{"Tolerance " + page::exact(comparison.tolerance)});
  section.add(ratios_table(comparison, limit));
  section.add(page::words("reference.ratios", {{"problems", count_of(comparison.lines.size())},
                                               {"limit", page::quantity(limit, "s")}}));
  if (!comparison.missing.empty())
    section.add(page::Text("Not solved by us:", page::bad) +
                (" " + joined(comparison.missing) + "."));
  if (!comparison.only_ours.empty())
    section.add(page::Text("Solved by us alone: " + joined(comparison.only_ours) + "."));
  section.add(reference_lines(comparison));
}

page::Text lede(std::span<const CompareRow> rows) {
  std::set<std::string> solvers, cases;
  for (const CompareRow& row : rows) {
    solvers.insert(row.solver);
    cases.insert(row.case_name);
  }
  return page::words("compare.lede", {{"solvers", count_of(solvers.size())},
                                      {"problems", count_of(cases.size())},
                                      {"solves", count_of(rows.size())},
                                      {"measure", rows.empty() ? "" : name_of(rows[0].measure)}});
}

/// What a comparison noted of its options in the manifest.
page::Table options_table(const RunData& data) {
  page::Table table = page::facts_table();
  if (const auto summary = data.manifest().find("summary"); summary != data.manifest().end())
    for (const auto& [name, value] : summary->items())
      table.rows.push_back({name, value.is_number()   ? page::exact(value.get<double>())
                                  : value.is_string() ? page::Text(value.get<std::string>())
                                                      : page::Text(value.dump())});
  return table;
}

page::Page compare_page(const RunData& data, std::span<const CompareRow> rows,
                        std::span<const CompareRow> tried,
                        std::span<const ReferenceTimes> reference) {
  const std::vector<CompareTable> tables = compare_tables(tried);
  const double limit = limit_of(tried);
  page::Section backends{"backends", "The backends"},
      references{"reference", "Beside the reference"}, profiles{"profiles", "Profiles"},
      matrix{"matrix", "Every case by every backend"};
  matrix.add(page::words("matrix"));
  backends.add(
      page::words("compare.explanation", {{"shift", page::quantity(1e3 * summary_shift, "ms", 1)},
                                          {"limit", page::quantity(limit, "s")}}));
  for (const CompareTable& table : tables) {
    backends.add(page::Subheading{table.heading()});
    backends.add(backends_table(table, limit, false));
    matrix.add(page::Subheading{table.heading()});
    matrix.add(matrix_table(table));
    profiles.add(profile_figures(table));
  }
  for (const ReferenceComparison& comparison : compare_with_reference(tables, reference))
    add_reference(comparison, limit, references);
  page::Page page{.title = "Solvers of frictional contact, compared", .lede = {lede(tried)}};
  if (!reference.empty() && !tried.empty() && tried[0].measure != Measure::fclib)
    page.notices.items.push_back(page::words("reference.unlike"));
  page.add(backends);
  page.add(references);
  page.add({"failures", "What must not happen", {failures_table(rows)}});
  page.add(matrix);
  page.add(profiles);
  // What the page makes by itself in the reader's browser.
  if (page::can_answer())
    for (const auto& [id, heading] : {std::pair("families", "Accuracy against cost, by family"),
                                      {"cost", "What cost depends on"},
                                      {"cases", "Case by case"},
                                      {"case-figures", "Accuracy against cost, case by case"}})
      page.add({id, heading, {page::words(id)}});
  page.add({"options", "Options", {options_table(data)}});
  if (!tried.empty()) page.answers = comparison_answers(data, tried, limit);
  return page;
}

/// In the order in which they build upon each other.
constexpr std::array modules = {"rows.js",      "statistics.js", "asks.js",      "views.js",
                                "histories.js", "details.js",    "comparison.js"};

/// Points of all histories together: what a page can hold.
constexpr size_t most_points = 25000;

/// The command of a row, as far as the options of the comparison are known; names in braces are
/// filled in by the page.
std::string again(const RunData& data, const CompareRow& row) {
  std::string command =
      "ballast compare {case} --solvers {solver} --tolerances {tolerance} --starts {start} "
      "--measure " +
      std::string(name_of(row.measure)) + printed(" --max-seconds %g", row.max_seconds);
  if (data.manifest().contains("/summary/memory_MB"_json_pointer))
    command += printed(" --memory %g", data.manifest()["summary"]["memory_MB"].get<double>());
  return command + " --output results/again";
}

/// Least error so far: seconds and error by turns, four digits each.
Json history_json(const CompareRow& row, size_t limit) {
  StepCurve best = best_so_far(row);
  thin_out(best.x, best.y, limit);
  Json flat = Json::array();
  for (size_t k = 0; k < best.x.size(); ++k)
    for (const double value : {best.x[k], best.y[k]})
      flat.push_back(parsed_number(printed("%.4g", value)).value_or(0.0));
  return flat;
}

}  // namespace

page::Table backends_table(const CompareTable& table, double limit, bool of_machines) {
  struct Column {
    const char* head;
    bool is_number, of_one_machine;
    page::Text (*text)(const BackendSummary&);
  };
  /// Nothing for what did not happen.
  static constexpr auto if_any = [](long count) {
    return count == 0 ? page::Text() : page::exact(static_cast<double>(count));
  };
  using S = const BackendSummary&;
  static const Column columns[] = {
      {"backend", false, false, [](S s) { return page::Text(s.solver); }},
      {"law", false, false, [](S s) { return page::Text(s.law); }},
      {"solved", true, false,
       [](S s) { return page::exact(s.solved) + " of " + page::exact(s.solved + s.unsolved); }},
      {"mean time", true, true, [](S s) { return time_of(s.mean_seconds); }},
      {"unsolved in it", true, true,
       [](S s) { return page::styled(if_any(s.unsolved), page::bad); }},
      {"over fastest", true, false, [](S s) { return page::number(s.mean_ratio); }},
      {"timeouts", true, false, [](S s) { return if_any(s.timeouts); }},
      {"crashes", true, false, [](S s) { return if_any(s.crashes); }},
      {"not taken", true, false, [](S s) { return if_any(s.unsupported); }},
      {"no solution", true, false, [](S s) { return if_any(s.no_solutions); }},
      {"claims denied", true, false, [](S s) { return page::styled(if_any(s.denied), page::bad); }},
      {"spread", true, true, [](S s) {
         return s.largest_spread > 0.0 ? page::quantity(100.0 * s.largest_spread, "%", 2)
                                       : page::Text();
       }}};
  page::Table result;
  for (const Column& column : columns) {
    if (of_machines && column.of_one_machine) continue;
    result.head.push_back(column.head);
    result.is_number.push_back(column.is_number);
  }
  for (const BackendSummary& summary : backend_summaries(table, limit)) {
    std::vector<page::Text>& line = result.rows.emplace_back();
    for (const Column& column : columns)
      if (!of_machines || !column.of_one_machine) line.push_back(column.text(summary));
  }
  return result;
}

page::Answers comparison_answers(const RunData& data, std::span<const CompareRow> rows,
                                 double limit) {
  Json json = {{"measure", name_of(rows[0].measure)},
               {"limit", limit},
               {"shift", summary_shift},
               {"again", again(data, rows[0])}};
  // `viewable`: cases whose bodies are known
  for (const char* name : {"columns", "rows", "viewable"}) json[name] = Json::array();
  for (const char* name : {"words", "histories"}) json[name] = Json::object();
  for (const CompareColumn& column : compare_columns())
    json["columns"].push_back({column.name, column.description});
  const size_t points = std::clamp<size_t>(most_points / rows.size(), 8, 100);
  std::set<std::string> viewable;
  for (const CompareRow& row : rows) {
    json["rows"].push_back(cells_of(row));
    json["words"][row.case_name] = shell_word(row.word.empty() ? row.case_name : row.word);
    if (row.can_view) viewable.insert(row.case_name);
    if (row.history.size() > 1) json["histories"][row.key] = history_json(row, points);
  }
  json["viewable"] = viewable;
  page::Answers answers{.are_given = true};
  answers.data = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (const char* name : modules) answers.modules.push_back(comparison_file(name));
  return answers;
}

std::string compare_summary(std::span<const CompareRow> rows,
                            std::span<const ReferenceTimes> reference) {
  std::string text;
  const double limit = limit_of(rows);
  const std::vector<CompareTable> tables = compare_tables(rows);
  for (const CompareTable& table : tables) {
    text += table.heading() + ", " + std::to_string(table.cases.size()) + " cases\n";
    for (const BackendSummary& s : backend_summaries(table, limit))
      text += printed(
          "  %-16s solved %4d   mean %10.4g ms (hides %d unsolved)   over fastest %8.3g   "
          "timeouts %d, crashes %d, not taken %d, no solution %d%s\n",
          s.solver.c_str(), s.solved, 1e3 * s.mean_seconds, s.unsolved, s.mean_ratio, s.timeouts,
          s.crashes, s.unsupported, s.no_solutions, s.denied ? "   CLAIMS DENIED" : "");
  }
  for (const ReferenceComparison& comparison : compare_with_reference(tables, reference))
    for (const double shift : mean_shifts)
      text += printed(
          "reference, tolerance %g, shift %g ms: our fastest / theirs %.3g, auto / "
          "theirs %.3g (%zu problems, %zu not solved by us)\n",
          comparison.tolerance, 1e3 * shift, comparison.ratio(shift, limit, false),
          comparison.ratio(shift, limit, true), comparison.lines.size(), comparison.missing.size());
  return text;
}

void write_compare_page(const fs::path& folder, std::span<const CompareRow> rows,
                        std::span<const ReferenceTimes> reference) {
  const RunData data = read_origin(folder);
  std::vector<CompareRow> tried;
  for (const CompareRow& row : rows)
    if (row.verdict != Verdict::unreadable) tried.push_back(row);
  write_with_origin(compare_page(data, rows, tried, reference), data, folder / "compare.html");
}

RunData read_origin(const fs::path& folder) {
  RunData data;
  data.folder = folder;
  data.manifest_text = read_whole_file(folder / "manifest.json");
  data.stored_manifest =
      std::make_shared<const Json>(Json::parse(data.manifest_text, nullptr, false));
  if (!data.manifest().is_object())
    throw Error((folder / "manifest.json").string() + ": is no JSON object");
  return data;
}

void write_with_origin(page::Page page, const RunData& data, const fs::path& file) {
  if (const std::string made = made_by(data); !made.empty()) page.lede.push_back(made);
  page.add({"provenance", "Program and machine", {provenance_table(data)}});
  page::draw_pictures(page, file.parent_path());
  page::write_html_file(file, page);
}

}  // namespace ballast
