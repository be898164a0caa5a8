// Where the paper and Ballast differ: exponents, C and compaction under each cause that was varied,
// beside what the samples scatter.

#include "experiments/paper/investigation.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

constexpr double slow_end = varied_frequency, fast_end = fast_frequency;

/// Exponent between 10 and 60 Hz.
SampleMean overall(const Variant& variant, double Observation::*quantity) {
  const VariedValue *a = variant.at(slow_end), *b = variant.at(fast_end);
  return a && b ? exponent_between(*a, *b, quantity) : SampleMean{};
}

/// Standard deviation of one sample: what another set of grains changes.
double deviation_of(const SampleMean& mean) {
  return mean.error * std::sqrt(static_cast<double>(mean.samples));
}

page::Text error_words(const SampleMean& mean) { return page::with_error(mean.mean, mean.error); }

page::Table exponents_table(const std::vector<Variant>& variants) {
  page::Table table{
      "Exponents in ν under each cause: between 10 and 60 Hz (mean over samples ± standard error), "
      "and "
      "fitted over 5, 10, 20 and 60 Hz with 95 % intervals; C of Eq. 3; solid fractions at 10 Hz",
      {"varied", "samples", "Δx_max, 10–60 Hz", "Δx_max, fit", "v_max, 10–60 Hz", "v_max, fit",
       "C at 10 Hz", "C at 60 Hz", "ρ before", "ρ₀"},
      {}};
  for (const Variant& variant : variants) {
    const VariedCurve rise = curve_of_values(variant.values, &Observation::rise),
                      speed = curve_of_values(variant.values, &Observation::speed_in);
    const auto fit = [](const VariedCurve& curve) {
      return curve.x.size() < 3 ? page::Text("–") : words_of(fit_power(curve.x, curve.y));
    };
    const VariedValue *a = variant.at(slow_end), *b = variant.at(fast_end);
    const auto of = [](const VariedValue* value, double Observation::*quantity) {
      return value ? page::number(value->mean(quantity).mean, 4) : page::Text("–");
    };
    table.rows.push_back(
        {variant.name, std::to_string(variant.values.front().samples.size()),
         error_words(overall(variant, &Observation::rise)), fit(rise),
         error_words(overall(variant, &Observation::speed_in)), fit(speed),
         a ? error_words(prefactor_of(*a)) : "–", b ? error_words(prefactor_of(*b)) : "–",
         of(a, &Observation::solid_initial), of(a, &Observation::solid_reference)});
  }
  return table;
}

/// Frequency at which the rate is largest; NaN when fewer than three are known.
double peak_of(const Variant& variant, double Observation::*rate) {
  double at = not_known, most = -1e300;
  int known = 0;
  for (const VariedValue& value : variant.values) {
    const double mean = value.mean(rate).mean;
    if (!std::isfinite(mean)) continue;
    ++known;
    if (mean > most) {
      most = mean;
      at = value.value;
    }
  }
  return known < 3 ? not_known : at;
}

page::Table rates_table(const std::vector<Variant>& variants) {
  page::Table table{
      "Compaction rate (1/s) under each cause, in the paper’s window and in the same absolute time "
      "for all "
      "frequencies (mean over samples ± standard error)",
      {"varied", "window"},
      {}};
  for (const double frequency : compared_frequencies)
    table.head.push_back(page::number(frequency, 1) + " Hz");
  table.head.push_back("largest at");
  for (const Variant& variant : variants) {
    if (variant.values.size() < 3) continue;  // shorter runs: another window
    for (const auto& [name, rate] : {std::pair{"paper’s", &Observation::rate},
                                     std::pair{"0.4–1 s", &Observation::rate_common}}) {
      table.rows.push_back({variant.name, name});
      for (const double frequency : compared_frequencies) {
        const VariedValue* value = variant.at(frequency);
        table.rows.back().push_back(value ? error_words(value->mean(rate)) : "–");
      }
      const double peak = peak_of(variant, rate);
      table.rows.back().push_back(std::isfinite(peak) ? page::number(peak, 1) + " Hz" : "–");
    }
  }
  return table;
}

/// "−1.80 against −1.82 (0.7 standard deviations of the samples)".
page::Text effect(const SampleMean& seen, const SampleMean& reference, double deviation) {
  if (!std::isfinite(seen.mean) || !std::isfinite(reference.mean)) return "–";
  const page::Text text = page::number(seen.mean) + " against " + page::number(reference.mean);
  if (!(deviation > 0.0)) return text;
  return text + " (" + page::number(std::abs(seen.mean - reference.mean) / deviation, 2) +
         " standard deviations of the samples)";
}

