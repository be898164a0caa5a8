// C as seen against C by the theory of force_law.hpp, over everything that was varied: one law with
// no free parameter, or not.

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/paper/stage_tables.hpp"

namespace ballast {
namespace {

/// Points of one colour and shape.
struct Family {
  const char* title;
  std::vector<Varied> varied;
  Ink ink;
  MarkShape shape;
  bool is_partial = true;  ///< a part of its runs is enough
};

std::vector<Family> families() {
  using enum Varied;
  using enum MarkShape;
  return {
      {"ν", {frequency, pressed_frequency, tight_frequency, tightest_frequency}, Ink::blue, circle},
      {"f_max", {force}, Ink::vermilion, triangle, false},
      {"g", {gravity}, Ink::green, square, false},
      {"m_w", {wall_mass}, Ink::purple, diamond, false},
      {"L/H", {box_length, box_length_fast}, Ink::orange, circle, false},
      {"light wall",
       {light_frequency, light_strong_frequency, light_half_frequency},
       Ink::black,
       triangle},
      {"deposit",
       {pressed_rough_frequency, placed_frequency, placed_rough_frequency},
       Ink::grey,
       square},
      {"grains, size",
       {shape, shape_fast, size_similar, size_wide, reading_frequency},
       Ink::sky,
       diamond}};
}

/// Appends a value's means, unless it was there already or one of them is not known.
void add_point(PaperData& data, const VariedValue& value, std::set<std::vector<size_t>>& seen,
               VariedCurve& curve) {
  const SampleMean theory = mean_of(data, value, theory_of),
                   found = mean_of(data, value, prefactor_of_run);
  if (!(theory.mean > 0.0) || !(found.mean > 0.0) || !seen.insert(value.runs).second) return;
  curve.x.push_back(theory.mean);
  curve.y.push_back(found.mean);
  curve.error.push_back(found.error);
  curve.errors_from += std::max(0, found.samples - 1);
  curve.origins.push_back(value.origin());
}

void append(const VariedCurve& part, VariedCurve& all) {
  all.x.insert(all.x.end(), part.x.begin(), part.x.end());
  all.y.insert(all.y.end(), part.y.begin(), part.y.end());
  all.error.insert(all.error.end(), part.error.begin(), part.error.end());
  all.errors_from += part.errors_from;
}

}  // namespace

PaperSection theory_section(PaperData& data) {
  PaperSection section{.text = {page::words("theory.intro")}};
  Panel panel{.x_label = "{/:Italic C} by the theory, from the force as measured",
              .y_label = "{/:Italic C} as seen",
              .log_x = true,
              .log_y = true};
  std::set<std::vector<size_t>> seen;  // runs of several series are one point
  VariedCurve all;
  page::Table table = page::words_table("theory.table");
  for (const Family& family : families()) {
    VariedCurve part;
    for (const Varied varied : family.varied) {
      if (!family.is_partial) read_values(data, varied, section);
      for (const VariedValue& value : data.values(varied)) add_point(data, value, seen, part);
    }
    if (part.x.empty()) continue;
    append(part, all);
    panel.curves.push_back(points_of(part, plain_text(family.title), family.ink));
    panel.curves.back().shape = family.shape;
    const Proportion ratio = fit_proportion(part.x, part.y);
    table.rows.push_back({family.title, std::to_string(part.x.size()),
                          page::number(ratio.factor) + " " + page::interval(ratio.low, ratio.high),
                          words_of(fit_power(part.x, part.y))});
  }
  if (all.x.size() < 3) return section;
  const PowerFit fit = fit_power(all.x, all.y);
  const Proportion ratio = fit_proportion(all.x, all.y);
  const auto [low, high] = std::minmax_element(all.x.begin(), all.x.end());
  const Drawn range{*low, *high, true};
  panel.curves.push_back(curve_of([](double x) { return x; }, range, "the theory", Ink::grey));
  panel.curves.push_back(
      curve_of([&](double x) { return fit.at(x); }, range, "power law", Ink::black, false));
  const page::Values words{{"points", std::to_string(all.x.size())},
                           {"fit", words_of(fit)},
                           {"misfit", words_of(misfit_of(fit, all))},
                           {"ratio", page::number(ratio.factor)},
                           {"interval", page::interval(ratio.low, ratio.high)},
                           {"spread", page::number(ratio.spread)}};
  section.draw("theory", {.height = 560, .panels = {panel}}, words);
  section.tables.push_back(table);
  section.report("theory.claim", words);
  return section;
}

}  // namespace ballast
