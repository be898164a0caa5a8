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

/// One cause's exponent beside that without it.
struct Effect {
  const RunGroup* cause;
  const char* quantity;  ///< in words
  double with, without;
  Difference difference;
};

/// Single runs of one packing: the error of a difference of two exponents comes from the scatter
/// of runs of one packing, pooled over all frequencies and samples of the campaign.
std::vector<Effect> effects_of(const std::vector<RunGroup>& causes,
                               const std::vector<VariedValue>& driven) {
  const double span = std::log(fast_end / slow_end);
  std::vector<Effect> effects;
  for (const auto& [name, quantity] :
       {std::pair{"Δx_max", &Observation::rise}, std::pair{"v_max", &Observation::speed_in}}) {
    const PooledError scatter = scatter_paired(driven, quantity);
    for (const RunGroup& cause : causes) {
      if (cause.reference < 0) continue;
      const double with = overall(cause, quantity).mean,
                   without = overall(causes[static_cast<size_t>(cause.reference)], quantity).mean;
      // two runs make an exponent, and two exponents the difference
      if (std::isfinite(with) && std::isfinite(without))
        effects.push_back(
            {&cause,
             name,
             with,
             without,
             {with - without, 2.0 * scatter.deviation / span, scatter.degrees_of_freedom}});
    }
  }
  return effects;
}

page::Table effects_table(const std::vector<Effect>& effects) {
  page::Table table = page::words_table("investigation.effects");
  std::vector<double> chances;
  for (const Effect& effect : effects) chances.push_back(effect.difference.p());
  const std::vector<double> corrected = holm(chances);
  for (size_t k = 0; k < effects.size(); ++k) {
    const Effect& effect = effects[k];
    table.rows.push_back({effect.cause->name, effect.quantity, page::number(effect.with),
                          page::number(effect.without),
                          page::number(effect.difference.mean) + " ± " +
                              page::number(effect.difference.half_width(), 2),
                          words_of_p(chances[k]), words_of_p(corrected[k]),
                          corrected[k] < 0.05 ? "yes" : "no"});
  }
  return table;
}

/// Which causes change an exponent by more than chance, all of them asked together.
page::Text proven(const page::Table& effects) {
  page::Text names;
  for (const std::vector<page::Text>& row : effects.rows)
    if (plain_words(row.back()) == "yes") add_to_list(names, row[0] + " (" + row[1] + ")");
  return names.spans.empty() ? page::Text("none") : names;
}

void report_peaks(const std::vector<RunGroup>& causes, PaperSection& section) {
  for (const RunGroup& group : causes) {
    const double whole = peak_of(group, &Observation::rate);
    if (std::isfinite(whole))
      section.report("investigation.peak",
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
    const page::Table effects = effects_table(effects_of(causes, data.values(Varied::frequency)));
    if (!effects.rows.empty()) {
      section.tables.push_back(effects);
      section.report("investigation.exponent",
                     {{"count", std::to_string(effects.rows.size())}, {"proven", proven(effects)}});
    }
    report_peaks(causes, section);
  }
  add_local_exponents(data, causes, section);
  add_similarity(data, section);
  return section;
}

}  // namespace ballast
