// C of Eq. 3 against the shape of the box, which the paper does not give: boxes of one height and
// width, as many grains as they hold.

#include <cmath>

#include "experiments/paper/stage_tables.hpp"

namespace ballast {
namespace {

double aspect_of(const RunObservables& run) { return run.aspect(); }

struct DrivenBoxes {
  Varied varied;
  const char* title;
  Ink ink, theory_ink;
  std::vector<VariedValue> values = {};
};

/// Means over samples against the mean L/H.
VariedCurve points_along(PaperData& data, const std::vector<VariedValue>& values,
                         RunMeasure measure) {
  VariedCurve curve;
  for (const VariedValue& value : values) {
    const SampleMean mean = mean_of(data, value, measure);
    if (!(mean.mean > 0.0)) continue;
    curve.x.push_back(mean_of(data, value, aspect_of).mean);
    curve.y.push_back(mean.mean);
    curve.error.push_back(mean.error);
    curve.origins.push_back(value.origin());
  }
  return curve;
}

/// L/H at which the power law through the means gives the paper's C.
page::Text where_paper(PaperData& data, const std::vector<VariedValue>& values) {
  const VariedCurve curve = points_along(data, values, prefactor_of_run);
  const PowerFit fit = fit_power(curve.x, curve.y);
  return page::number(std::pow(paper::prefactor / fit.prefactor, 1.0 / fit.exponent), 2);
}

}  // namespace

PaperSection box_section(PaperData& data) {
  PaperSection section{.text = {page::words("box.intro")}};
  DrivenBoxes all[] = {{Varied::box_length, "5 Hz", Ink::blue, Ink::green},
                       {Varied::box_length_fast, "20 Hz", Ink::vermilion, Ink::orange}};
  Panel panel{.x_label = "length of the box over height of the packing,  {/:Italic L}/{/:Italic H}",
              .y_label = "{/:Italic C} = Δ{/:Italic x}_{max} / {/:Italic X}",
              .log_x = true,
              .log_y = true,
              .y_min = 5e-3,
              .y_max = 0.1,
              .x_min = 0.5,
              .x_max = 3.0,
              .lines = {{paper::prefactor, "the paper’s 0.01", false, Ink::grey}},
              .x_ticks = {0.5, 1.0, 2.0, 3.0}};
  std::vector<RunGroup> cases;
  for (DrivenBoxes& boxes : all) {
    boxes.values = read_values(data, boxes.varied, section);
    if (boxes.values.empty()) continue;
    cases.push_back({boxes.title, boxes.values});
    const std::string title = boxes.title;
    panel.curves.push_back(points_of(points_along(data, boxes.values, prefactor_of_run),
                                     title + ", " + mean_title, boxes.ink));
    panel.curves.push_back(points_of(points_along(data, boxes.values, theory_of),
                                     title + ", by the theory", boxes.theory_ink));
    panel.curves.back().shape = MarkShape::diamond;
    const auto exponent = [&](RunMeasure measure) {
      return words_with_interval(exponent_by_sample(data, boxes.values, aspect_of, measure));
    };
    if (boxes.values.size() > 2)
      section.report("box.claim", {{"frequency", title},
                                   {"exponent", exponent(prefactor_of_run)},
                                   {"push", exponent(push_of)},
                                   {"theory", exponent(theory_of)},
                                   {"at", where_paper(data, boxes.values)}});
  }
  if (cases.empty()) return section;
  section.draw("box_shape", {.height = 480, .panels = {panel}});
  section.tables.push_back(stage_table(data, "box.table", cases));
  return section;
}

}  // namespace ballast