void add_effects(const std::vector<Variant>& variants, PaperSection& section) {
  const double rise = deviation_of(overall(variants[0], &Observation::rise)),
               speed = deviation_of(overall(variants[0], &Observation::speed_in));
  for (const Variant& variant : variants) {
    if (variant.reference < 0) continue;
    const Variant& reference = variants[static_cast<size_t>(variant.reference)];
    const SampleMean seen = overall(variant, &Observation::rise);
    if (!std::isfinite(seen.mean)) continue;
    section.rows.push_back({"beyond", "exponents of ν, 10–60 Hz",
                            variant.name + ": Δx_max " +
                                effect(seen, overall(reference, &Observation::rise), rise) +
                                "; v_max " +
                                effect(overall(variant, &Observation::speed_in),
                                       overall(reference, &Observation::speed_in), speed),
                            Agreement::reported});
  }
  for (const Variant& variant : variants) {
    const double whole = peak_of(variant, &Observation::rate),
                 common = peak_of(variant, &Observation::rate_common);
    if (!std::isfinite(whole)) continue;
    section.rows.push_back({"beyond", "compaction fastest near 10 Hz",
                            variant.name + ": of 5, 10, 20, 60 Hz at " + page::number(whole, 1) +
                                " Hz in the paper’s window, " + page::number(common, 1) +
                                " Hz within 0.4–1 s",
                            Agreement::reported});
  }
}

Variant part_of(std::string name, const std::vector<VariedValue>& values, bool first_only) {
  Variant variant{std::move(name), {}, -1};
  for (VariedValue value : values) {
    if (std::find(std::begin(compared_frequencies), std::end(compared_frequencies), value.value) ==
        std::end(compared_frequencies))
      continue;
    if (first_only) {
      const Observation* first = value.of_seed(1);
      if (!first) continue;
      value.samples = {Observation(*first)};
      value.seeds = {1};
    }
    variant.values.push_back(value);
  }
  return variant;
}

/// The same case varied at 10 and at 60 Hz.
Variant pair_of(std::string name, const std::vector<VariedValue>& at_slow,
                const std::vector<VariedValue>& at_fast, double which, int reference) {
  Variant variant{std::move(name), {}, reference};
  for (const auto& [values, frequency] :
       {std::pair{&at_slow, slow_end}, std::pair{&at_fast, fast_end}})
    for (VariedValue value : *values)
      if (value.value == which) {
        value.value = frequency;
        variant.values.push_back(value);
      }
  return variant;
}

struct Cause {
  Varied varied;
  const char *name, *missing;
};
constexpr Cause causes[] = {
    {Varied::loose_frequency, "looser deposit (lid placed, μ 0.8 while depositing)",
     "frequencies, looser deposit"},
    {Varied::rough_frequency, "friction 0.8", "frequencies, friction 0.8"},
    {Varied::strong_frequency, "f_max = 8 m g", "frequencies, f_max = 8 m g"}};

}  // namespace

const VariedValue* Variant::at(double frequency) const {
  const auto found = std::find_if(values.begin(), values.end(), [&](const VariedValue& value) {
    return value.value == frequency;
  });
  return found == values.end() ? nullptr : &*found;
}

std::vector<Variant> variants_of(PaperData& data) {
  const std::vector<VariedValue> all = data.values(Varied::frequency);
  std::vector<Variant> variants{part_of("nothing (mean over samples)", all, false),
                                part_of("nothing (sample 1)", all, true)};
  if (variants[1].values.size() < 2) return {};
  for (const Cause& cause : causes) {
    Variant variant = part_of(cause.name, data.values(cause.varied), true);
    variant.reference = 1;
    if (!variant.values.empty()) variants.push_back(variant);
  }
  const std::vector<VariedValue> iterations = data.values(Varied::iterations),
                                 iterations_fast = data.values(Varied::iterations_fast);
  const double base = data.campaign().settings.iterations;
  const int cut = static_cast<int>(variants.size());
  variants.push_back(pair_of("nothing (sample 1, periods to 0.7 and 0.6 s)", iterations,
                             iterations_fast, base, -1));
  if (variants.back().values.size() < 2) {
    variants.pop_back();
    return variants;
  }
  for (const VariedValue& value : iterations)
    if (value.value != base)
      variants.push_back(pair_of(value.label + " iterations a step", iterations, iterations_fast,
                                 value.value, cut));
  variants.push_back(pair_of("h = 5e-5 s", data.values(Varied::time_step),
                             data.values(Varied::time_step_fast), fine_step, cut));
  std::erase_if(variants, [](const Variant& variant) { return variant.values.empty(); });
  return variants;
}

PaperSection investigation_section(PaperData& data) {
  PaperSection section;
  section.text = {page::words("investigation.intro")};
  for (const Cause& cause : causes) note_missing(data, cause.varied, cause.missing, section);
  note_missing(data, Varied::time_step_fast, "steps at 60 Hz", section);
  const std::vector<Variant> variants = variants_of(data);
  if (!variants.empty()) {
    section.tables = {exponents_table(variants)};
    if (const page::Table rates = rates_table(variants); !rates.rows.empty())
      section.tables.push_back(rates);
    add_effects(variants, section);
  }
  add_local_exponents(data, variants, section);
  add_similarity(data, section);
  return section;
}

}  // namespace ballast
