#include "experiments/run_page/figures.hpp"

namespace ballast {

page::Picture run_picture(const std::string& name, int height, std::vector<Panel> panels,
                          page::Text caption) {
  return {.plot = {.name = name,
                   .title = plain_words(page::words("run." + name + ".title")),
                   .height = height,
                   .panels = std::move(panels)},
          .caption = {std::move(caption)}};
}

Panel time_panel(const RunData& data, const std::string& y_label, bool log_y) {
  return {.x_label = "{/:Italic t}  (s)",
          .y_label = y_label,
          .log_y = log_y,
          .x_min = 0.0,
          .x_max = data.steps.back().time};
}

Curve line_of(std::vector<double> x, std::vector<double> y, const std::string& title, Ink ink,
              double width) {
  thin_out(x, y, 3000);
  return {.x = std::move(x), .y = std::move(y), .title = title, .ink = ink, .width = width};
}

Curve column_line(const RunData& data, double StepRecord::*value, double factor,
                  const std::string& title, Ink ink, double width) {
  return line_of(record_column(data.steps, &StepRecord::time),
                 record_column(data.steps, value, factor), title, ink, width);
}

ForceUnit force_unit(double f_max) {
  return f_max >= 1000.0 ? ForceUnit{"kN", 1e-3} : ForceUnit{"N", 1.0};
}

}  // namespace ballast
