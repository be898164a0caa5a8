#include "experiments/run_page/report.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "experiments/run_page/figures.hpp"
#include "experiments/view/view.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

using Json = nlohmann::ordered_json;

/// Makes a table of results: quantity | this run | bound or paper | verdict
class Results {
 public:
  /// Begins a group. Its name stands above its first row; a group without rows is left out.
  void group(const char* name) { group_ = name; }
  /// Adds a value with its bound, or without one where the bound is not known.
  void bounded(const std::string& what, double value, double bound, const char* unit = "",
               double factor = 1.0) {
    if (!std::isfinite(bound)) return plain(what, page::quantity(factor * value, unit));
    row(page::marked(what), page::quantity(factor * value, unit),
        "≤\u00a0" + page::exact_quantity(factor * bound, unit), page::verdict(value, bound));
  }
  void compared(const char* what, page::Text value, page::Text paper) {
    row(page::marked(what), std::move(value), std::move(paper), {"paper", page::note});
  }
  void plain(const std::string& what, page::Text value, page::Text remark = {}) {
    row(page::marked(what), std::move(value), {}, std::move(remark));
  }

  /// `has_paper`: for the vibrated box, of which the paper's values are known.
  page::Table table(bool has_paper) {
    table_.head = {"", "this run", has_paper ? "asked, or paper" : "asked", ""};
    table_.is_number = {false, true, true, false};
    return std::move(table_);
  }

 private:
  void row(page::Text what, page::Text value, page::Text bound, page::Text mark) {
    // a value that is not known of this run takes no row
    const std::string words = plain_words(value);
    if (words.find_first_not_of("–, ") == std::string::npos) return;
    if (!group_.empty())
      table_.rows.push_back({styled(page::marked(group_), page::strong), {}, {}, {}});
    group_.clear();
    table_.rows.push_back({std::move(what), std::move(value), std::move(bound), std::move(mark)});
  }
  page::Table table_;
  std::string group_;
};

page::Text range_of(const Statistics& values, double factor, const char* unit) {
  const page::Text mean = page::quantity(factor * values.mean, unit);
  if (values.samples < 2) return mean;
  const auto [least, largest] = std::minmax({factor * values.min, factor * values.max});
  return mean + " " +
         styled("(" + page::number(least) + " … " + page::number(largest) + ")", page::note);
}

void add_accuracy(const RunSummary& summary, Results& results) {
  // errors are judged by the tolerance that the scene asks of each step
  const double tolerance = summary.facts.tolerance;
  const char* unit = error_unit(summary);
  results.group("Contact law");
  results.bounded(printed("error, rms over contacts (%s): mean of the steps", unit),
                  summary.error_mean_relative, tolerance);
  results.bounded("the same: worst step", summary.error_max_relative, tolerance);
  results.plain(printed("worst contact of all steps (%s)", unit),
                page::number(summary.error_max.max / summary.facts.velocity_scale));
  if (tolerance > 0.0)
    results.plain(
        "steps that missed the tolerance",
        page::quantity(
            100.0 * static_cast<double>(summary.missed) / static_cast<double>(summary.steps), "%"));
  // these bounds are the vibrated box's: they suit the size of its grains and its drive
  const double known = summary.facts.has_packing ? 1.0 : not_known;
  results.group("Overlap");
  results.bounded("deepest of all steps", summary.penetration_max, known * target::penetration_max,
                  "µm", 1e6);
  results.bounded("mean over active contact points and steps", summary.penetration_mean,
                  known * target::penetration_mean, "µm", 1e6);
  results.group("Energy");
  results.plain("|Δ*K* − works + dissipation| over absolute work",
                page::number(summary.energy.relative));
}

