#include "experiments/compare/page_drawing.hpp"

#include <utility>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {

PageDrawing::PageDrawing(std::filesystem::path folder)
    : folder_(std::move(folder)), has_gnuplot_(!gnuplot_version().empty()) {
  if (!has_gnuplot_) notices.push_back("gnuplot was not found: this page has no figures.");
}

Html PageDrawing::draw(const ReportFigure& figure) {
  if (!has_gnuplot_ || figure.plot.panels.empty()) return {};
  try {
    const std::string svg = render_svg(figure.plot, folder_);
    render_pdf(figure.plot, folder_);
    return html_figure(figure.plot.name, inline_svg(svg, figure.plot.name, figure.plot.title),
                       figure.caption);
  } catch (const Error& error) {
    notices.push_back(std::string(error.what()) + ". The figure is left out.");
    return {};
  }
}

Html PageDrawing::draw(const std::vector<ReportFigure>& figures) {
  Html html;
  for (const ReportFigure& figure : figures) html += draw(figure);
  return html;
}

Html PageDrawing::notices_html() const {
  if (notices.empty()) return {};
  Html html{"<div class=\"notices\" role=\"note\"><ul>\n"};
  for (const std::string& notice : notices)
    html += Html{"<li>"} + escaped(notice) + Html{"</li>\n"};
  return html + Html{"</ul></div>\n"};
}

Html section(const char* id, const std::string& heading, const Html& body) {
  return body.markup.empty() ? Html{} : html_section(id, escaped(heading), body);
}

RunData read_provenance(const std::filesystem::path& folder) {
  RunData data;
  data.folder = folder;
  data.manifest_text = read_whole_file(folder / "manifest.json");
  data.manifest = nlohmann::ordered_json::parse(data.manifest_text, nullptr, false);
  if (!data.manifest.is_object())
    throw Error((folder / "manifest.json").string() + ": is no JSON object");
  return data;
}

}  // namespace ballast
