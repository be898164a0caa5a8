#include "experiments/paper/paper_report.hpp"

#include <cmath>
#include <map>

#include "experiments/page/drawing.hpp"
#include "experiments/page/html.hpp"
#include "experiments/page/markdown.hpp"
#include "platform/atomic_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

std::string text_in(const nlohmann::ordered_json& manifest, const char* part, const char* name) {
  const auto found = manifest.find(part);
  if (found == manifest.end() || !found->is_object() || !found->contains(name) ||
      !(*found)[name].is_string())
    return "unknown";
  return (*found)[name].get<std::string>();
}

std::string listed(const std::map<std::string, int>& counts) {
  std::string text;
  for (const auto& [name, count] : counts)
    text += (text.empty() ? "" : "; ") + name + " (" + std::to_string(count) + " runs)";
  return text;
}

}  // namespace

std::vector<page::Text> origin_of(const PaperData& data) {
  std::map<std::string, int> commits, machines;
  double steps = 0.0, seconds = 0.0;
  for (size_t k = 0; k < data.campaign().runs.size(); ++k) {
    if (!data.has(k)) continue;
    const std::string text = read_whole_file(data.folder(k) / "manifest.json");
    const auto manifest = nlohmann::ordered_json::parse(text, nullptr, false);
    if (!manifest.is_object()) continue;
    ++commits[text_in(manifest, "ballast", "commit")];
    ++machines[text_in(manifest, "machine", "cpu")];
    steps += static_cast<double>(data.campaign().runs[k].steps);
    if (const auto summary = manifest.find("summary"); summary != manifest.end() &&
                                                       summary->contains("ms_per_step") &&
                                                       (*summary)["ms_per_step"].is_number())
      seconds += 1e-3 * (*summary)["ms_per_step"].get<double>() *
                 static_cast<double>(data.campaign().runs[k].steps);
  }
  const CampaignSettings& settings = data.campaign().settings;
  std::vector<page::Text> origin = {
      std::to_string(data.finished()) + " of " + std::to_string(data.campaign().runs.size()) +
          " runs are finished: " + page::number(steps, 4) + " driven steps, about " +
          page::number(seconds, 3) + " core-seconds without the packings.",
      "Commits: " + listed(commits) + ".", "Machines: " + listed(machines) + ".",
      "Scene " + settings.scene + ", " + std::to_string(settings.iterations) +
          " solver iterations a step unless said, seeds 1 to " + std::to_string(settings.seeds) +
          "."};
  return origin;
}

void write_paper_report(PaperData& data, const std::vector<PaperSection>& sections,
                        const fs::path& folder) {
  create_folder(folder / "data");
  for (const PaperSection& section : sections)
    for (const PaperFigure& figure : section.figures)
      write_whole_file(folder / "data" / (figure.plot.name + ".csv"), figure_csv(figure.plot));
  page::Page page = paper_page(sections, origin_of(data));
  // the data stand beside as CSV, and README.md shows the files themselves
  page::draw_pictures(page, folder, {.with_script = false, .on_white = true});
  write_whole_file(folder / "paper.html", html_of(page));
  page.lede.push_back(
      page::marked("`ballast paper report` writes this page; it also is "
                   "[one HTML page](paper.html) that opens offline."));
  write_whole_file(folder / "README.md", markdown_of(page));
}

}  // namespace ballast