void add_wall(const RunSummary& summary, Results& results) {
  const JammedState& jammed = summary.jammed;
  results.group("Jammed state (*f* above its mean)");
  results.bounded("|*f*~g~ − *f*|/*f*~max~, mean of the steps", jammed.force_mean,
                  target::jammed_force);
  results.plain("the same: 95\u202f% of the steps below, worst step",
                page::number(jammed.force_p95) + ", " + page::number(jammed.force_max));
  results.plain(
      "|*v*|: mean, largest",
      page::quantity(1e3 * jammed.speed_mean, "mm/s") + ", " +
          page::quantity(1e3 * jammed.speed_max, "mm/s"),
      styled("moving phases, smoothed: up to " + page::quantity(1e3 * summary.wall.v_peak, "mm/s"),
             page::note));
  if (!summary.wall.periods.empty())
    results.plain("jammed stretch found in", page::exact(summary.wall.jammed_periods) + " of " +
                                                 page::exact(summary.wall.periods.size()) +
                                                 " periods");
  results.group("Motion of the wall");
  results.plain("first contraction", page::quantity(1e3 * summary.contraction.size, "mm"));
  results.compared("90\u202f% of it reached at", page::quantity(summary.contraction.time90, "s"),
                   "~\u00a00.2\u202fs");
  results.plain("Δ*x*~max~ per period: mean (least … largest)", range_of(summary.rise, 1e3, "mm"));
  results.plain("contraction per period", range_of(summary.net, -1e3, "mm"));
  results.plain("*v*~max~ inwards", range_of(summary.speed_in, 1e3, "mm/s"));
  results.compared("*C* of Eq. 3, *m* the mass of all grains", page::number(summary.prefactor),
                   "~\u00a0" + page::number(paper::prefactor, 1));
  results.plain("exponential fit, active: *R*², length",
                page::number(summary.law.active.r2) + ", " +
                    page::quantity(1e3 / summary.law.active.rate, "mm"));
  results.plain("linear fit, passive: *R*², slope",
                page::number(summary.law.passive.r2) + ", " +
                    page::quantity(1e-3 * summary.law.passive.slope, "N/mm"));
}

void add_compaction(const RunSummary& summary, Results& results) {
  const Compaction& compaction = summary.compaction;
  results.group("Solid fraction");
  results.compared("before the drive", page::number(summary.facts.solid_fraction_initial, 4),
                   page::number(paper::solid_fraction_initial, 2));
  results.compared("ρ~0~, at 0.2\u202fs", page::number(compaction.reference, 4),
                   page::number(paper::solid_fraction_reference, 2));
  results.plain("at the end", page::number(compaction.last, 4));
  results.compared("gain per period over ρ~0~", page::number(compaction.relative_gain),
                   "~\u00a0" + page::number(paper::gain_per_period, 2));
  results.plain("compaction rate (Eq. 4)", page::quantity(compaction.rate, "1/s"));
}

page::Table cost_table(const RunSummary& summary) {
  page::Table table{.head = {"phase", "ms per step", "%"}, .is_number = {false, true, true}};
  for (const PhaseCost& phase : summary.cost)
    table.rows.push_back({phase.name, page::number(phase.ms_per_step),
                          page::number(100.0 * phase.ms_per_step / summary.ms_per_step)});
  table.rows.push_back({page::Text("all", page::strong), page::number(summary.ms_per_step),
                        page::number(summary.ms_per_step > 0.0 ? 100.0 : not_known)});
  return table;
}

/// Lists and objects on one line, without JSON's quotes and braces.
std::string readable(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_structured()) return value.dump();
  std::string text;
  for (const auto& [name, part] : value.items())
    add_to_list(text, (value.is_object() ? name + ' ' : std::string()) + readable(part));
  return text;
}

/// The value in the manifest at "/group/name", as words; empty when there is none.
std::string text_at(const RunData& data, const char* where) {
  const Json::json_pointer at(where);
  if (!data.manifest().contains(at) || data.manifest()[at].is_null()) return {};
  return readable(data.manifest()[at]);
}

/// "", or what is to be said behind the commit of a program whose sources were modified.
const char* modified_words(const RunData& data) {
  return text_at(data, "/ballast/modified") == "true" ? ", modified" : "";
}

