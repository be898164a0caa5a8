// Power laws and lines through the origin: Figs. 9, 10 and 11, C against its theory and against the
// shape of the box. A figure is a row of `laws` below and its words.

#include <algorithm>
#include <set>

#include "experiments/paper/one_curve.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

/// Points of one colour, and a row of the table.
struct Family {
  Selection selection;
  Ink ink;
  MarkShape shape = MarkShape::circle;
};

/// Measured means against a law y ~ x^expected, one figure.
struct Law {
  const char *section, *name;  ///< its words are <name>.title, .paper, .found, .claim
  std::vector<Family> families;
  RunMeasure x, y;
  double x_factor, y_factor;  ///< from SI
  double expected;            ///< exponent: of the paper, or of the theory
  bool is_of_paper;           ///< judged; else a finding
  double split;               ///< exponents up to here and from here on are said too; NaN: none
  const char *x_label, *y_label;
  double reference = not_known;  ///< y = reference x is drawn too
};

const std::vector<Law>& laws() {
  using Run = const RunSummary&;
  using enum MarkShape;
  constexpr const char *rise = "Δ{/:Italic x}_{max}  (mm)",
                       *x = "right side of Eq. 3 without {/:Italic C}  (mm)",
                       *c = "{/:Italic C} = Δ{/:Italic x}_{max} / {/:Italic X}";
  const auto series = [](size_t k) {
    const Series& of = all_series()[k];
    return Family{of.selection, of.ink, of.shape};
  };
  const auto along = [](size_t k) { return all_series()[k].along; };
  const RunMeasure aspect = [](Run run) { return run.facts.length / run.facts.height; };
  const auto is_slow = [](const RunRow& row) { return row.run.facts.frequency == 5.0; };
  const auto is_fast = [](const RunRow& row) { return row.run.facts.frequency == 20.0; };
  const auto is_pressed = [](const RunRow& row) {
    return row.stage != "deposits" ||
           (row.run.facts.lid_pressure > 0.0 && row.run.facts.deposit_friction == 0.4);
  };
  static const std::vector<Law> all{
      {"fig9",
       "fig9",
       {series(0)},
       frequency_of,
       rise_of,
       1.0,
       1e3,
       -2.0,
       true,
       10.0,
       "{/:Italic ν}  (Hz)",
       rise},
      {"fig9",
       "fig9_speed",
       {series(0)},
       frequency_of,
       speed_of,
       1.0,
       1e3,
       -1.0,
       true,
       10.0,
       "{/:Italic ν}  (Hz)",
       "{/:Italic v}_{max}  (mm/s)"},
      {"fig10",
       "fig10",
       {series(1)},
       along(1),
       rise_of,
       1.0,
       1e3,
       -1.0,
       true,
       3.0,
       "{/:Italic f}_{max} / ({/:Italic m g})",
       rise},
      {"fig10",
       "fig10_gravity",
       {series(2)},
       along(2),
       rise_of,
       1.0,
       1e3,
       2.0,
       true,
       5.0,
       "{/:Italic g}  (m/s^2)",
       rise},
      {"fig10",
       "fig10_mass",
       {series(3)},
       along(3),
       rise_of,
       1.0,
       1e3,
       1.0,
       true,
       0.6,
       "{/:Italic m} / ({/:Italic m} + {/:Italic m}_w)",
       rise},
      {"fig11",
       "fig11",
       {series(0), series(1), series(2), series(3)},
       eq3_of,
       rise_of,
       1e3,
       1e3,
       1.0,
       true,
       10.0,
       x,
       rise,
       paper::prefactor},
      {"box",
       "box_slow",
       {{{"5 Hz", {"box"}, is_slow}, Ink::blue}},
       aspect,
       prefactor_of,
       1.0,
       1.0,
       -1.0,
       false,
       1.5,
       "{/:Italic L}/{/:Italic H}",
       c},
      {"box",
       "box_fast",
       {{{"20 Hz", {"box"}, is_fast}, Ink::vermilion}},
       aspect,
       prefactor_of,
       1.0,
       1.0,
       -1.0,
       false,
       1.5,
       "{/:Italic L}/{/:Italic H}",
       c},
      // a run of several families is a point of the first
      {"theory",
       "theory",
       {{{"ν", {"frequency", "slowest", "deposits", "tight", "tightest"}, is_pressed}, Ink::blue},
        {all_series()[1].selection, Ink::vermilion, triangle},
        {all_series()[2].selection, Ink::green, square},
        {all_series()[3].selection, Ink::purple, diamond},
        {{"L/H", {"box"}}, Ink::orange},
        {{"light wall", {"loads"}}, Ink::black, triangle},
        {{"deposit", {"deposits"}}, Ink::grey, square},
        {{"grains, size", {"shapes", "sizes", "reading"}}, Ink::sky, diamond}},
       theory_of,
       prefactor_of,
       1.0,
       1.0,
       1.0,
       false,
       not_known,
       "{/:Italic C} by the theory, from the force as measured",
       c,
       1.0}};
  return all;
}

