#include "experiments/compare/compare_html.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/text.hpp"

namespace ballast {
namespace {

Html time_of(double seconds) {
  if (!std::isfinite(seconds)) return {"<span class=\"unknown\">–</span>"};
  return seconds < 1.0 ? quantity(1e3 * seconds, "ms") : quantity(seconds, "s");
}

Html count(long value) { return value == 0 ? Html{""} : exact(static_cast<double>(value)); }

/// The row that came nearest to the tolerance, of all backends; null when none gave an answer.
const CompareRow* nearest(const std::vector<CompareCell>& line) {
  const CompareRow* best = nullptr;
  for (const CompareCell& cell : line)
    if (cell.row && std::isfinite(cell.row->error) && (!best || cell.row->error < best->error))
      best = cell.row;
  return best;
}

Html names(const std::vector<std::string>& list) { return escaped(joined(list)); }

}  // namespace

double limit_of(std::span<const CompareRow> rows) {
  double limit = 0.0;
  for (const CompareRow& row : rows) limit = std::max(limit, row.max_seconds);
  return limit;
}

std::vector<BackendSummary> backend_summaries(const CompareTable& table, double limit) {
  constexpr double shift = 1e-3;
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
      summary.timeouts += cell.row->outcome == Outcome::timeout;
      summary.crashes +=
          cell.row->outcome == Outcome::crashed || cell.row->outcome == Outcome::out_of_memory;
      summary.unsupported += cell.row->outcome == Outcome::unsupported;
      summary.false_successes += cell.row->is_false_success();
      if (cell.solved && cell.median > 0.0)
        summary.largest_spread =
            std::max(summary.largest_spread, (cell.slowest - cell.fastest) / cell.median);
      times.push_back(std::min(cell.median, limit));
      if (std::isinf(table.fastest(c))) continue;
      ratios_of.push_back(times.back());
      best.push_back(table.fastest(c));
    }
    summary.mean_seconds = shifted_geometric_mean(times, shift);
    summary.mean_ratio =
        best.empty() ? std::nan("") : shifted_geometric_ratio(ratios_of, best, shift);
    summaries.push_back(std::move(summary));
  }
  std::stable_sort(
      summaries.begin(), summaries.end(), [](const BackendSummary& a, const BackendSummary& b) {
        return a.solved != b.solved ? a.solved > b.solved : a.mean_seconds < b.mean_seconds;
      });
  return summaries;
}

Html backends_html(const CompareTable& table, double limit) {
  HtmlTable html;
  html.head = {{"backend"},       {"law"},     {"solved"},    {"mean time"},     {"over fastest"},
               {"time&shy;outs"}, {"crashes"}, {"not taken"}, {"claims denied"}, {"spread"}};
  html.is_number = {false, false, true, true, true, true, true, true, true, true};
  for (const BackendSummary& s : backend_summaries(table, limit))
    html.rows.push_back(
        {escaped(s.solver), escaped(s.law),
         exact(s.solved) + Html{" of "} + exact(static_cast<double>(table.cases.size())),
         time_of(s.mean_seconds), number(s.mean_ratio), count(s.timeouts), count(s.crashes),
         count(s.unsupported),
         s.false_successes
             ? Html{"<span class=\"missed\">"} + exact(s.false_successes) + Html{"</span>"}
             : Html{""},
         s.largest_spread > 0.0 ? quantity(100.0 * s.largest_spread, "%", 2) : Html{""}});
  return to_html(html);
}

