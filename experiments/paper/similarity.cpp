// Exponents from point to point, and what must hold of them whatever the grains do: with rigid
// grains, one size d and one load, Delta x_max/d = F(g/(d nu^2), f_max/(m g), m_w/m, mu) and
// v_max/sqrt(g d) is of the same arguments.

#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/investigation.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

/// The quantity in every sample that both values have.
template <class Function>
SampleMean over_common(const VariedValue& a, const VariedValue& b, double Observation::*quantity,
                       const Function& f) {
  std::vector<double> values;
  for (size_t k = 0; k < a.samples.size(); ++k)
    if (const Observation* other = b.of_seed(a.seeds[k]))
      values.push_back(f(a.samples[k].*quantity, other->*quantity));
  return sample_mean(values);
}

struct Quantity {
  double Observation::*value;
  const char *name, *axis;
  double in_frequency;  ///< the paper's exponents; NaN: none
  double in_force;
  double in_scale;  ///< power of the scale of lengths at the same g/(d nu^2)
  double to_milli;
};
constexpr Quantity quantities[] = {
    {&Observation::rise, "Δx_max", "exponent of Δ{/:Italic x}_{max}", -2.0, -1.0, 1.0, 1e3},
    {&Observation::speed_in, "v_max", "exponent of  {/:Italic v}_{max}", -1.0, not_known, 0.5,
     1e3}};

/// Exponents between neighbours, each at their geometric middle.
VariedCurve local_curve(const std::vector<VariedValue>& values, double Observation::*quantity) {
  VariedCurve curve;
  for (size_t k = 1; k < values.size(); ++k) {
    const SampleMean exponent = exponent_between(values[k - 1], values[k], quantity);
    if (!std::isfinite(exponent.mean)) continue;
    curve.x.push_back(std::sqrt(values[k - 1].value * values[k].value));
    curve.y.push_back(exponent.mean);
    curve.error.push_back(exponent.error);
  }
  return curve;
}

/// How much a standard error from so few samples is worth.
page::Text error_meaning(const std::vector<VariedValue>& values) {
  const int samples = static_cast<int>(values.front().samples.size());
  if (samples < 2) return "One sample: no errors.";
  return "The 95 % interval of a mean over " + std::to_string(samples) + " samples is " +
         page::number(student_t95(samples - 1), 2) + " standard errors to both sides.";
}

page::Table local_table(const std::vector<VariedValue>& values, const std::string& caption,
                        const std::string& head) {
  page::Table table{caption, {head, "Δx_max", "v_max"}, {}};
  for (size_t k = 1; k < values.size(); ++k) {
    table.rows.push_back({values[k - 1].label + " to " + values[k].label});
    for (const Quantity& quantity : quantities) {
      const SampleMean exponent = exponent_between(values[k - 1], values[k], quantity.value);
      table.rows.back().push_back(page::with_error(exponent.mean, exponent.error));
    }
  }
  return table;
}

void draw_local(const Quantity& quantity, const std::vector<VariedValue>& values, double expected,
                Panel& panel) {
  const VariedCurve curve = local_curve(values, quantity.value);
  panel.curves = {points_of(curve.x, curve.y, curve.error,
                            "neighbours, mean over samples ± standard error", Ink::blue)};
  if (std::isfinite(expected))
    panel.lines = {
        {expected, "the paper’s " + plot_label(page::number(expected, 1)), false, Ink::vermilion}};
}

/// From the first pair to the last.
page::Text trend_words(const std::vector<VariedValue>& values, const Quantity& quantity) {
  const SampleMean first = exponent_between(values[0], values[1], quantity.value),
                   last =
                       exponent_between(values[values.size() - 2], values.back(), quantity.value);
  return std::string(quantity.name) + ": from " + page::with_error(first.mean, first.error) + " (" +
         values[0].label + " to " + values[1].label + ") to " +
         page::with_error(last.mean, last.error) + " (" + values[values.size() - 2].label + " to " +
         values.back().label + ")";
}

page::Text both_trends(const std::vector<VariedValue>& values) {
  return trend_words(values, quantities[0]) + "; " + trend_words(values, quantities[1]);
}