/// Exponent over part of the points: a law that bends has two.
PowerFit fit_part(const Points& points, double low, double high) {
  Points part;
  for (size_t k = 0; k < points.x.size(); ++k)
    if (points.x[k] >= low && points.x[k] <= high) part.add(points.x[k], {points.y[k]});
  return fit_power(part.x, part.y);
}

/// The measured points are in the panel; beside them the fitted power law, the exponent that is
/// expected through the fit in the middle of the points, and a line of reference.
void draw_lines(const Law& law, const Points& all, const PowerFit& fit, Panel& panel) {
  const auto [low, high] = std::ranges::minmax_element(all.x);
  const Drawn range{*low, *high, true};
  double logs = 0.0;
  for (const double x : all.x) logs += std::log(x) / static_cast<double>(all.x.size());
  const double middle = std::exp(logs);
  panel.curves.push_back(curve_of([&](double x) { return fit.at(x); }, range,
                                  "fit, exponent " + plot_label(page::number(fit.exponent)),
                                  Ink::black));
  if (std::isnan(law.reference))
    panel.curves.push_back(curve_of(
        [&](double x) { return fit.at(middle) * std::pow(x / middle, law.expected); }, range,
        "exponent " + plot_label(page::number(law.expected, 1)), Ink::vermilion, false));
  else
    panel.curves.push_back(curve_of([&](double x) { return law.reference * x; }, range,
                                    law.is_of_paper ? "the paper’s C = 0.01" : "the theory",
                                    Ink::grey));
}

void add_law(PaperData& data, const Law& law, page::Table& table, PaperSection& section) {
  Panel panel{.x_label = law.x_label, .y_label = law.y_label, .log_x = true, .log_y = true};
  std::set<std::string> seen;  // equal runs of several stages and families are one point
  Points all;
  for (const Family& family : law.families) {
    Groups distinct;
    for (Group& group : data.settings(family.selection))
      if (law.is_of_paper || seen.insert(group.samples.front()->key).second)
        distinct.push_back(std::move(group));
    std::ranges::sort(distinct, {}, [&](const Group& group) { return group.mean(law.x).mean; });
    const Points points = points_of(distinct, law.x, law.y, law.x_factor, law.y_factor);
    if (points.x.empty()) continue;
    all.add(points);
    panel.curves.push_back(
        curve_of(points, plain_text(family.selection.name), family.ink, family.shape));
    const PowerFit fit = fit_power(points.x, points.y);
    const Proportion ratio = fit_proportion(points.x, points.y);
    table.rows.push_back({page::words(law.name + std::string(".title")), family.selection.name,
                          std::to_string(points.x.size()), words_of(fit),
                          words_of(misfit_of(fit, points)),
                          law.expected == 1.0 ? words_of(ratio) : page::Text("–")});
  }
  const PowerFit fit = fit_power(all.x, all.y);
  if (!std::isfinite(fit.exponent)) return;
  const Misfit misfit = misfit_of(fit, all);
  const Proportion ratio = fit_proportion(all.x, all.y);
  const page::Values words{{"points", std::to_string(all.x.size())},
                           {"exponent", words_of(fit)},
                           {"misfit", words_of(misfit)},
                           {"low", words_of(fit_part(all, 0.0, law.split))},
                           {"high", words_of(fit_part(all, law.split, 1e9))},
                           {"ratio", words_of(ratio)},
                           {"spread", page::number(ratio.spread)}};
  draw_lines(law, all, fit, panel);
  section.draw(law.name, {.height = 480, .panels = {panel}}, words);
  const std::string claim = law.name + std::string(".claim");
  if (!law.is_of_paper) return section.report(claim, words);
  section.claim(claim, words, PaperRange::exponent(law.expected), found(fit, misfit.p));
  if (law.reference == paper::prefactor)
    section.claim("fig11.factor", words, PaperRange::roughly(paper::prefactor),
                  {.value = ratio.factor, .low = ratio.low, .high = ratio.high});
}

}  // namespace

void add_laws(PaperData& data, PaperSection& section) {
  page::Table table = page::words_table("laws");
  for (const Law& law : laws())
    if (section.id == law.section) add_law(data, law, table, section);
  if (!table.rows.empty()) section.text.push_back(page::words("misfit"));
  section.add(std::move(table));
}

}  // namespace ballast
