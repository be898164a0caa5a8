// Fig. 10: Delta x_max against the force amplitude, exponent -1; beside it gravity (+2) and the
// wall's mass, which Eq. 3 holds too.

#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

struct Abscissa {
  Varied varied;
  const char* what;      ///< for the note on what is missing
  const char* label;     ///< of the axis
  const char* relation;  ///< "Δx_max ~ f_max^−1"
  const char* place;
  double exponent;
};

/// x of the fit: f_max [N], g [m/s^2], or m/(m + m_w).
double abscissa_of(const VariedValue& value, Varied varied) {
  const Observation& seen = value.samples.front();
  if (varied == Varied::gravity) return seen.facts.gravity;
  if (varied == Varied::wall_mass)
    return seen.facts.grain_mass / (seen.facts.grain_mass + seen.facts.wall_mass);
  return value.value;  // f_max over the weight under 9.81 m/s^2: the same for all seeds
}

void add_figure(PaperData& data, const Abscissa& axis, const std::string& name,
                PaperSection& section) {
  const std::vector<VariedValue> values = data.values(axis.varied);
  note_missing(data, axis.varied, axis.what, section);
  if (values.size() < 2) return;
  VariedCurve curve = curve_of_values(values, &Observation::rise, 1e3);
  for (size_t k = 0; k < values.size(); ++k) curve.x[k] = abscissa_of(values[k], axis.varied);
  const PowerFit fit = fit_power(curve.x, curve.y);
  Panel panel;
  panel.x_label = axis.label;
  panel.y_label = "Δ{/:Italic x}_{max}  (mm)";
  panel.log_x = panel.log_y = true;
  panel.curves = {
      points_of(curve.x, curve.y, curve.error, "mean over samples ± standard error", Ink::blue)};
  if (std::isfinite(fit.exponent)) {
    const auto [low, high] = std::minmax_element(curve.x.begin(), curve.x.end());
    panel.curves.push_back(curve_of([&](double x) { return fit.at(x); }, *low, *high, true,
                                    "fit, exponent " + plot_label(page::number(fit.exponent)),
                                    Ink::black));
    const double middle = std::sqrt(*low * *high);
    panel.curves.push_back(curve_of(
        [&](double x) { return fit.at(middle) * std::pow(x / middle, axis.exponent); }, *low, *high,
        true, "the paper’s exponent " + plot_label(page::number(axis.exponent, 1)), Ink::vermilion,
        false));
  }
  PaperFigure figure;
  figure.plot.name = name;
  figure.plot.title = std::string("Maximum displacement: ") + axis.relation;
  figure.plot.height = 440;
  figure.plot.panels = {panel};
  figure.paper = std::string(axis.relation) + " (" + axis.place + ").";
  figure.found = page::words("fig10.found", {{"exponent", words_of(fit)},
                                             {"misfit", misfit_words(fit, curve)},
                                             {"frequency", page::number(varied_frequency)},
                                             {"end", page::number(varied_duration)}});
  section.figures.push_back(figure);
  section.rows.push_back({axis.place, axis.relation,
                          words_of(fit) + ", " + misfit_words(fit, curve),
                          judge_exponent(fit, axis.exponent)});
}

}  // namespace

PaperSection fig10_section(PaperData& data) {
  PaperSection section;
  section.text = {page::words("fig10.intro"), page::words("misfit")};
  add_figure(data,
             {Varied::force, "values of f_max", "{/:Italic f}_{max} / {/:Italic m g}",
              "Δx_max ~ f_max^−1", "Fig. 10", -1.0},
             "fig10", section);
  add_figure(
      data, {Varied::gravity, "values of g", "{/:Italic g}  (m/s^2)", "Δx_max ~ g^2", "Eq. 3", 2.0},
      "fig10_gravity", section);
  add_figure(data,
             {Varied::wall_mass, "values of m_w", "{/:Italic m} / ({/:Italic m} + {/:Italic m}_w)",
              "Δx_max ~ m/(m + m_w)", "Eq. 3", 1.0},
             "fig10_mass", section);
  return section;
}

}  // namespace ballast
