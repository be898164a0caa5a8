#include "experiments/compare/compare_page.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/compare/backend_summary.hpp"
#include "experiments/compare/compare_answers.hpp"
#include "experiments/compare/compare_figures.hpp"
#include "experiments/compare/outcome_tables.hpp"
#include "experiments/compare/page_origin.hpp"
#include "experiments/page/html.hpp"
#include "experiments/page/page.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

template <typename Name>
std::vector<std::string> names_in(std::span<const CompareRow> rows, Name&& name_of_row) {
  std::vector<std::string> names;
  for (const CompareRow& row : rows)
    if (std::find(names.begin(), names.end(), name_of_row(row)) == names.end())
      names.push_back(name_of_row(row));
  return names;
}

std::vector<StartKind> starts_in(std::span<const CompareRow> rows) {
  std::vector<StartKind> starts;
  for (const StartKind start : {StartKind::cold, StartKind::warm})
    if (std::any_of(rows.begin(), rows.end(),
                    [&](const CompareRow& row) { return row.start == start; }))
      starts.push_back(start);
  return starts;
}

page::Text count_of(size_t count) { return page::exact(static_cast<double>(count)); }

/// Nothing for what did not happen.
page::Text if_any(long count) {
  return count == 0 ? page::Text() : page::exact(static_cast<double>(count));
}

page::Table backends_table(const CompareTable& table, double limit) {
  page::Table result;
  result.head = {"backend",        "law",          "solved",        "mean time",
                 "unsolved in it", "over fastest", "timeouts",      "crashes",
                 "not taken",      "no solution",  "claims denied", "spread"};
  result.is_number = {false, false, true, true, true, true, true, true, true, true, true, true};
  for (const BackendSummary& s : backend_summaries(table, limit))
    result.rows.push_back(
        {s.solver, s.law, page::exact(s.solved) + " of " + count_of(table.cases.size()),
         time_of(s.mean_seconds), page::styled(if_any(s.unsolved), page::bad),
         page::number(s.mean_ratio), if_any(s.timeouts), if_any(s.crashes), if_any(s.unsupported),
         if_any(s.no_solutions), page::styled(if_any(s.false_successes), page::bad),
         s.largest_spread > 0.0 ? page::quantity(100.0 * s.largest_spread, "%", 2) : page::Text()});
  return result;
}

/// The row that came nearest to the tolerance, of all backends; null when none gave an answer.
const CompareRow* nearest(const std::vector<CompareCell>& line) {
  const CompareRow* best = nullptr;
  for (const CompareCell& cell : line)
    if (cell.row && std::isfinite(cell.row->error) && (!best || cell.row->error < best->error))
      best = cell.row;
  return best;
}

/// Case by case: fastest backend, its time and error, or how near anybody came; the worst contact
/// by name.
page::Table cases_table(const CompareTable& table) {
  page::Table result;
  result.head = {"case", "contacts", "solved by", "fastest", "time", "error", "worst contact"};
  result.is_number = {false, true, true, false, true, true, false};
  for (size_t c = 0; c < table.cases.size(); ++c) {
    const std::vector<CompareCell>& line = table.cells[c];
    const double best = table.fastest(c);
    const CompareRow *row = nullptr, *any = nullptr;
    long solvers = 0;
    for (const CompareCell& cell : line) {
      if (!any) any = cell.row;
      solvers += cell.solved;
      if (cell.solved && cell.median == best) row = cell.row;
    }
    const bool is_solved = row != nullptr;
    if (!row) row = nearest(line);
    std::vector<page::Text> cells = {
        table.cases[c], page::exact(any->facts.contacts),
        is_solved ? page::exact(static_cast<double>(solvers)) : page::Text("none", page::bad)};
    if (row)
      cells.insert(cells.end(), {is_solved ? row->solver : "nearest: " + row->solver,
                                 time_of(is_solved ? best : row->seconds()),
                                 page::number(row->error, 2), row->worst});
    cells.resize(result.head.size());
    result.rows.push_back(std::move(cells));
  }
  return result;
}

