#pragma once
// What the pages of `ballast compare` share: figures drawn twice, what could not be drawn said, who
// made it.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/measure/run_data.hpp"
#include "experiments/page/html_page.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {

/// Draws figures as SVG and PDF into a folder; what cannot be drawn becomes a notice.
class PageDrawing {
 public:
  explicit PageDrawing(std::filesystem::path folder);

  /// Nothing for a figure without panels.
  Html draw(const ReportFigure& figure);
  Html draw(const std::vector<ReportFigure>& figures);
  Html notices_html() const;

  std::vector<std::string> notices;

 private:
  std::filesystem::path folder_;
  bool has_gnuplot_;
};

/// A section, or nothing when it is empty.
Html section(const char* id, const std::string& heading, const Html& body);

/// manifest.json of a folder, as provenance_table() and made_by() take it. Throws Error.
RunData read_provenance(const std::filesystem::path& folder);

}  // namespace ballast
