#include "experiments/paper/paper_report.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/page/html.hpp"
#include "experiments/page/markdown.hpp"
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

/// What the finished runs were made by: programs, machines, steps, wall clock.
std::vector<page::Text> origin_of(PaperData& data) {
  std::map<std::string, int> commits, machines;
  std::set<std::string> seen;
  double steps = 0.0, seconds = 0.0;
  for (const CampaignRun& run : data.campaign()) {
    if (!data.has(run) || !seen.insert(run.key).second) continue;
    const Json manifest =
        Json::parse(read_whole_file(data.folder(run.key) / "manifest.json"), nullptr, false);
    if (!manifest.is_object()) continue;
    ++commits[text_in(manifest, "/ballast/commit")];
    ++machines[text_in(manifest, "/machine/cpu")];
    steps += static_cast<double>(run.steps);
    const Json::json_pointer time("/summary/ms_per_step");
    if (manifest.contains(time) && manifest[time].is_number())
      seconds += 1e-3 * manifest[time].get<double>() * static_cast<double>(run.steps);
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
  write_whole_file(folder / "data" / "runs.csv", runs_csv(data.rows()));
  write_whole_file(folder / "data" / "runs_columns.csv", run_columns_csv());
  page::Page page = paper_page(sections, origin_of(data));
  page.answers = {.are_given = true, .with_curves = true};
  // the data stand beside as CSV, and README.md shows the files themselves
  page::draw_pictures(page, folder, {.with_script = false, .on_white = true});
  write_html_file(folder / "paper.html", page);
  page.lede.push_back(page::words("paper.made_by"));
  write_whole_file(folder / "README.md", markdown_of(page));
}

}  // namespace ballast
