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

/// What an axis shows.
struct Axis {
  RunMeasure measure;
  const char* label;
  double factor;  ///< from SI
};

/// Measured means against a law y ~ x^exponent, one figure.
struct Law {
  const char *section, *name;  ///< its words are <name>.title, .paper, .found, .claim
  std::vector<Family> families;
  Axis x, y;
  double exponent;               ///< of the paper, or of the theory
  double split = not_known;      ///< exponents up to here and from here on are said too; NaN: none
  double reference = not_known;  ///< y = reference x is drawn too
  bool is_of_paper = false;      ///< judged; else a finding
};

constexpr Axis rise_axis{rise_of, "Δ{/:Italic x}_{max}  (mm)", 1e3},
    prefactor_axis{prefactor_of, "{/:Italic C} = Δ{/:Italic x}_{max} / {/:Italic X}", 1.0};

Family family_of(const Series& series) { return {series.selection, series.ink, series.shape}; }

/// Figs. 9 to 11.
std::vector<Law> paper_laws() {
  const auto series = all_series();
  const Axis frequency{frequency_of, "{/:Italic ν}  (Hz)", 1.0},
      speed{speed_of, "{/:Italic v}_{max}  (mm/s)", 1e3},
      force{series[1].along, "{/:Italic f}_{max} / ({/:Italic m g})", 1.0},
      gravity{series[2].along, "{/:Italic g}  (m/s^2)", 1.0},
      mass{series[3].along, "{/:Italic m} / ({/:Italic m} + {/:Italic m}_w)", 1.0},
      eq3{eq3_of, "right side of Eq. 3 without {/:Italic C}  (mm)", 1e3};
  std::vector<Family> all;
  for (const Series& one : series) all.push_back(family_of(one));
  std::vector<Law> laws;
  laws.push_back({"fig9", "fig9", {all[0]}, frequency, rise_axis, -2.0, 10.0});
  laws.push_back({"fig9", "fig9_speed", {all[0]}, frequency, speed, -1.0, 10.0});
  laws.push_back({"fig10", "fig10", {all[1]}, force, rise_axis, -1.0, 3.0});
  laws.push_back({"fig10", "fig10_gravity", {all[2]}, gravity, rise_axis, 2.0, 5.0});
  laws.push_back({"fig10", "fig10_mass", {all[3]}, mass, rise_axis, 1.0, 0.6});
  laws.push_back({"fig11", "fig11", all, eq3, rise_axis, 1.0, 10.0, paper::prefactor});
  for (Law& law : laws) law.is_of_paper = true;
  return laws;
}

/// C along the shape of the box, and against its theory.
std::vector<Law> prefactor_laws() {
  using enum MarkShape;
  const RunMeasure aspect_of = [](const RunSummary& run) {
    return run.facts.length / run.facts.height;
  };
  const auto is_slow = [](const RunRow& row) { return frequency_of(row.run) == 5.0; };
  const auto is_fast = [](const RunRow& row) { return frequency_of(row.run) == 20.0; };
  const auto is_pressed = [](const RunRow& row) {
    return row.stage != "deposits" ||
           (row.run.facts.lid_pressure > 0.0 && row.run.facts.deposit_friction == 0.4);
  };
  const Axis aspect{aspect_of, "{/:Italic L}/{/:Italic H}", 1.0},
      theory{theory_of, "{/:Italic C} by the theory, from the force as measured", 1.0};
  const Selection slow{"5 Hz", {"box"}, is_slow}, fast{"20 Hz", {"box"}, is_fast},
      pressed{"ν", {"frequency", "slowest", "deposits", "tight", "tightest"}, is_pressed};
  // a run of several families is a point of the first
  std::vector<Family> all{{pressed, Ink::blue}};
  constexpr std::pair<Ink, MarkShape> looks[] = {
      {Ink::vermilion, triangle}, {Ink::green, square}, {Ink::purple, diamond}};
  for (size_t k = 0; k < std::size(looks); ++k)
    all.push_back({all_series()[k + 1].selection, looks[k].first, looks[k].second});
  all.push_back({{"L/H", {"box"}}, Ink::orange});
  all.push_back({{"light wall", {"loads"}}, Ink::black, triangle});
  all.push_back({{"deposit", {"deposits"}}, Ink::grey, square});
  all.push_back({{"grains, size", {"shapes", "sizes", "reading"}}, Ink::sky, diamond});
  return {{"box", "box_slow", {{slow, Ink::blue}}, aspect, prefactor_axis, -1.0, 1.5},
          {"box", "box_fast", {{fast, Ink::vermilion}}, aspect, prefactor_axis, -1.0, 1.5},
          {"theory", "theory", all, theory, prefactor_axis, 1.0, not_known, 1.0}};
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
        [&](double x) { return fit.at(middle) * std::pow(x / middle, law.exponent); }, range,
        "exponent " + plot_label(page::number(law.exponent, 1)), Ink::vermilion, false));
  else
    panel.curves.push_back(curve_of([&](double x) { return law.reference * x; }, range,
                                    law.is_of_paper ? "the paper’s C = 0.01" : "the theory",
                                    Ink::grey));
}

void add_law(PaperData& data, const Law& law, page::Table& table, PaperSection& section) {
  Panel panel{.x_label = law.x.label, .y_label = law.y.label, .log_x = true, .log_y = true};
  std::set<std::string> seen;  // equal runs of several stages and families are one point
  Points all;
  for (const Family& family : law.families) {
    Groups distinct;
    for (Group& group : data.settings(family.selection))
      if (law.is_of_paper || seen.insert(group.samples.front()->key).second)
        distinct.push_back(std::move(group));
    std::ranges::sort(distinct, {},
                      [&](const Group& group) { return group.mean(law.x.measure).mean; });
    const Points points =
        points_of(distinct, law.x.measure, law.y.measure, law.x.factor, law.y.factor);
    if (points.x.empty()) continue;
    all.add(points);
    panel.curves.push_back(
        curve_of(points, plain_text(family.selection.name), family.ink, family.shape));
    const PowerFit fit = fit_power(points.x, points.y);
    const Proportion ratio = fit_proportion(points.x, points.y);
    table.rows.push_back({page::words(law.name + std::string(".title")), family.selection.name,
                          std::to_string(points.x.size()), words_of(fit),
                          words_of(misfit_of(fit, points)),
                          law.exponent == 1.0 ? words_of(ratio) : page::Text("–")});
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
  section.claim(claim, words, PaperRange::exponent(law.exponent), found(fit, misfit.p));
  if (law.reference == paper::prefactor)
    section.claim("fig11.factor", words, PaperRange::roughly(paper::prefactor),
                  {.value = ratio.factor, .low = ratio.low, .high = ratio.high});
}

}  // namespace

void add_laws(PaperData& data, PaperSection& section) {
  page::Table table = page::words_table("laws");
  static const std::vector<Law> kinds[] = {paper_laws(), prefactor_laws()};
  for (const auto& laws : kinds)
    for (const Law& law : laws)
      if (section.id == law.section) add_law(data, law, table, section);
  if (!table.rows.empty()) section.text.push_back(page::words("misfit"));
  section.add(std::move(table));
}

}  // namespace ballast
