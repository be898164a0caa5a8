// The paper's numbers beside those of both scenes: the box that takes what is nearest at hand where
// the paper is silent, and the one that takes what the paper's own numbers ask for.

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/paper/stage_tables.hpp"

namespace ballast {
namespace {

Found exponent_of(const std::vector<VariedValue>& values, double Observation::*quantity) {
  const VariedCurve curve = curve_of_values(values, quantity);
  const PowerFit fit = fit_power(curve.x, curve.y);
  return std::isfinite(fit.exponent) ? found(fit, misfit_of(fit, curve).p) : Found{};
}

/// At the paper's 5 Hz, over the samples.
Found at_motion(PaperData& data, const std::vector<VariedValue>& values, RunMeasure measure) {
  for (const VariedValue& value : values)
    if (value.value == motion_frequency) return found(mean_of(data, value, measure));
  return {};
}

/// One of the paper's numbers.
struct PaperNumber {
  const char* name;
  PaperRange range;
  Found (*find)(PaperData& data, const std::vector<VariedValue>& values);
};

std::vector<PaperNumber> paper_numbers() {
  using Values = std::vector<VariedValue>;
  return {{"exponent of Δx~max~ in ν", PaperRange::exponent(-2.0),
           [](PaperData&, const Values& v) { return exponent_of(v, &Observation::rise); }},
          {"exponent of v~max~ in ν", PaperRange::exponent(-1.0),
           [](PaperData&, const Values& v) { return exponent_of(v, &Observation::speed_in); }},
          {"C at 5 Hz", PaperRange::roughly(paper::prefactor),
           [](PaperData& data, const Values& v) { return at_motion(data, v, prefactor_of_run); }},
          {"ρ before the drive", PaperRange::about(paper::solid_fraction_initial, 0.005),
           [](PaperData& data, const Values& v) {
             return at_motion(data, v,
                              [](const RunObservables& run) { return run.seen.solid_initial; });
           }},
          {"Δρ~1~/ρ~0~ a period at 5 Hz", PaperRange::roughly(paper::gain_per_period),
           [](PaperData& data, const Values& v) {
             return at_motion(data, v,
                              [](const RunObservables& run) { return run.seen.relative_gain; });
           }}};
}

/// Only those at frequencies that both scenes were driven at.
void keep_common(std::vector<VariedValue>& values, const std::vector<VariedValue>& others) {
  std::erase_if(values, [&](const VariedValue& value) {
    return std::none_of(others.begin(), others.end(),
                        [&](const VariedValue& other) { return other.value == value.value; });
  });
}

}  // namespace

PaperSection reading_section(PaperData& data) {
  PaperSection section{.text = {page::words("reading.intro")}};
  const std::vector<VariedValue> reading = read_values(data, Varied::reading_frequency, section);
  if (reading.empty()) return section;
  std::vector<VariedValue> base = data.values(Varied::frequency);
  keep_common(base, reading);
  page::Table table = page::words_table("reading.table");
  int agree[2] = {0, 0};
  for (const PaperNumber& number : paper_numbers()) {
    std::vector<page::Text> row{page::marked(number.name), words_of(number.range)};
    for (const auto& [scene, values] :
         {std::pair{0, &std::as_const(base)}, std::pair{1, &reading}}) {
      const Found seen = number.find(data, *values);
      const Agreement verdict = agreement_of(number.range, seen);
      agree[scene] += verdict == Agreement::agrees || verdict == Agreement::partly;
      row.push_back(words_of(seen));
      row.push_back(word_of(verdict));
    }
    table.rows.push_back(row);
  }
  section.tables = {table, stage_table(data, "reading.runs", {{"vibrated_box_paper", reading}})};
  section.report("reading.claim", {{"base", std::to_string(agree[0])},
                                   {"reading", std::to_string(agree[1])},
                                   {"all", std::to_string(table.rows.size())}});
  return section;
}

}  // namespace ballast