/// The scene's title, else its name, else the folder's name.
std::string name_of_run(const RunData& data) {
  if (data.scene && !data.scene->title.empty()) return data.scene->title;
  const auto scene = data.manifest().find("scene");
  if (scene != data.manifest().end() && scene->is_string()) return scene->get<std::string>();
  return data.folder.filename().string();
}

/// The bodies in 3D; empty where no pose is stored, or none can be read.
page::Replay replay_of_run(RunData& data) {
  try {
    if (const std::optional<ViewData> view = view_of_run(data)) return replay_of(*view);
  } catch (const Error& error) {
    data.notices.push_back(std::string("No replay: ") + error.what());
  }
  return {};
}

}  // namespace

page::Table results_table(const RunSummary& summary) {
  Results results;
  add_accuracy(summary, results);
  if (summary.facts.has_wall && summary.facts.has_packing) add_wall(summary, results);
  if (summary.facts.has_packing) add_compaction(summary, results);
  results.group("Effort");
  results.plain("iterations per step: mean, most",
                page::number(summary.iterations.mean) + ", " + page::exact(summary.iterations.max));
  results.plain("contact points per step: mean, most",
                page::number(summary.contacts.mean, 4) + ", " + page::exact(summary.contacts.max));
  results.plain("wall clock per step", page::quantity(summary.ms_per_step, "ms"));
  return results.table(summary.facts.has_packing);
}

page::Table periods_table(const RunSummary& summary) {
  page::Table table;
  for (const char* head :
       {"period", "from\n(s)", "to\n(s)", "Δ*x*~max~\n(mm)", "contraction\n(mm)",
        "*v*~max~ in\n(mm/s)", "*v* out\n(mm/s)", "jammed\n(%)", "ρ,\nmean", "gain\nof ρ"})
    table.head.push_back(page::marked(head));
  const size_t columns = summary.facts.has_packing ? 10 : 8;  // the last two describe the packing
  table.is_number.assign(columns, true);
  double before = not_known;
  for (const WallPeriod& period : summary.wall.periods) {
    table.rows.push_back(
        {page::exact(std::round(period.end * summary.facts.frequency)),
         page::exact(period.begin, 4), page::exact(period.end, 4), page::number(1e3 * period.rise),
         page::number(-1e3 * period.net), page::number(1e3 * period.speed_in),
         page::number(1e3 * period.speed_out), page::number(100.0 * period.jammed_share),
         page::number(period.solid_fraction, 5), page::number(period.solid_fraction - before, 2)});
    table.rows.back().resize(columns);
    before = period.solid_fraction;
  }
  table.head.resize(columns);
  return table;
}

page::Table provenance_table(const RunData& data) {
  page::Table table{.is_facts = true};
  const auto add = [&](std::string what, const Json& value) {
    std::ranges::replace(what, '_', ' ');
    const std::string words = value.is_null() ? "" : readable(value);
    if (!words.empty()) table.rows.push_back({what, words});
  };
  for (const char* group : {"ballast", "machine"}) {
    const Json facts = data.manifest().value(group, Json::object());
    for (const auto& [name, value] : facts.items()) add(name, value);
  }
  for (const char* name : {"started", "key", "resumed"})
    add(name, data.manifest().value(name, Json()));
  return table;
}

std::string made_by(const RunData& data) {
  std::string text;
  const auto add = [&](const std::string& before, const std::string& part) {
    if (!part.empty()) add_to_list(text, before + part);
  };
  add("ballast ", text_at(data, "/ballast/version"));
  add("commit ", text_at(data, "/ballast/commit").substr(0, 12) + modified_words(data));
  add("", text_at(data, "/machine/cpu"));
  add("started ", text_at(data, "/started"));
  return text;
}

std::string reproduce_commands(const RunData& data) {
  std::string text;
  const std::string commit = text_at(data, "/ballast/commit");
  if (!commit.empty() && commit != "unknown")
    text += "# the program of commit " + commit + modified_words(data) + " made it\n";
  if (data.scene_text.empty()) return text;
  // The resolved scene has all settings; its name and the --set of the command line have not.
  const std::filesystem::path folder =
      std::filesystem::absolute(data.folder / "scene.toml").lexically_normal().parent_path();
  return text +
         shell_line({executable_path().string(), "run", (folder / "scene.toml").string(),
                     "--output", folder.string() + "-again"}) +
         '\n';
}

