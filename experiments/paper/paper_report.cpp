#include "experiments/paper/paper_report.hpp"

#include <map>
#include <nlohmann/json.hpp>

#include "experiments/page/html.hpp"
#include "experiments/page/markdown.hpp"
#include "experiments/paper/point_origins.hpp"
#include "platform/atomic_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

std::string text_in(const Json& manifest, const char* where) {
  const Json::json_pointer at(where);
  const bool is_there = manifest.contains(at) && manifest[at].is_string();
  return is_there ? manifest[at].get<std::string>() : "unknown";
}

std::string listed(const std::map<std::string, int>& counts) {
  std::string text;
  for (const auto& [name, count] : counts)
    text += (text.empty() ? "" : "; ") + name + " (" + std::to_string(count) + " runs)";
  return text;
}

}  // namespace

std::vector<page::Text> origin_of(PaperData& data) {
  const Campaign& campaign = data.campaign();
  std::map<std::string, int> commits, machines;
  double steps = 0.0, seconds = 0.0;
  for (size_t k = 0; k < campaign.runs.size(); ++k) {
    if (!data.has(k)) continue;
    const Json manifest =
        Json::parse(read_whole_file(data.folder(k) / "manifest.json"), nullptr, false);
    if (!manifest.is_object()) continue;
    ++commits[text_in(manifest, "/ballast/commit")];
    ++machines[text_in(manifest, "/machine/cpu")];
    const double run_steps = static_cast<double>(campaign.runs[k].steps);
    steps += run_steps;
    const Json::json_pointer time("/summary/ms_per_step");
    if (manifest.contains(time) && manifest[time].is_number())
      seconds += 1e-3 * manifest[time].get<double>() * run_steps;
  }
  const page::Text origin =
      page::words("paper.origin", {{"finished", std::to_string(data.finished())},
                                   {"runs", std::to_string(campaign.runs.size())},
                                   {"steps", page::number(steps, 4)},
                                   {"seconds", page::number(seconds, 3)},
                                   {"commits", listed(commits)},
                                   {"machines", listed(machines)},
                                   {"scene", campaign.settings.scene},
                                   {"iterations", std::to_string(campaign.settings.iterations)},
                                   {"seeds", std::to_string(campaign.settings.seeds)}});
  std::vector<page::Text> parts = parts_of(origin, "||");
  if (const int rows = data.known_by_row())
    parts.push_back(page::words("paper.rows", {{"rows", std::to_string(rows)}}));
  if (const auto [made, same] = data.repeats(); made > 0)
    parts.push_back(page::words("paper.repeats",
                                {{"made", std::to_string(made)}, {"same", std::to_string(same)}}));
  return parts;
}

page::Page paper_page(const std::vector<PaperSection>& sections,
                      const std::vector<page::Text>& origin) {
  page::Page page{.title = "The paper, figure by figure", .lede = {page::words("paper.lede")}};
  page::Table agreement = page::words_table("paper.agreement"),
              beyond = page::words_table("paper.beyond");
  for (const PaperSection& section : sections) {
    for (const AgreementRow& row : section.rows)
      agreement.rows.push_back({row.place, row.paper, word_of(row.agreement), row.ballast,
                                words_of(row.range), words_of(row.found)});
    for (const BeyondRow& finding : section.findings)
      beyond.rows.push_back({finding.what, finding.found});
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
  for (const PaperSection& section : sections)
    for (const page::Picture& figure : section.figures)
      write_whole_file(folder / "data" / (figure.plot.name + ".csv"), figure_csv(figure.plot));
  write_whole_file(folder / "data" / "runs.csv", runs_csv(data.observables()));
  write_whole_file(folder / "data" / "runs_columns.csv", run_columns_csv());
  page::Page page = paper_page(sections, origin_of(data));
  page.answers = {
      .are_given = true, .with_curves = true, .data = origins_of_points(data, sections, folder)};
  // the data stand beside as CSV, and README.md shows the files themselves
  page::draw_pictures(page, folder, {.with_script = false, .on_white = true});
  write_html_file(folder / "paper.html", page);
  page.lede.push_back(page::words("paper.made_by"));
  write_whole_file(folder / "README.md", markdown_of(page));
}

}  // namespace ballast