void add_by_frequency(const std::vector<VariedValue>& values, const std::vector<Variant>& variants,
                      PaperSection& section) {
  PaperFigure figure;
  figure.plot.name = "exponents_frequency";
  figure.plot.title = "Local exponents against frequency";
  figure.plot.height = 700;
  constexpr Ink inks[] = {Ink::vermilion, Ink::green, Ink::purple, Ink::orange};
  for (const Quantity& quantity : quantities) {
    figure.plot.panels.push_back(frequency_panel(quantity.axis));
    draw_local(quantity, values, quantity.in_frequency, figure.plot.panels.back());
    size_t ink = 0;
    for (const Variant& variant : variants) {
      if (variant.reference < 0 || variant.values.size() < 3 || ink == std::size(inks)) continue;
      const VariedCurve curve = local_curve(variant.values, quantity.value);
      figure.plot.panels.back().curves.push_back(points_of(
          curve.x, curve.y, curve.error, plain_text(variant.name) + ", sample 1", inks[ink++]));
    }
  }
  figure.paper = page::words("exponents_frequency.paper");
  figure.found = page::words("exponents_frequency.found",
                             {{"errors", error_meaning(values)}, {"trends", both_trends(values)}});
  section.figures.push_back(figure);
  section.tables.push_back(local_table(
      values,
      "Exponents of ν between neighbouring frequencies (mean over samples ± standard error)", "ν"));
  section.rows.push_back(
      {"beyond", "one exponent of ν from 1 to 60 Hz", both_trends(values), Agreement::reported});
}

void add_by_force(const std::vector<VariedValue>& values, PaperSection& section) {
  PaperFigure figure;
  figure.plot.name = "exponents_force";
  figure.plot.title = "Local exponents against the force amplitude";
  figure.plot.height = 640;
  for (const Quantity& quantity : quantities) {
    Panel& panel = figure.plot.panels.emplace_back();
    panel.x_label = "{/:Italic f}_{max} / {/:Italic m g}";
    panel.y_label = quantity.axis;
    draw_local(quantity, values, quantity.in_force, panel);
  }
  figure.paper = page::words("exponents_force.paper");
  figure.found =
      page::words("exponents_force.found", {{"frequency", page::number(varied_frequency, 1)},
                                            {"errors", error_meaning(values)},
                                            {"trends", both_trends(values)}});
  section.figures.push_back(figure);
  section.tables.push_back(local_table(
      values,
      "Exponents of f_max between neighbouring loads at 10 Hz (mean over samples ± standard error)",
      "f_max/(m g)"));
  section.rows.push_back({"beyond", "Δx_max ~ f_max^−1 for f_max ≫ m g",
                          trend_words(values, quantities[0]), Agreement::reported});
}

const VariedValue* value_at(const std::vector<VariedValue>& values, double at) {
  for (const VariedValue& value : values)
    if (value.value == at) return &value;
  return nullptr;
}

/// Measured against predicted, a row for each quantity; in words.
page::Text compare_half_scale(const VariedValue& below, const VariedValue& above, double same,
                              const VariedValue& half, page::Table& table) {
  page::Text found;
  for (const Quantity& quantity : quantities) {
    const SampleMean full = interpolated(below, above, same, quantity.value),
                     seen = half.mean(quantity.value);
    const double factor = std::pow(0.5, quantity.in_scale), unit = quantity.to_milli;
    const double difference = seen.mean - factor * full.mean,
                 error = std::hypot(seen.error, factor * full.error);
    const char* name = quantity.name;
    table.rows.push_back(
        {half.label, std::string(name) + (quantity.in_scale == 1.0 ? " (mm)" : " (mm/s)"),
         page::with_error(unit * full.mean, unit * full.error), page::number(factor),
         page::with_error(unit * factor * full.mean, unit * factor * full.error),
         page::with_error(unit * seen.mean, unit * seen.error),
         page::percent(difference / (factor * full.mean)),
         page::number(std::abs(difference) / error, 2)});
    found += (found.empty() ? "" : "; ") + std::string(name) + " " +
             page::percent(difference / (factor * full.mean)) + " (" +
             page::number(std::abs(difference) / error, 2) + " standard errors)";
  }
  return found;
}

