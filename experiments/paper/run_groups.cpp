#include "experiments/paper/run_groups.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ballast {
namespace {

/// A function of two quantities of every sample that both values have.
template <class Function>
SampleMean over_common(const VariedValue& a, const VariedValue& b, double Observation::*quantity,
                       const Function& f) {
  std::vector<double> values;
  for (size_t k = 0; k < a.samples.size(); ++k)
    if (const Observation* other = b.of_seed(a.seeds[k]))
      values.push_back(f(a.samples[k].*quantity, other->*quantity));
  return sample_mean(values);
}

/// The campaign's frequencies that the causes are driven at too; only sample 1, or all.
RunGroup part_of(std::string name, const std::vector<VariedValue>& values, bool first_only,
                 int reference = -1) {
  RunGroup group{std::move(name), {}, reference};
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
    group.values.push_back(value);
  }
  return group;
}

/// The same case varied at 10 and at 60 Hz.
RunGroup pair_of(std::string name, const RunGroup& slow, const RunGroup& fast, double which,
                 int reference) {
  RunGroup group{std::move(name), {}, reference};
  for (const auto& [from, frequency] :
       {std::pair{&slow, varied_frequency}, std::pair{&fast, fast_frequency}})
    if (const VariedValue* value = from->at(which)) {
      group.values.push_back(*value);
      group.values.back().value = frequency;
    }
  return group;
}

}  // namespace

const VariedValue* RunGroup::at(double value) const {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const VariedValue& v) { return v.value == value; });
  return found == values.end() ? nullptr : &*found;
}

SampleMean RunGroup::mean_at(double value, double Observation::*quantity) const {
  const VariedValue* found = at(value);
  return found ? found->mean(quantity) : SampleMean{};
}

std::vector<double> logs_of(const VariedValue& value, double Observation::*quantity) {
  std::vector<double> logs;
  for (const Observation& sample : value.samples) logs.push_back(std::log(sample.*quantity));
  return logs;
}

PooledError scatter_between(const std::vector<VariedValue>& values, double Observation::*quantity) {
  std::vector<std::vector<double>> groups;
  for (const VariedValue& value : values) groups.push_back(logs_of(value, quantity));
  return pooled_error(groups);
}

PooledError scatter_paired(const std::vector<VariedValue>& values, double Observation::*quantity) {
  std::set<int> seeds;
  for (const VariedValue& value : values) seeds.insert(value.seeds.begin(), value.seeds.end());
  // one group for each packing: what it misses of the mean at every value that has all packings
  std::map<int, std::vector<double>> misses;
  int complete = 0;
  for (const VariedValue& value : values) {
    const std::vector<double> logs = logs_of(value, quantity);
    const SampleMean mean = sample_mean(logs);
    if (mean.samples < static_cast<int>(seeds.size())) continue;
    ++complete;
    for (size_t k = 0; k < logs.size(); ++k) misses[value.seeds[k]].push_back(logs[k] - mean.mean);
  }
  std::vector<std::vector<double>> groups;
  for (const auto& [seed, missed] : misses) groups.push_back(missed);
  PooledError pooled = pooled_error(groups);
  // the misses at one value add up to nothing: that takes a degree of freedom for each
  const int freedom = (complete - 1) * (static_cast<int>(seeds.size()) - 1);
  if (freedom < 1) return {};
  pooled.deviation *= std::sqrt(static_cast<double>(pooled.degrees_of_freedom) / freedom);
  pooled.degrees_of_freedom = freedom;
  return pooled;
}

page::Table observable_table(const std::string& name) {
  page::Text heads;
  for (const ObservableColumn& column : observable_columns())
    add_to_list(heads, std::string(column.name) + " (" + column.unit + ")", " || ");
  return page::words_table(name, {{"observables", heads}});
}

SampleMean exponent_between(const VariedValue& a, const VariedValue& b,
                            double Observation::*quantity) {
  // log(q_b / q_a) / log(b / a) of each sample by itself: differences between samples drop out.
  const double span = std::log(b.value / a.value);
  return over_common(a, b, quantity,
                     [&](double qa, double qb) { return std::log(qb / qa) / span; });
}

SampleMean interpolated(const VariedValue& a, const VariedValue& b, double at,
                        double Observation::*quantity) {
  // A power law through a and b: a straight line of the logarithms.
  const double w = std::log(at / a.value) / std::log(b.value / a.value);
  return over_common(a, b, quantity,
                     [&](double qa, double qb) { return qa * std::pow(qb / qa, w); });
}

std::vector<RunGroup> causes_of(PaperData& data) {
  const std::vector<VariedValue> all = data.values(Varied::frequency);
  std::vector<RunGroup> groups{part_of("nothing (mean over samples)", all, false),
                               part_of("nothing (sample 1)", all, true)};
  if (groups[1].values.size() < 2) return {};
  for (const auto& [varied, name] :
       {std::pair{Varied::loose_frequency, "looser deposit (lid placed, μ 0.8 while depositing)"},
        std::pair{Varied::rough_frequency, "friction 0.8"},
        std::pair{Varied::strong_frequency, "f_max = 8 m g"}})
    groups.push_back(part_of(name, data.values(varied), true, 1));
  std::erase_if(groups, [](const RunGroup& group) { return group.values.empty(); });
  // solver and step have shorter runs, and so a reference of their own
  const RunGroup slow{"", data.values(Varied::iterations)},
      fast{"", data.values(Varied::iterations_fast)};
  const double base = data.campaign().settings.iterations;
  const RunGroup cut =
      pair_of("nothing (sample 1, periods to 0.7 and 0.6 s)", slow, fast, base, -1);
  if (cut.values.size() < 2) return groups;
  const int reference = static_cast<int>(groups.size());
  groups.push_back(cut);
  for (const VariedValue& value : slow.values)
    if (value.value != base)
      groups.push_back(
          pair_of(value.label + " iterations a step", slow, fast, value.value, reference));
  groups.push_back(pair_of("h = 5e-5 s", {"", data.values(Varied::time_step)},
                           {"", data.values(Varied::time_step_fast)}, fine_step, reference));
  std::erase_if(groups, [](const RunGroup& group) { return group.values.empty(); });
  return groups;
}

}  // namespace ballast
