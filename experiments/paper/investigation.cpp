// Where Ballast and the paper differ: exponents, C and compaction under each cause that was varied,
// beside what the samples scatter.

#include <cmath>

#include "experiments/paper/run_groups.hpp"

namespace ballast {
namespace {

constexpr double slow_end = varied_frequency, fast_end = fast_frequency;

/// Exponent between 10 and 60 Hz.
SampleMean overall(const RunGroup& group, double Observation::*quantity) {
  const VariedValue *a = group.at(slow_end), *b = group.at(fast_end);
  return a && b ? exponent_between(*a, *b, quantity) : SampleMean{};
}

page::Table exponents_table(const std::vector<RunGroup>& causes) {
  page::Table table = page::words_table("investigation.exponents");
  for (const RunGroup& group : causes) {
    // a line through two points is no fit
    const auto fit = [&](double Observation::*quantity) {
      const VariedCurve curve = curve_of_values(group.values, quantity);
      return curve.x.size() < 3 ? page::Text("–") : words_of(fit_power(curve.x, curve.y));
    };
    const auto prefactor = [&](double frequency) {
      const VariedValue* value = group.at(frequency);
      return value ? words_of(prefactor_of(*value)) : "–";
    };
    const auto solid = [&](double Observation::*quantity) {
      return group.at(slow_end) ? page::number(group.mean_at(slow_end, quantity).mean, 4) : "–";
    };
    table.rows.push_back(
        {group.name, samples_of(group.values.front()), words_of(overall(group, &Observation::rise)),
         fit(&Observation::rise), words_of(overall(group, &Observation::speed_in)),
         fit(&Observation::speed_in), prefactor(slow_end), prefactor(fast_end),
         solid(&Observation::solid_initial), solid(&Observation::solid_reference)});
  }
  return table;
}

/// Frequency at which the rate is largest; NaN when fewer than three are known.
double peak_of(const RunGroup& group, double Observation::*rate) {
  double at = not_known, most = -1e300;
  int known = 0;
  for (const VariedValue& value : group.values) {
    const double mean = value.mean(rate).mean;
    if (!std::isfinite(mean)) continue;
    ++known;
    if (mean <= most) continue;
    most = mean;
    at = value.value;
  }
  return known < 3 ? not_known : at;
}

page::Table rates_table(const std::vector<RunGroup>& causes) {
  page::Table table = page::words_table("investigation.rates");
  for (const RunGroup& group : causes) {
    if (group.values.size() < 3) continue;  // shorter runs: another window
    for (const auto& [name, rate] : {std::pair{"paper’s", &Observation::rate},
                                     std::pair{"0.4–1 s", &Observation::rate_common}}) {
      table.rows.push_back({group.name, name});
      std::vector<page::Text>& row = table.rows.back();
      for (const double frequency : compared_frequencies)
        row.push_back(group.at(frequency) ? words_of(group.mean_at(frequency, rate)) : "–");
      const double peak = peak_of(group, rate);
      row.push_back(std::isfinite(peak) ? page::number(peak, 1) + " Hz" : "–");
    }
  }
  return table;
}

/// "−1.80 against −1.82 (0.7 standard deviations of the samples)".
page::Text effect(const std::vector<RunGroup>& causes, const RunGroup& group,
                  double Observation::*quantity) {
  const SampleMean seen = overall(group, quantity),
                   reference = overall(causes[static_cast<size_t>(group.reference)], quantity);
  if (!std::isfinite(seen.mean) || !std::isfinite(reference.mean)) return "–";
  const page::Text text = page::number(seen.mean) + " against " + page::number(reference.mean);
  const double deviation = deviation_of(overall(causes[0], quantity));
  if (!(deviation > 0.0)) return text;
  return text + " (" + page::number(std::abs(seen.mean - reference.mean) / deviation, 2) +
         " standard deviations of the samples)";
}

void claim_effects(const std::vector<RunGroup>& causes, PaperSection& section) {
  for (const RunGroup& group : causes)
    if (group.reference >= 0 && std::isfinite(overall(group, &Observation::rise).mean))
      section.claim("investigation.exponent",
                    {{"cause", group.name},
                     {"rise", effect(causes, group, &Observation::rise)},
                     {"speed", effect(causes, group, &Observation::speed_in)}});
  for (const RunGroup& group : causes) {
    const double whole = peak_of(group, &Observation::rate);
    if (std::isfinite(whole))
      section.claim("investigation.peak",
                    {{"cause", group.name},
                     {"own", page::number(whole, 1)},
                     {"common", page::number(peak_of(group, &Observation::rate_common), 1)}});
  }
}

}  // namespace

PaperSection investigation_section(PaperData& data) {
  PaperSection section{.text = {page::words("investigation.intro")}};
  for (const Varied varied : {Varied::loose_frequency, Varied::rough_frequency,
                              Varied::strong_frequency, Varied::time_step_fast})
    read_values(data, varied, section);
  const std::vector<RunGroup> causes = causes_of(data);
  if (!causes.empty()) {
    section.tables = {exponents_table(causes)};
    if (const page::Table rates = rates_table(causes); !rates.rows.empty())
      section.tables.push_back(rates);
    claim_effects(causes, section);
  }
  add_local_exponents(data, causes, section);
  add_similarity(data, section);
  return section;
}

}  // namespace ballast