page::Table ratios_table(const ReferenceComparison& comparison, double limit) {
  page::Table ratios;
  ratios.head = {"shift of the mean", "our fastest over theirs",
                 page::marked("`auto` over theirs")};
  ratios.is_number = {true, true, true};
  for (const double shift : mean_shifts)
    ratios.rows.push_back({page::quantity(1e3 * shift, "ms"),
                           page::number(comparison.ratio(shift, limit, false)),
                           page::number(comparison.ratio(shift, limit, true))});
  return ratios;
}

page::Table reference_lines(const ReferenceComparison& comparison) {
  page::Table lines;
  lines.head = {"case", "theirs", "by", "ours", "by", "ratio", page::Text("auto", page::code),
                "ratio"};
  lines.is_number = {false, true, false, true, false, true, true, true};
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
  const auto count = [&](const auto& name) { return count_of(names_in(rows, name).size()); };
  return page::words("compare.lede",
                     {{"solvers", count([](const CompareRow& r) { return r.solver; })},
                      {"problems", count([](const CompareRow& r) { return r.case_name; })},
                      {"solves", count_of(rows.size())},
                      {"measure", rows.empty() ? "" : name_of(rows[0].measure)}});
}

/// Where the page draws a figure by itself, a link to its file is enough.
void add_or_link(page::Picture picture, page::Section& section) {
  picture.is_linked = page::can_answer();
  section.add(std::move(picture));
}

page::Page compare_page(const RunData& data, std::span<const CompareRow> rows,
                        std::span<const CompareRow> unreadable,
                        std::span<const ReferenceTimes> reference) {
  const std::vector<CompareTable> tables = compare_tables(rows);
  const double limit = limit_of(rows);
  page::Section backends{"backends", "The backends"},
      references{"reference", "Beside the reference"}, profiles{"profiles", "Profiles"},
      families{"families", "Accuracy against cost, by family"},
      costs{"cost", "What cost depends on"}, cases{"cases", "Case by case"},
      matrix{"matrix", "Every case by every backend"},
      case_figures{"case-figures", "Accuracy against cost, case by case"};
  matrix.add(page::words("matrix"));
  backends.add(
      page::words("compare.explanation", {{"shift", page::quantity(1e3 * summary_shift, "ms", 1)},
                                          {"limit", page::quantity(limit, "s")}}));
  for (const CompareTable& table : tables) {
    backends.add(page::Subheading{heading_of(table)});
    backends.add(backends_table(table, limit));
    matrix.add(page::Subheading{heading_of(table)});
    matrix.add(matrix_table(table));
    cases.add(page::Subheading{heading_of(table)});
    cases.add(cases_table(table));
    profiles.add(profile_figures(table));
    for (page::Picture& figure : cost_figures(table)) add_or_link(std::move(figure), costs);
  }
  for (const ReferenceComparison& comparison : compare_with_reference(tables, reference))
    add_reference(comparison, limit, references);
  for (const StartKind start : starts_in(rows)) {
    for (const std::string& name : names_in(rows, [](const CompareRow& r) { return r.family; }))
      add_or_link(family_figure(rows, name, start), families);
    for (const std::string& name : names_in(rows, [](const CompareRow& r) { return r.case_name; }))
      add_or_link(work_precision_figure(rows, name, start), case_figures);
  }
  page::Page page{.title = "Solvers of frictional contact, compared", .lede = {lede(rows)}};
  if (!reference.empty() && !rows.empty() && rows[0].measure != Measure::fclib)
    page.notices.items.push_back(page::words("reference.unlike"));
  if (!unreadable.empty())
    page.add({"unreadable", "Cases that could not be read", {unreadable_table(unreadable)}});
  page.add(backends);
  page.add(references);
  page.add({"failures", "What must not happen", {failures_table(rows)}});
  for (const page::Section& section : {matrix, profiles, families, costs, cases, case_figures})
    page.add(section);
  page.add({"options", "Options", {options_table(data)}});
  if (!rows.empty()) page.answers = comparison_answers(data, rows, limit);
  return page;
}

}  // namespace

void write_compare_page(const fs::path& folder, std::span<const CompareRow> rows,
                        std::span<const ReferenceTimes> reference) {
  const RunData data = read_origin(folder);
  std::vector<CompareRow> tried, unreadable;
  for (const CompareRow& row : rows)
    (row.verdict == Verdict::unreadable ? unreadable : tried).push_back(row);
  write_with_origin(compare_page(data, tried, unreadable, reference), data,
                    folder / "compare.html");
}

}  // namespace ballast
