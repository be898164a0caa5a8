#include "experiments/paper/sections.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>

#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

constexpr double least_law_p = 0.01;

constexpr const char* every_section = "all";

std::string listed(const std::map<std::string, int>& counts) {
  std::string text;
  for (const auto& [name, count] : counts)
    text += (text.empty() ? "" : "; ") + name + " (" + std::to_string(count) + " runs)";
  return text.empty() ? "none" : text;
}

/// The origin of the finished runs: programs, machines, steps, wall clock.
std::vector<page::Text> origin_of(PaperData& data) {
  std::map<std::string, int> commits, machines;
  std::set<std::string> seen;
  double steps = 0.0, seconds = 0.0;
  for (const PlannedRun& run : data.campaign()) {
    if (!data.has(run) || !seen.insert(run.key).second) continue;
    const Manifest manifest = Manifest::read(RunFolder(data.folder(run.key)).manifest());
    ++commits[manifest.commit()];
    ++machines[manifest.machine()];
    steps += static_cast<double>(run.steps);
    seconds += manifest.summary_number("drive_seconds");
  }
  std::vector<page::Text> parts =
      parts_of(page::words("paper.origin", {{"finished", std::to_string(data.finished())},
                                            {"runs", std::to_string(data.planned())},
                                            {"steps", page::number(steps, 4)},
                                            {"seconds", page::number(seconds, 3)},
                                            {"commits", listed(commits)},
                                            {"machines", listed(machines)}}),
               "||");
  const auto add = [&](const char* name, size_t count) {
    if (count > 0) parts.push_back(page::words(name, {{"rows", std::to_string(count)}}));
  };
  add("paper.rows", data.known_by_row());
  add("paper.foreign", data.foreign());
  if (const auto [made, same] = data.repeats(); made > 0)
    parts.push_back(page::words("paper.repeats",
                                {{"made", std::to_string(made)}, {"same", std::to_string(same)}}));
  parts.insert(parts.end(), data.notices().begin(), data.notices().end());
  return parts;
}

}  // namespace

const char* word_of(Agreement agreement) {
  return name_in({"agrees", "partly", "DIFFERS", "reported"}, agreement);
}

Agreement agreement_of(const PaperRange& paper, const Found& found) {
  if (!std::isfinite(found.low) || !std::isfinite(found.high)) return Agreement::reported;
  const double width = paper.high - paper.low;  // infinite: a bound, which is not widened
  const PaperRange wide =
      std::isfinite(width) ? PaperRange{paper.low - width, paper.high + width} : paper;
  const bool is_sharp = wide.holds(found.low) && wide.holds(found.high),
             holds = std::isnan(found.law_p) || found.law_p >= least_law_p;
  if (paper.holds(found.value) && is_sharp && holds && found.is_whole) return Agreement::agrees;
  if (wide.holds(found.value)) return Agreement::partly;
  const bool reaches = found.low <= paper.high && found.high >= paper.low;
  return reaches ? Agreement::reported : Agreement::differs;
}

page::Text words_of(const PaperRange& range) {
  if (std::isinf(range.low)) return "≤ " + page::exact(range.high);
  if (std::isinf(range.high)) return "≥ " + page::exact(range.low);
  return page::exact(range.low) + " … " + page::exact(range.high);
}

page::Text words_of(const Found& found) {
  page::Text text = page::number(found.value);
  if (std::isfinite(found.low) && std::isfinite(found.high))
    text += " " + page::interval(found.low, found.high);
  if (found.law_p < least_law_p) text += "; the law misses the points";
  if (!found.is_whole) text += "; a part of the statement";
  return text;
}

std::span<const ReportSection> paper_sections() {
  static const std::vector<ReportSection> table{
      {"curve", {"frequency", "slowest", "force", "gravity", "mass"}, fill_curve},
      {"fig3", {"motion", "frequency", "slowest"}, fill_motion},
      {"fig4", {"motion"}, fill_forces},
      {"fig5", {"motion"}, fill_model},
      {"fig6", {"motion"}, fill_velocities},
      {"fig7", {"motion"}, fill_chains},
      {"fig8", {"frequency"}, fill_portraits},
      {"fig9", {"frequency", "slowest"}},
      {"fig10", {"force", "gravity", "mass"}},
      {"fig11", {"frequency", "slowest", "force", "gravity", "mass"}},
      {"fig12", {"motion"}, fill_density},
      {"fig13", {"frequency", "slowest"}, fill_rates},
      {"box", {"box"}},
      {"replicas", {"replicas"}, fill_replicas},
      {"tight", {"tightest", "rule", "frequency"}, fill_errors},
      {"deposits", {"deposits"}},
      {"preparation", {"preparation", "reading"}},
      {"compaction", {"compaction"}, fill_compaction},
      {"loads", {"loads"}},
      {"shapes", {"shapes"}},
      {"sizes", {"sizes"}},
      {"laws", {"laws"}},
      {"sensitivity", {"sensitivity"}},
      {"reading", {"reading", "frequency", "slowest"}, fill_reading},
      {"theory",
       {"frequency", "force", "gravity", "mass", "box", "loads", "preparation"},
       fill_theory}};
  return table;
}

