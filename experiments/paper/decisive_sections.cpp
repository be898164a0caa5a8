// The decisive stages, each a table of its runs and what follows from them: chance, solver,
// deposit, load, grains, size, law, stopping rule.

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/paper/stage_tables.hpp"

namespace ballast {
namespace {

double frequency_of(const RunObservables& run) { return run.seen.facts.frequency; }
/// Of a cube of as many grains, in grains.
double side_of(const RunObservables& run) { return std::cbrt(run.setup.grains); }

/// Those of the cases that have finished runs; of `own` the section says what is missing.
struct CaseNames {
  Varied varied;
  const char* name;
  bool own = true;
};
std::vector<RunGroup> read_cases(PaperData& data, std::span<const CaseNames> names,
                                 PaperSection& section) {
  std::vector<RunGroup> cases;
  for (const auto& [varied, name, own] : names) {
    RunGroup found{name, own ? read_values(data, varied, section) : data.values(varied)};
    if (!found.values.empty()) cases.push_back(std::move(found));
  }
  return cases;
}

/// Its values within [low, high]; none where an end is not there.
std::vector<VariedValue> values_between(const RunGroup& of, double low, double high) {
  std::vector<VariedValue> kept;
  if (!of.at(low) || !of.at(high)) return kept;
  for (const VariedValue& value : of.values)
    if (value.value >= low && value.value <= high) kept.push_back(value);
  return kept;
}

/// Exponents in nu, sample by sample: over all frequencies from 5 to 60 Hz, and between two
/// frequencies, which every case has.
page::Table exponents_table(PaperData& data, const std::string& name,
                            const std::vector<RunGroup>& cases) {
  page::Table table = page::words_table(name);
  for (const RunGroup& row : cases)
    for (const double low : {5.0, 10.0, 20.0}) {
      std::vector<VariedValue> values = values_between(row, low, fast_frequency);
      const bool is_pair = low > 5.0;
      if (values.size() < (is_pair ? 2 : 3)) continue;
      if (is_pair) values = {values.front(), values.back()};
      const SampleMean rise =
          exponent_by_sample(data, values, frequency_of, rise_of, values.size());
      const SampleMean speed =
          exponent_by_sample(data, values, frequency_of, speed_of, values.size());
      table.rows.push_back(
          {row.name,
           page::exact(low) + (is_pair ? " and " : " to ") + page::exact(fast_frequency) + " Hz",
           std::to_string(rise.samples), words_with_interval(rise), words_with_interval(speed)});
    }
  return table;
}

/// What every other case does to Delta x_max, beside `reference` at the same value, and how likely
/// so large a change is by chance: alone, and among all of the table.
page::Table changes_table(PaperData& data, const std::string& name,
                          const std::vector<RunGroup>& cases, const RunGroup& reference) {
  page::Table table = page::words_table(name);
  std::vector<double> chances;
  for (const RunGroup& row : cases)
    for (const VariedValue& value : row.values) {
      const VariedValue* same = reference.at(value.value);
      if (&row == &reference || !same) continue;
      const Difference rise = log_change(data, *same, value, rise_of);
      if (!std::isfinite(rise.mean)) continue;
      chances.push_back(rise.p());
      table.rows.push_back({row.name, value.label, words_of_change(rise), words_of_p(rise.p()),
                            page::Text(),
                            words_of_change(log_change(data, *same, value, speed_of))});
    }
  const std::vector<double> corrected = holm(chances);
  for (size_t k = 0; k < corrected.size(); ++k) table.rows[k][4] = words_of_p(corrected[k]);
  return table;
}

void add_table(page::Table table, PaperSection& section) {
  if (!table.rows.empty()) section.tables.push_back(std::move(table));
}

/// All samples of the values together.
std::vector<double> all_of(PaperData& data, const std::vector<VariedValue>& values,
                           RunMeasure measure) {
  std::vector<double> all;
  for (const VariedValue& value : values)
    for (const size_t run : value.runs)
      if (const RunObservables* seen = data.observables_of(run)) all.push_back(measure(*seen));
  return all;
}

/// Standard deviation over the mean, in percent.
page::Text scatter_words(const std::vector<double>& values) {
  const SampleMean mean = sample_mean(values);
  if (mean.samples < 2) return "–";
  const double deviation = mean.error * std::sqrt(static_cast<double>(mean.samples));
  return page::number(100.0 * deviation / std::abs(mean.mean), 2);
}

PaperSection section_of(const char* stage) {
  return {.text = {page::words(std::string(stage) + ".intro")}};
}

/// A stage of frequencies: every run, exponents, and changes from the first case. The exponents of
/// so many cases are findings, each over its widest range.
PaperSection frequency_stage(PaperData& data, const char* stage, std::span<const CaseNames> names,
                             size_t claimed) {
  PaperSection section = section_of(stage);
  const std::vector<RunGroup> cases = read_cases(data, names, section);
  if (cases.empty()) return section;
  const std::string name = stage;
  add_table(stage_table(data, name + ".table", cases), section);
  const page::Table exponents = exponents_table(data, name + ".exponents", cases);
  std::set<std::string> done;
  for (const std::vector<page::Text>& row : exponents.rows)
    if (done.insert(page::plain_words(row[0])).second && done.size() <= claimed)
      section.report(name + ".claim",
                     {{"case", row[0]}, {"range", row[1]}, {"rise", row[3]}, {"speed", row[4]}});
  add_table(exponents, section);
  add_table(changes_table(data, name + ".changes", cases, cases.front()), section);
  return section;
}

}  // namespace

PaperSection replicas_section(PaperData& data) {
  PaperSection section = section_of("replicas");
  const std::vector<VariedValue> slow = read_values(data, Varied::replica, section),
                                 fast = read_values(data, Varied::replica_fast, section);
  page::Table table = page::words_table("replicas.table");
  for (const StageColumn& column : stage_columns()) {
    const std::vector<double> at_10 = all_of(data, slow, column.value),
                              at_60 = all_of(data, fast, column.value);
    table.rows.push_back(
        {page::marked(column.head), page::number(column.factor * sample_mean(at_10).mean),
         scatter_words(at_10), page::number(column.factor * sample_mean(at_60).mean),
         scatter_words(at_60)});
  }
  if (slow.size() + fast.size() < 2) return section;
  section.tables.push_back(table);
  section.report("replicas.claim", {{"slow", scatter_words(all_of(data, slow, rise_of))},
                                    {"slow_runs", std::to_string(slow.size())},
                                    {"fast", scatter_words(all_of(data, fast, rise_of))},
                                    {"fast_runs", std::to_string(fast.size())}});
  return section;
}

PaperSection tight_section(PaperData& data) {
  static constexpr CaseNames names[] = {{Varied::tight_frequency, "error ≤ 1e-2 g·h"},
                                        {Varied::tightest_frequency, "error ≤ 1e-3 g·h", false},
                                        {Varied::pressed_frequency, "200 iterations a step", false},
                                        {Varied::frequency, "the campaign’s iterations", false}};
  return frequency_stage(data, "tight", names, std::size(names));
}

PaperSection deposits_section(PaperData& data) {
  static constexpr CaseNames names[] = {{Varied::pressed_frequency, "lid pressed, μ 0.4"},
                                        {Varied::pressed_rough_frequency, "lid pressed, μ 0.8"},
                                        {Varied::placed_frequency, "lid placed, μ 0.4"},
                                        {Varied::placed_rough_frequency, "lid placed, μ 0.8"}};
  return frequency_stage(data, "deposits", names, std::size(names));
}

PaperSection loads_section(PaperData& data) {
  static constexpr CaseNames names[] = {
      {Varied::light_frequency, "f_max = 6 m g"},
      {Varied::light_strong_frequency, "f_max = 12 m g"},
      {Varied::light_half_frequency, "f_max = 6 m g, all at half scale"}};
  PaperSection section = section_of("loads");
  const std::vector<RunGroup> cases = read_cases(data, names, section);
  if (!cases.empty()) add_table(stage_table(data, "loads.table", cases), section);
  return section;
}

PaperSection shapes_section(PaperData& data) {
  PaperSection section = section_of("shapes");
  std::vector<RunGroup> cases;
  // One case for each frequency, its values the kinds of grains.
  for (const auto& [varied, name] :
       {std::pair{Varied::shape, "5 Hz"}, std::pair{Varied::shape_fast, "20 Hz"}})
    if (RunGroup found{name, read_values(data, varied, section)}; !found.values.empty())
      cases.push_back(std::move(found));
  if (cases.empty()) return section;
  add_table(stage_table(data, "shapes.table", cases), section);
  for (const RunGroup& driven : cases) {
    const VariedValue& base = driven.values.front();
    if (base.value != 0.0) continue;  // the campaign's own grains are not driven yet
    for (const VariedValue& kind : driven.values) {
      if (&kind == &base) continue;
      const Difference change = log_change(data, base, kind, prefactor_of_run);
      section.report("shapes.claim",
                     {{"kind", kind.label},
                      {"frequency", driven.name},
                      {"change", words_of_change(change)},
                      {"p", words_of_p(change.p())},
                      {"solid", words_of(kind.mean(&Observation::solid_initial))},
                      {"solid_base", words_of(base.mean(&Observation::solid_initial))}});
    }
  }
  return section;
}

PaperSection sizes_section(PaperData& data) {
  static constexpr CaseNames names[] = {{Varied::size_similar, "similar boxes, H/L fixed"},
                                        {Varied::size_wide, "wider boxes, H/d fixed"}};
  PaperSection section = section_of("sizes");
  std::vector<RunGroup> cases = read_cases(data, names, section);
  if (cases.empty()) return section;
  // The campaign's own box belongs to both.
  const RunGroup base{"", data.values(Varied::pressed_frequency)};
  if (const VariedValue* own = base.at(motion_frequency))
    for (RunGroup& sizes : cases) {
      VariedValue value = *own;
      value.value =
          mean_of(data, value, [](const RunObservables& run) { return run.setup.grains; }).mean;
      value.label = page::plain_words(page::exact(value.value));
      sizes.values.push_back(value);
      std::sort(sizes.values.begin(), sizes.values.end(),
                [](const VariedValue& a, const VariedValue& b) { return a.value < b.value; });
    }
  add_table(stage_table(data, "sizes.table", cases), section);
  for (const RunGroup& sizes : cases)
    section.report("sizes.claim", {{"case", sizes.name},
                                   {"exponent", words_with_interval(exponent_by_sample(
                                                    data, sizes.values, side_of, rise_of))}});
  return section;
}

PaperSection laws_section(PaperData& data) {
  static constexpr CaseNames names[] = {{Varied::exact_law, "Coulomb’s law"},
                                        {Varied::convex_law, "its convex relaxation"}};
  PaperSection section = section_of("laws");
  const std::vector<RunGroup> cases = read_cases(data, names, section);
  if (cases.empty()) return section;
  add_table(stage_table(data, "laws.table", cases), section);
  if (cases.size() < 2) return section;
  for (const StageColumn& column : stage_columns()) {
    const Difference change =
        log_change(data, cases[0].values.front(), cases[1].values.front(), column.value);
    if (!std::isfinite(change.mean)) continue;  // a gain that is negative in some sample
    section.report("laws.claim", {{"what", page::marked(column.head)},
                                  {"change", words_of_change(change)},
                                  {"p", words_of_p(change.p())}});
  }
  return section;
}

PaperSection rule_section(PaperData& data) {
  static constexpr CaseNames names[] = {{Varied::rule_frequency, "LMGC90’s rule"},
                                        {Varied::pressed_frequency, "200 iterations a step", false},
                                        {Varied::tight_frequency, "error ≤ 1e-2 g·h", false}};
  PaperSection nothing = section_of("rule");
  if (read_values(data, Varied::rule_frequency, nothing).empty()) return nothing;
  return frequency_stage(data, "rule", names, 1);
}

}  // namespace ballast
