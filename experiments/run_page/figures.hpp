#pragma once
// The figures of a run. The data are in the plot; the caption says what is drawn, what the paper
// shows, what to look for.

#include <vector>

#include "experiments/measure/run_data.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// The paper's figures that a single run shows: Figs. 3, 4 and 12. Empty if the run has neither a
/// driven wall nor a packing.
std::vector<page::Picture> paper_figures(const RunData& data, const RunSummary& summary);
/// The figures that show whether the run can be trusted: jammed state, error, penetration,
/// iterations and contacts, energy.
std::vector<page::Picture> diagnostic_figures(const RunData& data, const RunSummary& summary);

page::Picture figure_3(const RunData& data, const RunSummary& summary);
page::Picture figure_4(const RunData& data, const RunSummary& summary);

/// The panel of Fig. 12, and in it the change of the solid fraction since before the drive.
Panel solid_fraction_panel(const RunData& data);
Curve solid_fraction_line(const RunData& data, const page::Text& title, Ink ink, double width);

/// A line of at most 3000 samples, which looks like the line of all samples.
Curve line_of(std::vector<double> x, std::vector<double> y, const page::Text& title, Ink ink,
              double width = 1.6);

/// Unit in which forces up to f_max are readable.
struct ForceUnit {
  const char* name;
  double factor;  ///< from newtons to this unit
};
ForceUnit force_unit(double f_max);

}  // namespace ballast