std::vector<std::string> paper_targets(const std::vector<PlannedRun>& campaign) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const ReportSection& section : paper_sections()) add(section.name);
  for (const PlannedRun& run : campaign) add(stage_of(run));
  names.emplace_back(every_section);
  return names;
}

std::vector<Plan> stages_of(const PaperData& data, const std::string& target) {
  std::set<std::string> wanted;
  for (const PlannedRun& run : data.campaign())
    if (target == every_section || target == stage_of(run)) wanted.insert(stage_of(run));
  for (const ReportSection& section : paper_sections())
    if (target == section.name) wanted.insert(section.stages.begin(), section.stages.end());
  if (wanted.empty())
    throw std::invalid_argument("paper: '" + target + "' is not one of " +
                                joined(paper_targets(data.campaign())));
  std::vector<Plan> stages;
  for (const PlannedRun& run : data.campaign()) {
    const std::string stage = stage_of(run), name = "paper-" + stage;
    if (!wanted.contains(stage) || (data.knows(run) && !data.has(run))) continue;
    if (stages.empty() || stages.back().name != name) stages.push_back({name, {}});
    stages.back().runs.push_back(run);
  }
  return stages;
}

std::vector<PaperSection> make_sections(PaperData& data, const std::string& target) {
  std::vector<PaperSection> made;
  for (const ReportSection& section : paper_sections()) {
    const bool draws_stage = std::ranges::count(section.stages, target) > 0;
    if (target != section.name && target != every_section && !draws_stage) continue;
    const std::string name = section.name;
    PaperSection& part =
        made.emplace_back(PaperSection{.id = name, .heading = page::words(name + ".heading")});
    for (const char* stage : section.stages)
      if (const std::string missing = data.missing(stage); !missing.empty())
        part.notes.emplace_back(missing);
    part.text.push_back(page::words(name + ".intro"));
    add_laws(data, part);
    if (section.fill) section.fill(data, part);
    add_cases(data, part);
  }
  if (made.empty()) throw std::invalid_argument("paper: no section is called '" + target + "'");
  return made;
}

void PaperSection::draw(const std::string& name, Figure plot, const page::Values& values) {
  keep(name, values);
  // "fig9" is kept as fig09, so that files sort by number
  const bool has_one_digit = name.starts_with("fig") && name.size() == 4;
  const std::string file = has_one_digit ? "fig0" + name.substr(3) : name;
  if (plot.name.empty()) plot.name = file;
  plot.has_letters = plot.panels.size() > 1;
  if (plot.title.empty()) plot.title = plain_words(page::words(name + ".title"));
  figures.push_back({std::move(plot),
                     {page::marked("**Paper:** ") + page::words(name + ".paper"),
                      page::marked("**Ballast:** ") + page::words(name + ".found", values)},
                     page::Text("data", 0, "data/" + file + ".csv")});
}

void PaperSection::claim(const std::string& name, const page::Values& values,
                         const PaperRange& range, const Found& found) {
  page::Values cited = values;
  cited["found"] = words_of(found);
  cited["verdict"] = word_of(agreement_of(range, found));
  keep(name, cited);
  const std::vector<page::Text> cells = parts_of(page::words(name, values), "||");
  claims.push_back(
      {cells.at(0), cells.at(1), cited["verdict"], cells.at(2), words_of(range), words_of(found)});
}

void PaperSection::report(const std::string& name, const page::Values& values) {
  keep(name, values);
  findings.push_back(parts_of(page::words(name, values), "||"));
}

void PaperSection::keep(const std::string& name, const page::Values& values) {
  std::string place = name;  // the second finding of a name: "name:2"
  for (int k = 2; !values.empty() && numbers.contains(place + "." + values.begin()->first); ++k)
    place = name + ":" + std::to_string(k);
  for (const auto& [key, value] : values) numbers[place + "." + key] = value;
}

void PaperSection::add(page::Table table) {
  if (!table.rows.empty()) tables.push_back(std::move(table));
}

page::Text words_of(const SampleMean& mean, double factor) {
  return page::with_error(factor * mean.mean, factor * mean.error);
}

page::Text words_of(const PowerFit& fit) {
  if (!std::isfinite(fit.exponent)) return "–";
  return words_of(found(fit, 1.0)) + " (R² " + page::number(fit.r2, 4) + ", " +
         std::to_string(fit.samples) + " points)";
}

