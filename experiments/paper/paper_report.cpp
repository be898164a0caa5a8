#include "experiments/paper/paper_report.hpp"

#include <cmath>
#include <map>

#include "experiments/page/html_page.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// The picture as a file on its own: on white, whatever is behind it.
std::string on_white(std::string svg) {
  const size_t root = svg.find("<svg");
  const size_t end = root == std::string::npos ? root : svg.find('>', root);
  if (end != std::string::npos)
    svg.insert(end + 1, "\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>");
  return svg;
}

/// Draws a figure into the folder and returns the SVG for inlining.
std::string draw(const Figure& figure, const fs::path& folder) {
  const fs::path pictures = folder / "figures";
  const std::string svg = render_svg(figure, pictures);
  write_whole_file(pictures / (figure.name + ".svg"), on_white(svg));
  render_pdf(figure, pictures);
  std::error_code ignored;
  fs::remove(pictures / (figure.name + ".gnuplot"), ignored);  // its data are in data/
  return svg;
}

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

std::vector<std::string> origin_of(const PaperData& data) {
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
  std::vector<std::string> origin = {
      std::to_string(data.finished()) + " of " + std::to_string(data.campaign().runs.size()) +
          " runs are finished: " + digits(steps, 4) + " driven steps, about " + digits(seconds, 3) +
          " core-seconds without the packings.",
      "Commits: " + listed(commits) + ".", "Machines: " + listed(machines) + ".",
      "Scene " + settings.scene + ", " + std::to_string(settings.iterations) +
          " solver iterations a step unless said, seeds 1 to " + std::to_string(settings.seeds) +
          "."};
  return origin;
}

void write_paper_report(PaperData& data, std::vector<PaperSection> sections,
                        const fs::path& folder) {
  create_folder(folder / "figures");
  create_folder(folder / "data");
  std::vector<std::string> pictures;
  for (PaperSection& section : sections)
    for (const PaperFigure& figure : section.figures) {
      write_whole_file(folder / "data" / (figure.plot.name + ".csv"), figure_csv(figure.plot));
      pictures.emplace_back();
      try {
        pictures.back() = draw(figure.plot, folder);
      } catch (const Error& error) {
        section.notes.push_back(std::string(error.what()) + ". The figure is left out.");
      }
    }
  const std::vector<std::string> origin = origin_of(data);
  write_whole_file(folder / "README.md", markdown_of(sections, origin));
  write_whole_file(folder / "paper.html", html_of(sections, origin, pictures));
}

}  // namespace ballast
