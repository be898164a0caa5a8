#include "experiments/paper/section.hpp"

#include <algorithm>

#include "platform/csv.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// The k-th value as a cell; empty where there is none or it is not finite.
void add_value(CsvWriter& csv, const std::vector<double>& values, size_t k) {
  if (k < values.size() && std::isfinite(values[k]))
    csv.add(values[k], 10);
  else
    csv.add("");
}

}  // namespace

const char* word_of(Agreement agreement) {
  switch (agreement) {
    case Agreement::agrees:
      return "agrees";
    case Agreement::partly:
      return "partly";
    case Agreement::differs:
      return "DIFFERS";
    case Agreement::reported:
      return "reported";
  }
  return "?";
}

Panel frequency_panel(const std::string& y_label) {
  Panel panel;
  panel.x_label = "{/:Italic ν}  (Hz)";
  panel.y_label = y_label;
  panel.log_x = true;
  panel.x_min = 0.85;
  panel.x_max = 70.0;
  return panel;
}

Curve points_of(std::vector<double> x, std::vector<double> y, std::vector<double> error,
                const std::string& title, Ink ink) {
  for (double& bar : error)
    if (!std::isfinite(bar)) bar = 0.0;  // one sample: no bar
  Curve curve;
  curve.x = std::move(x);
  curve.y = std::move(y);
  curve.y_error = std::move(error);
  curve.title = title;
  curve.ink = ink;
  curve.mark = Mark::points;
  curve.width = 2.4;
  return curve;
}

std::string figure_csv(const Figure& figure) {
  CsvWriter csv;
  csv.add_row(std::vector<std::string>{"panel", "y_label", "curve", "x_label", "x", "y", "y_error",
                                       "y_low"});
  for (size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& panel = figure.panels[p];
    for (size_t c = 0; c < panel.curves.size(); ++c) {
      const Curve& curve = panel.curves[c];
      for (size_t k = 0; k < curve.x.size(); ++k) {
        csv.add(static_cast<long>(p + 1));
        csv.add(panel.y_label);
        csv.add(curve.title.empty() ? std::to_string(c + 1) : curve.title);
        csv.add(panel.x_label);
        for (const auto* values : {&curve.x, &curve.y, &curve.y_error, &curve.y_low})
          add_value(csv, *values, k);
        csv.end_row();
      }
    }
  }
  return csv.take();
}

}  // namespace ballast
