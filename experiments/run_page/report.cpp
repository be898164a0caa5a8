#include "experiments/run_page/report.hpp"

#include <cmath>

#include "experiments/measure/run_data.hpp"
#include "experiments/measure/run_summary.hpp"
#include "experiments/page/html_page.hpp"
#include "experiments/page/plot.hpp"
#include "experiments/run_page/figures.hpp"
#include "experiments/run_page/report_origin.hpp"
#include "experiments/run_page/report_tables.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

std::string name_of_run(const RunData& data) {
  if (data.scene && !data.scene->title.empty()) return data.scene->title;
  const auto scene = data.manifest.find("scene");
  if (scene != data.manifest.end() && scene->is_string()) return scene->get<std::string>();
  return data.folder.filename().string();
}

/// Draws what can be drawn; what cannot becomes a notice.
Html draw(const std::vector<ReportFigure>& figures, RunData& data) {
  Html html;
  for (const ReportFigure& figure : figures) {
    try {
      const std::string svg = render_svg(figure.plot, data.folder / "figures");
      html += html_figure(figure.plot.name, inline_svg(svg, figure.plot.name, figure.plot.title),
                          figure.caption);
    } catch (const Error& error) {
      data.notices.push_back(std::string(error.what()) + ". The figure is left out.");
    }
  }
  return html;
}

Html header(const RunData& data, const RunSummary& summary) {
  Html html{"<header>\n<h1>"};
  html += escaped(name_of_run(data)) + Html{"</h1>\n<p class=\"lede\">"} +
          exact(static_cast<double>(summary.steps)) + Html{" steps, "} + exact(summary.duration) +
          Html{"&#8239;s"} + Html{" simulated"};
  if (summary.contacts.samples)
    html += Html{", "} + number(summary.contacts.mean, 4) + Html{" contact points on average"};
  if (std::isfinite(summary.ms_per_step))
    html += Html{", "} + quantity(summary.ms_per_step, "ms") + Html{" per step"};
  html += {".</p>\n"};
  if (const std::string made = made_by(data); !made.empty())
    html += Html{"<p class=\"lede\">"} + escaped(made) + Html{"</p>\n"};
  return html + Html{"</header>\n"};
}

Html notices(const RunData& data) {
  if (data.notices.empty()) return {};
  Html html{"<div class=\"notices\" role=\"note\"><b>To be known before reading</b><ul>\n"};
  for (const std::string& notice : data.notices)
    html += Html{"<li>"} + escaped(notice) + Html{"</li>\n"};
  return html + Html{"</ul></div>\n"};
}

Html folded(const char* name, const std::string& text) {
  if (text.empty()) return {};
  return Html{std::string("<details><summary>") + name + "</summary>\n<pre>"} + escaped(text) +
         Html{"</pre></details>\n"};
}

Html section(const char* id, const char* heading, const Html& body) {
  return body.markup.empty() ? Html{} : html_section(id, {heading}, body);
}

void note_what_cannot_be_said(const RunSummary& summary, RunData& data) {
  if (!std::isfinite(summary.facts.velocity_scale))
    data.notices.push_back(
        "Gravity is in neither manifest.json nor scene.toml: errors are given in m/s, not relative "
        "to g h.");
  if (*summary.facts.has_packing && summary.wall.periods.empty())
    data.notices.push_back(
        "There is no whole period of the load after the first 0.2 s: no loop f_g(x), jammed state "
        "or gain per period.");
}

}  // namespace

void write_report(const std::filesystem::path& folder) {
  RunData data = read_run_data(folder);
  const RunSummary summary = summarise(data.steps, data.facts);
  note_what_cannot_be_said(summary, data);
  Html paper, diagnostics;
  if (!gnuplot_version().empty()) {
    paper = draw(paper_figures(data, summary), data);
    diagnostics = draw(diagnostic_figures(data, summary), data);
  } else {
    data.notices.push_back(
        "gnuplot was not found: this page has no figures. With gnuplot installed, \"ballast "
        "report\" makes them.");
  }
  Html body = header(data, summary) + notices(data);
  body += section("results", "The run in numbers", results_table(data, summary));
  body += section(
      "paper", *summary.facts.has_packing ? "What the paper shows" : "Motion of the wall", paper);
  body += section("periods", "Period by period", periods_table(summary));
  body += section("diagnostics", "Can it be trusted?", diagnostics);
  body += section("cost-table", "Cost", cost_table(summary));
  body += section("energy-table", "Energy", energy_table(summary));
  body += section("parameters", "Parameters",
                  parameters_table(data) + folded("The whole scene (scene.toml)", data.scene_text));
  body += section(
      "provenance", "Program and machine",
      provenance_table(data) + folded("The whole manifest (manifest.json)", data.manifest_text));
  body += section(
      "reproduce", "How to make it again",
      Html{"<pre>"} + escaped(reproduce_commands(data)) + Html{"</pre>\n"} + files_table(data));
  body += section(
      "next", "What next",
      Html{"<pre>"} + escaped(next_commands(*summary.facts.has_packing)) + Html{"</pre>\n"});
  write_whole_file(folder / "report.html", html_page(name_of_run(data), body));
}

}  // namespace ballast
