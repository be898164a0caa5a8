#include "experiments/paper/stage_tables.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace ballast {
namespace {

double error_of(const RunObservables& run) { return run.seen.error_mean; }
double net_of(const RunObservables& run) { return run.seen.net; }
double solid_of(const RunObservables& run) { return run.seen.solid_initial; }
double gain_of(const RunObservables& run) { return run.seen.gain; }
double time90_of(const RunObservables& run) { return run.seen.first_time90; }

}  // namespace

double rise_of(const RunObservables& run) { return run.seen.rise; }
double speed_of(const RunObservables& run) { return run.seen.speed_in; }
double prefactor_of_run(const RunObservables& run) { return run.prefactor(); }
double theory_of(const RunObservables& run) { return run.law.prefactor; }
double push_of(const RunObservables& run) {
  return run.law.push / (run.seen.facts.grain_mass * run.seen.facts.gravity);
}

std::span<const StageColumn> stage_columns() {
  static constexpr StageColumn columns[] = {
      {"Δx~max~ (mm)", 1e3, rise_of},      {"C", 1.0, prefactor_of_run},
      {"C by the theory", 1.0, theory_of}, {"F/(m g)", 1.0, push_of},
      {"v~max~ (mm/s)", 1e3, speed_of},    {"net a period (mm)", 1e3, net_of},
      {"ρ before", 1.0, solid_of},         {"Δρ~1~ (10^−4^)", 1e4, gain_of},
      {"t~90~ (s)", 1.0, time90_of},       {"error (g·h)", 1.0, error_of}};
  return columns;
}

SampleMean mean_of(PaperData& data, const VariedValue& value, RunMeasure measure) {
  std::vector<double> values;
  for (const size_t run : value.runs)
    if (const RunObservables* seen = data.observables_of(run)) values.push_back(measure(*seen));
  return sample_mean(values);
}

page::Table stage_table(PaperData& data, const std::string& name,
                        const std::vector<RunGroup>& cases) {
  page::Text heads;
  for (const StageColumn& column : stage_columns())
    add_to_list(heads, page::marked(column.head), " || ");
  page::Table table = page::words_table(name, {{"columns", heads}});
  for (const RunGroup& row : cases)
    for (const VariedValue& value : row.values) {
      table.rows.push_back({row.name, value.label, samples_of(value)});
      for (const StageColumn& column : stage_columns())
        table.rows.back().push_back(words_of(mean_of(data, value, column.value), column.factor));
    }
  return table;
}

Difference log_change(PaperData& data, const VariedValue& from, const VariedValue& to,
                      RunMeasure measure) {
  std::vector<double> before, after;
  for (size_t k = 0; k < from.seeds.size(); ++k) {
    const auto same = std::find(to.seeds.begin(), to.seeds.end(), from.seeds[k]);
    if (same == to.seeds.end()) continue;
    const RunObservables* a = data.observables_of(from.runs[k]);
    const RunObservables* b = data.observables_of(to.runs[same - to.seeds.begin()]);
    if (!a || !b) continue;
    before.push_back(std::log(measure(*a)));
    after.push_back(std::log(measure(*b)));
  }
  return paired_difference(before, after);
}

page::Text words_of_change(const Difference& change) {
  if (!std::isfinite(change.mean)) return "–";
  const page::Text mean = page::percent(std::expm1(change.mean));
  const double half = change.half_width();
  if (!std::isfinite(half)) return mean;
  return mean + " " +
         page::interval(100.0 * std::expm1(change.mean - half),
                        100.0 * std::expm1(change.mean + half));
}

SampleMean exponent_by_sample(PaperData& data, const std::vector<VariedValue>& values,
                              RunMeasure along, RunMeasure measure, size_t fewest) {
  std::map<int, std::pair<std::vector<double>, std::vector<double>>> samples;
  for (const VariedValue& value : values)
    for (size_t k = 0; k < value.seeds.size(); ++k)
      if (const RunObservables* seen = data.observables_of(value.runs[k])) {
        samples[value.seeds[k]].first.push_back(along(*seen));
        samples[value.seeds[k]].second.push_back(measure(*seen));
      }
  std::vector<double> exponents;
  for (const auto& [seed, points] : samples)
    if (points.first.size() >= fewest)
      exponents.push_back(fit_power(points.first, points.second).exponent);
  return sample_mean(exponents);
}

page::Text words_with_interval(const SampleMean& mean) {
  if (!std::isfinite(mean.mean)) return "–";
  page::Text words = page::number(mean.mean);
  if (mean.samples < 2) return words + " (one sample)";
  const double half = student_t95(mean.samples - 1) * mean.error;
  return words + " " + page::interval(mean.mean - half, mean.mean + half);
}

}  // namespace ballast