std::string next_commands(bool has_grains) {
  const std::string program = shell_quoted(executable_path().string()) + ' ';
  std::string text;
  if (has_grains)
    text += "# another frequency, other grains; every key of a scene: docs/manual/scenes.md\n" +
            program +
            "run vibrated_box --set drive.frequency=10 --set grains.seed=2 --output results/10Hz\n"
            "# one figure of the paper with all its runs (each made once); what they cost: paper "
            "plan\n" +
            program + "paper fig12 --jobs 2\n";
  return text + "# solvers beside each other in the same closed loop\n" + program +
         "compare --live vibrated_box_small --duration 0.02 --solvers pgs,nncg --tolerances "
         "1e-2,1e-4\n";
}

void write_report(const std::filesystem::path& folder) {
  RunData data = read_run_data(folder);
  const RunSummary summary = summarise(data.steps, data.facts);
  const bool has_packing = summary.facts.has_packing;
  if (has_packing && summary.wall.periods.empty())
    data.notices.push_back(plain_words(page::words("run.no_period")));
  page::Page page{.title = name_of_run(data)};
  page::Text extent = page::exact(summary.steps) + " steps, " +
                      page::exact_quantity(summary.duration, "s") + " simulated";
  if (summary.contacts.samples)
    extent += ", " + page::number(summary.contacts.mean, 4) + " contact points on average";
  if (std::isfinite(summary.ms_per_step))
    extent += ", " + page::quantity(summary.ms_per_step, "ms") + " per step";
  page.lede = {extent + ".", made_by(data)};
  page.answers = {.is_enabled = true, .has_charts = true};
  page.add({"motion", "What happens", {replay_of_run(data)}});
  page.add({"results", "The run in numbers", {results_table(summary)}});
  page.add({"paper", has_packing ? "What the paper shows" : "Motion of the wall"});
  page.sections.back().add(paper_figures(data, summary));
  page.add({"periods", "Period by period", {periods_table(summary)}});
  page.add({"diagnostics", "Can it be trusted?"});
  page.sections.back().add(diagnostic_figures(data, summary));
  page.add({"cost-table", "Cost", {cost_table(summary)}});
  page::Section parameters{"parameters", "Parameters"};
  std::string list;
  const Json overrides = data.manifest().value("overrides", Json::array());
  for (const Json& set : overrides) list += (list.empty() ? "" : "\n") + readable(set);
  if (!list.empty()) parameters.add("Settings other than the scene’s (--set):");
  parameters.add(page::Listing{list});
  parameters.add(page::Listing{data.scene_text, "The whole scene (scene.toml)"});
  page.add(std::move(parameters));
  page.add({"provenance",
            "Program and machine",
            {provenance_table(data),
             page::Listing{data.manifest_text, "The whole manifest (manifest.json)"}}});
  page.notices.heading = "To be known before reading";
  std::vector<page::Text>& notices = page.notices.items;  // the most important come first
  if (const long all = data.scene ? data.scene->step_count() : 0; summary.steps < all)
    notices.push_back(plain_words(page::words(
        "run.unfinished", {{"done", page::exact(summary.steps)}, {"all", page::exact(all)}})));
  if (!has_no_findings(summary))
    std::ranges::copy(run_findings(summary), std::back_inserter(notices));
  std::ranges::copy(data.notices, std::back_inserter(notices));
  page::draw_pictures(page, folder,
                      {.command = shell_line({executable_path().string(), "report",
                                              std::filesystem::absolute(folder).string()})});
  page.add({"reproduce", "How to make it again", {page::Listing{reproduce_commands(data)}}});
  page.add({"next", "What next", {page::Listing{next_commands(has_packing)}}});
  write_whole_file(folder / "report.html", html_of(page));
}

}  // namespace ballast
