#include "experiments/run_page/report.hpp"

#include <cmath>

#include "experiments/measure/run_data.hpp"
#include "experiments/measure/run_summary.hpp"
#include "experiments/measure/run_trust.hpp"
#include "experiments/page/drawing.hpp"
#include "experiments/page/html.hpp"
#include "experiments/page/page.hpp"
#include "experiments/run_page/figures.hpp"
#include "experiments/run_page/report_origin.hpp"
#include "experiments/run_page/report_tables.hpp"
#include "experiments/view/run_view.hpp"
#include "experiments/view/view_page.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"

namespace ballast {
namespace {

/// How much was run, and by what.
std::vector<page::Text> lede_of(const RunData& data, const RunSummary& summary) {
  page::Text extent = page::exact(static_cast<double>(summary.steps)) + " steps, " +
                      page::exact_quantity(summary.duration, "s") + " simulated";
  if (summary.contacts.samples)
    extent += ", " + page::number(summary.contacts.mean, 4) + " contact points on average";
  if (std::isfinite(summary.ms_per_step))
    extent += ", " + page::quantity(summary.ms_per_step, "ms") + " per step";
  return {extent + ".", made_by(data)};
}

void note_what_cannot_be_said(const RunSummary& summary, RunData& data) {
  const auto note = [&](const char* name) {
    data.notices.push_back(page::plain_words(page::words(std::string("run.") + name)));
  };
  if (!std::isfinite(summary.facts.velocity_scale)) note("no_gravity");
  if (*summary.facts.has_packing && summary.wall.periods.empty()) note("no_period");
}

page::Section pictures(const char* id, const char* heading,
                       const std::vector<page::Picture>& figures) {
  page::Section section{id, heading};
  section.add(figures);
  return section;
}

/// The bodies in 3D; empty where no pose is stored, or none that can be read.
page::Replay replay_of_run(RunData& data) {
  page::Replay replay;
  try {
    const std::optional<ViewData> view = view_of_run(data);
    if (!view) return {};
    replay = replay_of(*view);
  } catch (const Error& error) {
    data.notices.push_back(std::string("No replay: ") + error.what());
  }
  return replay;
}

}  // namespace

void write_report(const std::filesystem::path& folder) {
  RunData data = read_run_data(folder);
  const RunSummary summary = summarise(data.steps, data.facts);
  note_what_cannot_be_said(summary, data);
  page::Section motion{"motion", "What happens"};
  motion.add(replay_of_run(data));
  // What must be known first stands first.
  const RunTrust trust = trust_of(data);
  const std::vector<std::string> words = trust_words(trust);
  if (!trust.is_clean()) data.notices.insert(data.notices.begin(), words.begin(), words.end());
  const bool has_packing = *summary.facts.has_packing;
  page::Page page;
  page.title = name_of_run(data);
  page.lede = lede_of(data, summary);
  page.notices.heading = "To be known before reading";
  page.notices.items.assign(data.notices.begin(), data.notices.end());
  page.answers = {.are_given = true, .with_curves = true};
  page.add(std::move(motion));
  page.add({"results", "The run in numbers", {results_table(summary)}});
  page.add(pictures("paper", has_packing ? "What the paper shows" : "Motion of the wall",
                    paper_figures(data, summary)));
  page.add({"periods", "Period by period", {periods_table(summary)}});
  page.add(pictures("diagnostics", "Can it be trusted?", diagnostic_figures(data, summary)));
  page.add({"cost-table", "Cost", {cost_table(summary)}});
  page.add({"energy-table", "Energy", {energy_table(summary)}});
  page.add(
      {"parameters",
       "Parameters",
       {parameters_table(data), page::Folded{"The whole scene (scene.toml)", data.scene_text}}});
  page.add({"provenance",
            "Program and machine",
            {provenance_table(data),
             page::Folded{"The whole manifest (manifest.json)", data.manifest_text}}});
  // figures are drawn before their folder is listed
  page::draw_pictures(page, folder,
                      {.with_pdf = false,
                       .command = shell_line({own_program().string(), "report",
                                              std::filesystem::absolute(folder).string()})});
  page.add({"reproduce",
            "How to make it again",
            {page::Listing{reproduce_commands(data)}, files_table(data)}});
  page.add({"next", "What next", {page::Listing{next_commands(has_packing)}}});
  write_html_file(folder / "report.html", page);
}

}  // namespace ballast
