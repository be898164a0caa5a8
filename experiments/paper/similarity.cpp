// Exponents from point to point, and what must hold of them whatever the grains do: with rigid
// grains, one size d and one load, Delta x_max/d = F(g/(d nu^2), f_max/(m g), m_w/m, mu) and
// v_max/sqrt(g d) is of the same arguments.

#include <array>
#include <cmath>

#include "experiments/paper/run_groups.hpp"

namespace ballast {
namespace {

struct Quantity {
  double Observation::*value;
  const char *name, *unit, *axis;
  double in_frequency;  ///< the paper's exponents; NaN: none
  double in_force;
  double in_scale;  ///< power of the scale of lengths at the same g/(d nu^2)
};
constexpr std::array quantities{Quantity{&Observation::rise, "Δx_max", "mm",
                                         "exponent of Δ{/:Italic x}_{max}", -2.0, -1.0, 1.0},
                                Quantity{&Observation::speed_in, "v_max", "mm/s",
                                         "exponent of  {/:Italic v}_{max}", -1.0, not_known, 0.5}};

/// Two neighbouring values of what is varied, and the exponents of the quantities between them.
struct Neighbours {
  const VariedValue &below, &above;
  std::array<SampleMean, quantities.size()> exponents = {};

  page::Text name() const { return below.label + " to " + above.label; }
  double middle() const { return std::sqrt(below.value * above.value); }
};

std::vector<Neighbours> neighbours_of(const std::vector<VariedValue>& values) {
  std::vector<Neighbours> pairs;
  for (size_t k = 1; k < values.size(); ++k) {
    Neighbours& pair = pairs.emplace_back(Neighbours{values[k - 1], values[k]});
    for (size_t q = 0; q < quantities.size(); ++q)
      pair.exponents[q] = exponent_between(pair.below, pair.above, quantities[q].value);
  }
  return pairs;
}

VariedCurve local_curve(const std::vector<Neighbours>& pairs, size_t quantity) {
  VariedCurve curve;
  for (const Neighbours& pair : pairs) {
    const SampleMean& exponent = pair.exponents[quantity];
    if (!std::isfinite(exponent.mean)) continue;
    curve.x.push_back(pair.middle());
    curve.y.push_back(exponent.mean);
    curve.error.push_back(exponent.error);
  }
  return curve;
}

/// How much a standard error from so few samples is worth.
page::Text error_meaning(const std::vector<VariedValue>& values) {
  const int samples = static_cast<int>(values.front().samples.size());
  if (samples < 2) return "One sample: no errors.";
  return page::words("local.errors", {{"samples", std::to_string(samples)},
                                      {"factor", page::number(student_t95(samples - 1), 2)}});
}

/// From the first pair to the last.
page::Text trend_words(const std::vector<Neighbours>& pairs, size_t quantity) {
  const auto at = [&](const Neighbours& pair) {
    return words_of(pair.exponents[quantity]) + " (" + pair.name() + ")";
  };
  return std::string(quantities[quantity].name) + ": from " + at(pairs.front()) + " to " +
         at(pairs.back());
}

/// A figure and a table of the exponents along what is varied. `name`: of the words.
/// `expected`: the paper's exponents. `causes`: drawn beside.
void add_local(const std::string& name, int height, const Panel& axes,
               const std::vector<VariedValue>& values, double Quantity::*expected,
               const std::vector<RunGroup>& causes, PaperSection& section) {
  constexpr std::array inks{Ink::vermilion, Ink::green, Ink::purple, Ink::orange};
  const std::vector<Neighbours> pairs = neighbours_of(values);
  Figure figure{.height = height};
  for (size_t q = 0; q < quantities.size(); ++q) {
    Panel& panel = figure.panels.emplace_back(axes);
    panel.y_label = quantities[q].axis;
    const auto add = [&](const std::vector<Neighbours>& of, const std::string& title, Ink ink) {
      panel.curves.push_back(points_of(local_curve(of, q), title, ink));
    };
    add(pairs, std::string("neighbours, ") + mean_title, Ink::blue);
    if (const double law = quantities[q].*expected; std::isfinite(law))
      panel.lines = {
          {law, "the paper’s " + plot_label(page::number(law, 1)), false, Ink::vermilion}};
    // a cause is known by its ink, so there are no more of them than inks
    for (const RunGroup& cause : causes)
      if (cause.reference >= 0 && cause.values.size() > 2 && panel.curves.size() <= inks.size())
        add(neighbours_of(cause.values), plain_text(cause.name) + ", sample 1",
            inks[panel.curves.size() - 1]);
  }
  page::Table table = page::words_table(name + ".table");
  for (const Neighbours& pair : pairs)
    table.rows.push_back({pair.name(), words_of(pair.exponents[0]), words_of(pair.exponents[1])});
  section.tables.push_back(table);
  // the claim is of those quantities of which the paper has a law
  page::Text of_law, trends;
  for (size_t q = 0; q < quantities.size(); ++q) {
    add_to_list(trends, trend_words(pairs, q));
    if (std::isfinite(quantities[q].*expected)) add_to_list(of_law, trend_words(pairs, q));
  }
  const page::Values words{
      {"errors", error_meaning(values)}, {"trends", trends}, {"of_law", of_law}};
  section.draw(name, figure, words);
  section.report(name + ".claim", words);
}

/// Measured against predicted, a row for each quantity; in words. `full`: the full box's
/// quantities at the frequency that is similar. `scatter`: of their logarithms.
page::Text compare_half_scale(const VariedValue& half,
                              const std::array<SampleMean, quantities.size()>& full,
                              const std::array<PooledError, quantities.size()>& scatter,
                              page::Table& table) {
  page::Text found;
  for (size_t q = 0; q < quantities.size(); ++q) {
    const Quantity& quantity = quantities[q];
    const SampleMean seen = half.mean(quantity.value);
    // lengths halve, so that a quantity of dimension length^p scales by (1/2)^p
    const double factor = std::pow(0.5, quantity.in_scale), predicted = factor * full[q].mean;
    const Difference difference{
        std::log(seen.mean / predicted),
        scatter[q].deviation * std::sqrt(1.0 / seen.samples + 1.0 / full[q].samples),
        scatter[q].degrees_of_freedom};
    const page::Text relative = page::percent(difference.mean) + " ± " +
                                page::number(100.0 * difference.half_width(), 2) + " %",
                     chance = words_of_p(difference.p());
    table.rows.push_back({half.label, std::string(quantity.name) + " (" + quantity.unit + ")",
                          words_of(full[q], 1e3), page::number(factor),
                          words_of(full[q], 1e3 * factor), words_of(seen, 1e3), relative, chance});
    add_to_list(found, std::string(quantity.name) + " " + relative + " (p " + chance + ")");
  }
  return found;
}

/// The half-scale box at 10 Hz is the full one at 10/sqrt(2) Hz, or rigid grains are not what we
/// simulate.
void add_half_scale(PaperData& data, const RunGroup& frequencies, PaperSection& section) {
  const VariedValue *below = frequencies.at(7.0), *above = frequencies.at(varied_frequency);
  if (!below || !above) return;
  const double same = varied_frequency * std::sqrt(0.5);
  // no run has that frequency: each sample is interpolated between 7 and 10 Hz
  std::array<SampleMean, quantities.size()> full;
  std::array<PooledError, quantities.size()> scatter;
  for (size_t q = 0; q < quantities.size(); ++q) {
    full[q] = interpolated(*below, *above, same, quantities[q].value);
    scatter[q] = scatter_between(frequencies.values, quantities[q].value);
  }
  const RunGroup sizes{"size", data.values(Varied::size)};
  page::Table table = page::words_table("similarity.table", {{"same", page::number(same)}});
  page::Text found;
  for (const auto& [which, name] : {std::pair{similar_case, "with the lid’s gap at half scale too"},
                                    std::pair{half_scale_case, "with the lid’s 1 cm as it is"}}) {
    const VariedValue* half = sizes.at(which);
    if (!half) continue;
    const page::Text of_half = compare_half_scale(*half, full, scatter, table);
    add_to_list(found, std::string(name) + ": " + of_half);
    section.report("similarity.claim", {{"how", name}, {"found", of_half}});
  }
  if (table.rows.empty()) return;
  section.tables.push_back(table);
  section.text.push_back(page::words("similarity.half_scale", {{"found", found}}));
}

PowerFit rise_fit(const std::vector<VariedValue>& values) {
  const VariedCurve curve = curve_of_values(values, &Observation::rise);
  return fit_power(curve.x, curve.y);
}

/// Delta x_max = (g/nu^2) (d nu^2/g)^(1 + alpha/2) (f_max/(m g))^beta: the exponent of g at
/// constant f_max is -alpha/2 - beta.
void add_gravity(PaperData& data, std::vector<VariedValue> frequencies,
                 const std::vector<VariedValue>& forces, PaperSection& section) {
  std::erase_if(frequencies, [](const VariedValue& v) { return v.value < 7.0 || v.value > 20.0; });
  const PowerFit alpha = rise_fit(frequencies), beta = rise_fit(forces),
                 gravity = rise_fit(data.values(Varied::gravity));
  if (!std::isfinite(alpha.half_width) || !std::isfinite(beta.half_width) ||
      !std::isfinite(gravity.half_width))
    return;
  // errors of independent fits add up in squares
  const double predicted = -0.5 * alpha.exponent - beta.exponent,
               half = std::hypot(0.5 * alpha.half_width, beta.half_width);
  const page::Text found = page::words(
      "gravity.found", {{"predicted", page::number(predicted)},
                        {"interval", page::interval(predicted - half, predicted + half)},
                        {"alpha", page::number(alpha.exponent)},
                        {"beta", page::number(beta.exponent)},
                        {"measured", words_of(gravity)}});
  section.text.push_back(page::words("gravity.text", {{"found", found}}));
  section.report("gravity.claim", {{"found", found}});
}

}  // namespace

void add_local_exponents(PaperData& data, const std::vector<RunGroup>& causes,
                         PaperSection& section) {
  const std::vector<VariedValue> frequencies = data.values(Varied::frequency),
                                 forces = data.values(Varied::force);
  if (frequencies.size() > 2)
    add_local("exponents_frequency", 700, frequency_panel(""), frequencies, &Quantity::in_frequency,
              causes, section);
  if (forces.size() > 2)
    add_local("exponents_force", 640, {.x_label = "{/:Italic f}_{max} / ({/:Italic m g})"}, forces,
              &Quantity::in_force, {}, section);
}

void add_similarity(PaperData& data, PaperSection& section) {
  const RunGroup frequencies{"frequency", data.values(Varied::frequency)};
  add_half_scale(data, frequencies, section);
  add_gravity(data, frequencies.values, data.values(Varied::force), section);
}

}  // namespace ballast