page::Text words_of(const Proportion& fit) {
  return page::number(fit.factor) + " " + page::interval(fit.low, fit.high);
}

page::Text words_of(const VarianceRatio& found, const char* name) {
  return name + (" " + page::number(found.ratio, 2)) + ", p " + words_of_p(found.p);
}

page::Text words_of_p(double p) { return p < 1e-4 ? page::Text("< 1e-4") : page::number(p, 2); }

page::Text words_with_interval(const SampleMean& mean) {
  if (!std::isfinite(mean.mean)) return "–";
  return words_of(found(mean)) + (mean.samples < 2 ? " (one sample)" : "");
}

page::Text words_of_change(const SampleMean& change) {
  if (!std::isfinite(change.mean)) return "–";
  const page::Text mean = page::percent(std::expm1(change.mean));
  const double half = change.half_width();
  if (!std::isfinite(half)) return mean;
  return mean + " " +
         page::interval(100.0 * std::expm1(change.mean - half),
                        100.0 * std::expm1(change.mean + half));
}

Curve curve_of(const Points& points, const page::Text& title, Ink ink, MarkShape shape) {
  Curve curve{.x = points.x,
              .y = points.y,
              .title = title,
              .ink = ink,
              .mark = Mark::points,
              .shape = shape,
              .width = 2.4,
              .y_error = points.error};
  for (double& bar : curve.y_error)
    if (!std::isfinite(bar)) bar = 0.0;  // one sample: no bar
  return curve;
}

std::string figure_csv(const Figure& figure) {
  CsvWriter csv;
  csv.add_row({"panel", "y_label", "curve", "x_label", "x", "y", "y_error", "y_low"});
  for (size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& panel = figure.panels[p];
    for (size_t c = 0; c < panel.curves.size(); ++c) {
      const Curve& curve = panel.curves[c];
      for (size_t k = 0; k < curve.x.size(); ++k) {
        csv.add(static_cast<long>(p + 1));
        csv.add(plain_words(panel.y_label));
        csv.add(curve.title.empty() ? std::to_string(c + 1) : plain_words(curve.title));
        csv.add(plain_words(panel.x_label));
        for (const auto* values : {&curve.x, &curve.y, &curve.y_error, &curve.y_low})
          csv.add(k < values->size() ? number_cell((*values)[k], 10) : "");
        csv.end_row();
      }
    }
  }
  return csv.take();
}

page::Page paper_page(const std::vector<PaperSection>& sections,
                      const std::vector<page::Text>& origin) {
  page::Page page{.title = "The paper, figure by figure", .lede = {page::words("paper.lede")}};
  page::Table agreement = page::words_table("paper.agreement"),
              beyond = page::words_table("paper.beyond");
  for (const PaperSection& section : sections) {
    std::ranges::copy(section.claims, std::back_inserter(agreement.rows));
    std::ranges::copy(section.findings, std::back_inserter(beyond.rows));
  }
  page.add({"origin", "What was run", {page::List{origin}}});
  page.add({"agreement", "Paper, Ballast, agreement", {page::words("paper.rule"), agreement}});
  page.add({"beyond", "Beyond the paper", {beyond}});
  page.add({"parameters",
            "What the paper says and what was chosen",
            {page::words_table("paper.parameters"), page::words("paper.unknown")}});
  for (const PaperSection& section : sections) {
    page::Section part{section.id, section.heading, {page::Notices{{}, section.notes}}};
    for (const page::Text& paragraph : section.text) part.add(paragraph);
    part.add(section.figures);
    for (page::Table table : section.tables) {
      table.caption += ":";
      part.add(table);
    }
    page.add(part);
  }
  return page;
}

void write_paper_report(PaperData& data, const std::vector<PaperSection>& sections,
                        const fs::path& folder) {
  create_folder(folder / "data");
  write_whole_file(folder / "data" / "runs_columns.csv", run_columns_csv());  // marks our folder
  for (const PaperSection& section : sections)
    for (const page::Picture& figure : section.figures)
      write_whole_file(folder / "data" / (figure.plot.name + ".csv"), figure_csv(figure.plot));
  write_whole_file(folder / "data" / "runs.csv", runs_csv(data.rows()));
  page::Page page = paper_page(sections, origin_of(data));
  page.answers = {.is_enabled = true, .has_charts = true};
  // the data are in CSV files beside, and README.md shows the SVG files themselves
  page::draw_pictures(page, folder, {.is_file_shown = true});
  write_whole_file(folder / "paper.html", html_of(page));
  page.lede.push_back(page::words("paper.made_by"));
  write_whole_file(folder / "README.md", markdown_of(page));
}

}  // namespace ballast
