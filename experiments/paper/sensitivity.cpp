// What the choices that the paper leaves open do: step, size convention, friction.

#include <algorithm>
#include <cmath>

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

TextTable table_of(const std::vector<SweepValue>& values, const char* caption, const char* first) {
  TextTable table{caption, {first, "samples"}, {}};
  for (const ObservableColumn& column : observable_columns())
    table.head.push_back(std::string(column.name) + " (" + column.unit + ")");
  table.head.insert(table.head.end(), {"C of Eq. 3", "error (g·h)", "ms a step"});
  for (const SweepValue& value : values) {
    table.rows.push_back({value.label, std::to_string(value.samples.size())});
    for (const ObservableColumn& column : observable_columns()) {
      const SampleMean mean = value.mean(column.value);
      table.rows.back().push_back(with_error(column.factor * mean.mean, column.factor * mean.error));
    }
    std::vector<double> factors;
    for (const Observation& sample : value.samples) factors.push_back(sample.rise / sample.eq3());
    table.rows.back().push_back(digits(sample_mean(factors).mean));
    table.rows.back().push_back(digits(value.mean(&Observation::error_mean).mean, 2));
    table.rows.back().push_back(digits(1e3 * value.mean(&Observation::seconds_per_step).mean));
  }
  return table;
}

struct Question {
  Sweep sweep;
  const char* what;
  const char* caption;
  const char* first;
};
constexpr Question questions[] = {
    {Sweep::time_step, "steps", "Step h, sample 1 at 10 Hz (the iterations a step stay the same)", "h"},
    {Sweep::size, "size conventions",
     "Size convention at 10 Hz: the paper’s “diameter” read as barycentre–vertex distance, or twice it; box and grains "
     "at half scale",
     "size"},
    {Sweep::friction, "frictions", "Friction between grains, floor and lid, sample 1 at 10 Hz", "μ"},
    {Sweep::deposit, "deposits",
     "Deposit (lid pressed or only placed, friction while depositing), sample 1 at 10 Hz; driven with μ = 0.4",
     "deposit"}};

/// Compaction rates of the loosest deposit beside those of the campaign's, sample by sample the first.
TextTable rates_table(const std::vector<SweepValue>& loose, const std::vector<SweepValue>& base) {
  TextTable table{
      "Compaction against frequency from the loosest deposit (not pressed, μ 0.8; one sample) and from the campaign’s "
      "(mean over samples)",
      {"ν (Hz)", "ρ before, loose", "rate, paper’s window (1/s), loose", "campaign", "rate, 0.4–1 s (1/s), loose",
       "campaign", "C, loose", "C, campaign"},
      {}};
  const auto factor = [](const SweepValue& value) { return value.samples.front().rise / value.samples.front().eq3(); };
  for (const SweepValue& value : loose) {
    const auto same =
        std::find_if(base.begin(), base.end(), [&](const SweepValue& other) { return other.value == value.value; });
    const bool has = same != base.end();
    const Observation& seen = value.samples.front();
    table.rows.push_back({digits(value.value), digits(seen.solid_initial), digits(seen.rate),
                          has ? digits(same->mean(&Observation::rate).mean) : "–", digits(seen.rate_common),
                          has ? digits(same->mean(&Observation::rate_common).mean) : "–", digits(factor(value)),
                          has ? digits(factor(*same)) : "–"});
  }
  return table;
}

}  // namespace

PaperSection sensitivity_section(PaperData& data) {
  PaperSection section = new_section("sensitivity", "What the open choices do: step, size, friction");
  for (const Question& question : questions) {
    if (const std::string missing = data.missing(question.sweep, question.what); !missing.empty())
      section.notes.push_back(missing);
    const std::vector<SweepValue> values = data.sweep(question.sweep);
    if (values.empty()) continue;
    section.tables.push_back(table_of(values, question.caption, question.first));
    if (values.size() < 2) continue;
    std::string found;
    for (const SweepValue& value : values)
      found +=
          (found.empty() ? "" : "; ") + value.label + ": " + digits(1e3 * value.mean(&Observation::rise).mean) + " mm";
    section.rows.push_back(
        {"beyond", "–", std::string("Δx_max by ") + question.what + ": " + found, Agreement::reported});
  }
  const std::vector<SweepValue> loose = data.sweep(Sweep::loose_frequency);
  if (const std::string missing = data.missing(Sweep::loose_frequency, "frequencies from the loosest deposit");
      !missing.empty())
    section.notes.push_back(missing);
  if (!loose.empty()) section.tables.push_back(rates_table(loose, data.sweep(Sweep::frequency)));
  return section;
}

}  // namespace ballast