Html cases_html(const CompareTable& table) {
  HtmlTable html;
  html.head = {{"case"}, {"contacts"}, {"solved by"},    {"fastest"},
               {"time"}, {"error"},    {"worst contact"}};
  html.is_number = {false, true, true, false, true, true, false};
  for (size_t c = 0; c < table.cases.size(); ++c) {
    const std::vector<CompareCell>& line = table.cells[c];
    const double best = table.fastest(c);
    const CompareRow* row = nullptr;
    for (const CompareCell& cell : line)
      if (cell.solved && cell.median == best) row = cell.row;
    const bool is_solved = row != nullptr;
    if (!row) row = nearest(line);
    const long solvers = std::count_if(line.begin(), line.end(),
                                       [](const CompareCell& cell) { return cell.solved; });
    const CompareCell& any = *std::find_if(
        line.begin(), line.end(), [](const CompareCell& cell) { return cell.row != nullptr; });
    html.rows.push_back(
        {escaped(table.cases[c]), exact(any.row->facts.contacts),
         is_solved ? exact(static_cast<double>(solvers))
                   : Html{"<span class=\"missed\">none</span>"},
         row ? escaped(is_solved ? row->solver : "nearest: " + row->solver) : Html{""},
         row ? time_of(is_solved ? best : row->seconds()) : Html{""},
         row ? number(row->error, 2) : Html{""}, row ? escaped(row->worst) : Html{""}});
  }
  return to_html(html);
}

Html failures_html(std::span<const CompareRow> rows) {
  HtmlTable html;
  html.head = {{"case"}, {"backend"}, {"tolerance"}, {"what happened"}, {"error"}};
  html.is_number = {false, false, true, false, true};
  for (const CompareRow& row : rows) {
    const bool died = row.outcome == Outcome::crashed || row.outcome == Outcome::out_of_memory;
    if (!died && !row.is_false_success() && (row.note.empty() || row.outcome != Outcome::stopped))
      continue;
    const std::string what = row.is_false_success() ? "claims success, the judge denies it"
                                                    : std::string(name_of(row.outcome)) +
                                                          (row.note.empty() ? "" : ": " + row.note);
    html.rows.push_back({escaped(row.case_name), escaped(row.solver), exact(row.tolerance),
                         escaped(what), number(row.error, 2)});
  }
  return html.rows.empty() ? Html{} : to_html(html);
}

Html reference_html(const ReferenceComparison& comparison, double limit) {
  HtmlTable ratios;
  ratios.head = {
      {"shift of the mean"}, {"our fastest over theirs"}, {"<code>auto</code> over theirs"}};
  ratios.is_number = {true, true, true};
  for (const double shift : mean_shifts)
    ratios.rows.push_back({quantity(1e3 * shift, "ms"),
                           number(comparison.ratio(shift, limit, false)),
                           number(comparison.ratio(shift, limit, true))});
  HtmlTable lines;
  lines.head = {{"case"}, {"theirs"}, {"by"}, {"ours"}, {"by"}, {"ratio"}, {"<code>auto</code>"},
                {"ratio"}};
  lines.is_number = {false, true, false, true, false, true, true, true};
  for (const ReferenceComparison::Line& line : comparison.lines) {
    const auto ratio = [&](double ours) {
      return line.theirs > 0.0 ? number(ours / line.theirs) : Html{""};
    };
    lines.rows.push_back({escaped(line.case_name), time_of(line.theirs), escaped(line.their_solver),
                          time_of(line.ours), escaped(line.our_solver), ratio(line.ours),
                          time_of(line.automatic), ratio(line.automatic)});
  }
  Html html =
      Html{"<h3>Tolerance "} + exact(comparison.tolerance) + Html{"</h3>\n"} + to_html(ratios);
  html += Html{"<p>Shifted geometric means over "} +
          exact(static_cast<double>(comparison.lines.size())) +
          Html{" problems that the reference solved; one that we did not solve counts with "} +
          quantity(limit, "s") + Html{".</p>\n"};
  if (!comparison.missing.empty())
    html += Html{"<p><span class=\"missed\">Not solved by us:</span> "} +
            names(comparison.missing) + Html{".</p>\n"};
  if (!comparison.only_ours.empty())
    html += Html{"<p>Solved by us alone: "} + names(comparison.only_ours) + Html{".</p>\n"};
  return html + to_html(lines);
}

}  // namespace ballast
