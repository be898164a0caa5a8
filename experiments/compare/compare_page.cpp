#include "experiments/compare/compare_page.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/compare/compare_html.hpp"
#include "experiments/compare/page_drawing.hpp"
#include "experiments/page/html.hpp"
#include "experiments/run_page/report_origin.hpp"
#include "platform/atomic_file.hpp"
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

std::string heading_of(const CompareTable& table) {
  return printed("Tolerance %g, %s start", table.tolerance, name_of(table.start));
}

Html header(std::span<const CompareRow> rows, const RunData& data) {
  const size_t cases = names_in(rows, [](const CompareRow& r) { return r.case_name; }).size();
  const size_t solvers = names_in(rows, [](const CompareRow& r) { return r.solver; }).size();
  Html html =
      Html{"<header>\n<h1>Solvers of frictional contact, compared</h1>\n<p class=\"lede\">"} +
      exact(static_cast<double>(solvers)) + Html{" backends on "} +
      exact(static_cast<double>(cases)) + Html{" problems, "} +
      exact(static_cast<double>(rows.size())) + Html{" solves. Measure: "} +
      escaped(rows.empty() ? "" : name_of(rows[0].measure)) + Html{".</p>\n"};
  if (const std::string made = made_by(data); !made.empty())
    html += Html{"<p class=\"lede\">"} + escaped(made) + Html{"</p>\n"};
  return html + Html{"</header>\n"};
}

Html explanation(double limit) {
  return Html{
             "<p><i>Solved</i>: the backend says so, and the judge, outside the backend’s process "
             "and from the impulses alone, agrees. Times are of prepare and solve, "
             "medians over repeats. <i>Mean time</i>: shifted geometric mean over all cases (shift "
             "1&#8239;ms); what was not solved counts with "} +
         quantity(limit, "s") +
         Html{". <i>Over fastest</i>: the same of the time over the fastest backend’s.</p>\n"};
}

Html options_table(const RunData& data) {
  HtmlTable table;
  table.css_class = "facts";
  if (const auto summary = data.manifest.find("summary"); summary != data.manifest.end())
    for (const auto& [name, value] : summary->items())
      table.rows.push_back(
          {escaped(name), value.is_number() ? exact(value.get<double>())
                                            : escaped(value.is_string() ? value.get<std::string>()
                                                                        : value.dump())});
  return to_html(table);
}

Html case_figures(std::span<const CompareRow> rows, PageDrawing& drawing) {
  Html html;
  for (const StartKind start : starts_in(rows))
    for (const std::string& name : names_in(rows, [](const CompareRow& r) { return r.case_name; }))
      html += drawing.draw(work_precision_figure(rows, name, start));
  return html;
}

Html family_figures(std::span<const CompareRow> rows, PageDrawing& drawing) {
  Html html;
  for (const StartKind start : starts_in(rows))
    for (const std::string& name : names_in(rows, [](const CompareRow& r) { return r.family; }))
      html += drawing.draw(family_figure(rows, name, start));
  return html;
}

}  // namespace

void write_compare_page(const fs::path& folder, std::span<const CompareRow> rows,
                        std::span<const ReferenceTimes> reference) {
  const RunData data = read_provenance(folder);
  const std::vector<CompareTable> tables = compare_tables(rows);
  const double limit = limit_of(rows);
  PageDrawing drawing(folder / "figures");
  Html overview = explanation(limit), profiles, costs, per_case, references;
  for (const CompareTable& table : tables) {
    const Html heading = Html{"<h3>"} + escaped(heading_of(table)) + Html{"</h3>\n"};
    overview += heading + backends_html(table, limit);
    per_case += heading + cases_html(table);
    profiles += drawing.draw(profile_figures(table));
    costs += drawing.draw(cost_figures(table));
  }
  if (!reference.empty() && !rows.empty() && rows[0].measure != Measure::fclib)
    drawing.notices.push_back(
        "The reference's times are to the measure fclib, this comparison's are not: their ratio "
        "compares unlike things.");
  for (const ReferenceComparison& comparison : compare_with_reference(tables, reference))
    references += reference_html(comparison, limit);
  const Html families = family_figures(rows, drawing), cases = case_figures(rows, drawing);
  Html body = header(rows, data) + drawing.notices_html();
  body += section("backends", "The backends", overview);
  body += section("reference", "Beside the reference", references);
  body += section("failures", "What must not happen", failures_html(rows));
  body += section("profiles", "Profiles", profiles);
  body += section("families", "Accuracy against cost, by family", families);
  body += section("cost", "What cost depends on", costs);
  body += section("cases", "Case by case", per_case);
  body += section("case-figures", "Accuracy against cost, case by case", cases);
  body += section("options", "Options", options_table(data));
  body += section("provenance", "Program and machine",
                  Html{page::html_of(page::Block(provenance_table(data)))});
  write_whole_file(folder / "compare.html",
                   html_page("Solvers of frictional contact, compared", body));
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
          "  %-16s solved %4d   mean %10.4g ms   over fastest %8.3g   timeouts %d, "
          "crashes %d, not taken %d%s\n",
          s.solver.c_str(), s.solved, 1e3 * s.mean_seconds, s.mean_ratio, s.timeouts, s.crashes,
          s.unsupported, s.false_successes ? "   CLAIMS DENIED" : "");
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