/// The half-scale box at 10 Hz is the full one at 10/sqrt(2) Hz, or rigid grains are not what we
/// simulate.
void add_half_scale(PaperData& data, const std::vector<VariedValue>& frequencies,
                    PaperSection& section) {
  const std::vector<VariedValue> sizes = data.values(Varied::size);
  const VariedValue *below = value_at(frequencies, 7.0),
                    *above = value_at(frequencies, varied_frequency);
  if (!below || !above) return;
  const double same = varied_frequency * std::sqrt(0.5);
  page::Table table{
      "The box at half scale, 10 Hz, beside what the full box must give for it at " +
          page::number(same) +
          " Hz (between 7 and 10 Hz on a power law; mean over samples ± standard error)",
      {"", "", "full box", "scaled by", "predicted", "half scale, measured", "difference",
       "in standard errors"},
      {}};
  page::Text words;
  for (const auto& [which, name] : {std::pair{similar_case, "with the lid’s gap at half scale too"},
                                    std::pair{half_scale_case, "with the lid’s 1 cm as it is"}}) {
    const VariedValue* half = value_at(sizes, which);
    if (!half) continue;
    const page::Text found = compare_half_scale(*below, *above, same, *half, table);
    words += std::string(words.empty() ? "" : "; ") + name + ": " + found;
    section.rows.push_back({"beyond",
                            std::string("half-scale box = full box at ν/√2 (similarity), ") + name,
                            found, Agreement::reported});
  }
  if (table.rows.empty()) return;
  section.tables.push_back(table);
  section.text.push_back(page::words("similarity.half_scale", {{"found", words}}));
}

std::vector<VariedValue> between(const std::vector<VariedValue>& values, double low, double high) {
  std::vector<VariedValue> part;
  for (const VariedValue& value : values)
    if (value.value >= low && value.value <= high) part.push_back(value);
  return part;
}

PowerFit fit_of(const std::vector<VariedValue>& values) {
  const VariedCurve curve = curve_of_values(values, &Observation::rise);
  return fit_power(curve.x, curve.y);
}

/// Delta x_max = (g/nu^2) (d nu^2/g)^(1 + alpha/2) (f_max/(m g))^beta: the exponent of g at
/// constant f_max is -alpha/2 - beta.
void add_gravity(PaperData& data, const std::vector<VariedValue>& frequencies,
                 const std::vector<VariedValue>& forces, PaperSection& section) {
  const PowerFit alpha = fit_of(between(frequencies, 7.0, 20.0)), beta = fit_of(forces),
                 gravity = fit_of(data.values(Varied::gravity));
  if (!std::isfinite(alpha.half_width) || !std::isfinite(beta.half_width) ||
      !std::isfinite(gravity.half_width))
    return;
  const double predicted = -0.5 * alpha.exponent - beta.exponent,
               half = std::hypot(0.5 * alpha.half_width, beta.half_width);
  const page::Text words = "−α/2 − β = " + page::number(predicted) + " " +
                           page::interval(predicted - half, predicted + half) +
                           " from α = " + page::number(alpha.exponent) +
                           " (ν, 7–20 Hz) and β = " + page::number(beta.exponent) +
                           " (f_max); measured: " + words_of(gravity);
  section.text.push_back("The exponent of g at constant f_max is not free either: " + words +
                         ". The paper’s +2 follows from its −2 and −1.");
  section.rows.push_back(
      {"beyond", "exponent of g = −α/2 − β (similarity)", words, Agreement::reported});
}

}  // namespace

SampleMean exponent_between(const VariedValue& a, const VariedValue& b,
                            double Observation::*quantity) {
  const double span = std::log(b.value / a.value);
  return over_common(a, b, quantity,
                     [&](double qa, double qb) { return std::log(qb / qa) / span; });
}

SampleMean interpolated(const VariedValue& a, const VariedValue& b, double at,
                        double Observation::*quantity) {
  const double w = std::log(at / a.value) / std::log(b.value / a.value);
  return over_common(a, b, quantity,
                     [&](double qa, double qb) { return qa * std::pow(qb / qa, w); });
}

void add_local_exponents(PaperData& data, const std::vector<Variant>& variants,
                         PaperSection& section) {
  const std::vector<VariedValue> frequencies = data.values(Varied::frequency),
                                 forces = data.values(Varied::force);
  if (frequencies.size() > 2) add_by_frequency(frequencies, variants, section);
  if (forces.size() > 2) add_by_force(forces, section);
}

void add_similarity(PaperData& data, PaperSection& section) {
  const std::vector<VariedValue> frequencies = data.values(Varied::frequency),
                                 forces = data.values(Varied::force);
  add_half_scale(data, frequencies, section);
  add_gravity(data, frequencies, forces, section);
}

}  // namespace ballast
