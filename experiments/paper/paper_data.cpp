#include "experiments/paper/paper_data.hpp"

#include <algorithm>
#include <set>

namespace ballast {

const char* plural_of(Varied varied) {
  // in the order of Varied
  constexpr const char* words[] = {"frequencies",
                                   "values of f_max",
                                   "values of g",
                                   "values of m_w",
                                   "numbers of iterations at 10 Hz",
                                   "numbers of iterations at 60 Hz",
                                   "backends",
                                   "steps",
                                   "size conventions",
                                   "gaps under the lid",
                                   "frictions",
                                   "deposits",
                                   "frequencies, looser deposit",
                                   "frequencies, friction 0.8",
                                   "frequencies, f_max = 8 m g",
                                   "steps at 60 Hz",
                                   "lengths of the box at 5 Hz",
                                   "lengths of the box at 20 Hz",
                                   "replicas at 10 Hz",
                                   "replicas at 60 Hz",
                                   "frequencies, solver at 1e-2",
                                   "frequencies, solver at 1e-3",
                                   "frequencies, lid pressed, μ 0.4",
                                   "frequencies, lid pressed, μ 0.8",
                                   "frequencies, lid placed, μ 0.4",
                                   "frequencies, lid placed, μ 0.8",
                                   "frequencies, f_max = 6 m g, m_w = 0.1 m",
                                   "frequencies, f_max = 12 m g, m_w = 0.1 m",
                                   "frequencies, the same at half scale",
                                   "kinds of grains at 5 Hz",
                                   "kinds of grains at 20 Hz",
                                   "numbers of grains, similar boxes",
                                   "numbers of grains, wider boxes",
                                   "frequencies, the paper's reading",
                                   "frequencies, 300 grains, exact law",
                                   "frequencies, 300 grains, convex law",
                                   "frequencies, LMGC90's rule"};
  return words[static_cast<size_t>(varied)];
}

SampleMean VariedValue::mean(double Observation::*quantity) const {
  std::vector<double> values;
  for (const Observation& sample : samples) values.push_back(sample.*quantity);
  return sample_mean(values);
}

const Observation* VariedValue::of_seed(int seed) const {
  for (size_t k = 0; k < seeds.size(); ++k)
    if (seeds[k] == seed) return &samples[k];
  return nullptr;
}

PaperData::PaperData(Campaign campaign, std::filesystem::path results,
                     std::vector<RunObservables> rows)
    : campaign_(std::move(campaign)), results_(std::move(results)) {
  for (const CampaignRun& run : campaign_.runs)
    finished_.push_back(is_finished(results_, run.planned));
  for (RunObservables& row : rows) rows_[row.key] = std::move(row);
}

bool PaperData::has(size_t run) const { return finished_.at(run); }

bool PaperData::knows(size_t run) const { return has(run) || row_of(run); }

std::filesystem::path PaperData::folder(size_t run) const {
  return folder_of(results_, campaign_.runs.at(run).planned);
}

RunData PaperData::read(size_t run) const { return read_run_data(folder(run)); }

const RunObservables* PaperData::row_of(size_t run) const {
  if (rows_.empty()) return nullptr;
  const auto found = rows_.find(folder(run).filename().string());
  return found == rows_.end() ? nullptr : &found->second;
}

const std::vector<RunObservables>& PaperData::observables() {
  if (!observables_.empty()) return observables_;
  for (size_t k = 0; k < campaign_.runs.size(); ++k) {
    if (!knows(k)) continue;
    RunObservables run = has(k) ? observe_run(read(k)) : *row_of(k);
    run.run = k;
    run.name = campaign_.runs[k].planned.name;
    run.stage = campaign_.runs[k].stage;
    run.key = folder(k).filename().string();
    observables_.push_back(std::move(run));
  }
  return observables_;
}

const RunObservables* PaperData::observables_of(size_t run) {
  for (const RunObservables& seen : observables())
    if (seen.run == run) return &seen;
  return nullptr;
}

int PaperData::finished() const {
  return static_cast<int>(std::count(finished_.begin(), finished_.end(), true));
}

int PaperData::known_by_row() const {
  int rows = 0;
  for (size_t k = 0; k < campaign_.runs.size(); ++k) rows += !has(k) && row_of(k);
  return rows;
}

std::vector<std::string> PaperData::foreign_rows() const {
  std::set<std::string> keys;
  for (size_t k = 0; k < campaign_.runs.size(); ++k) keys.insert(folder(k).filename().string());
  std::vector<std::string> names;
  for (const auto& [key, row] : rows_)
    if (!keys.contains(key)) names.push_back(row.name);
  return names;
}

PaperData::Repeats PaperData::repeats() {
  Repeats repeats;
  for (const RunObservables& run : observables()) {
    const RunObservables* row = has(run.run) ? row_of(run.run) : nullptr;
    if (!row) continue;
    ++repeats.made;
    repeats.same += row->record == run.record;
  }
  return repeats;
}

std::vector<size_t> PaperData::motion() const {
  std::vector<size_t> runs;
  for (const size_t run : campaign_.motion)
    if (has(run)) runs.push_back(run);
  return runs;
}

std::optional<size_t> PaperData::at_frequency(double frequency, int seed) const {
  for (const CampaignPoint& point : campaign_.points)
    if (point.varied == Varied::frequency && point.value == frequency && point.seed == seed &&
        has(point.run))
      return point.run;
  return {};
}

bool PaperData::serves(const CampaignPoint& point) const {
  if (has(point.run)) return true;
  // a row counts all periods of its run
  const RunObservables* row = row_of(point.run);
  if (!row) return false;
  const double step = row->seen.facts.step;
  return point.window.end > (static_cast<double>(campaign_.runs[point.run].steps) - 1.0) * step;
}

const Observation* PaperData::observation(const CampaignPoint& point) {
  if (!serves(point)) return nullptr;
  if (!has(point.run)) return &observables_of(point.run)->seen;
  // one run serves several figures, some of which count fewer of its periods
  const auto key = std::make_pair(point.run, point.window.end);
  if (const auto found = seen_.find(key); found != seen_.end()) return &found->second;
  const RunData data = read(point.run);
  return &seen_.emplace(key, observe(data.steps, data.facts, grain_count(data), point.window))
              .first->second;
}

std::string origin_of_runs(const std::vector<size_t>& runs) {
  std::string name = "runs";
  for (const size_t run : runs) name += ' ' + std::to_string(run);
  return name;
}

std::vector<VariedValue> PaperData::values(Varied which) {
  // points come in the order of importance; a map sorts them by value
  std::map<double, VariedValue> values;
  for (const CampaignPoint& point : campaign_.points) {
    if (point.varied != which) continue;
    VariedValue& value = values[point.value];
    value.value = point.value;
    value.label = point.label;
    ++value.planned;
    if (const Observation* seen = observation(point)) {
      value.samples.push_back(*seen);
      value.seeds.push_back(point.seed);
      value.runs.push_back(point.run);
    }
  }
  std::vector<VariedValue> list;
  for (auto& [at, value] : values)
    if (!value.samples.empty()) list.push_back(std::move(value));
  return list;
}

std::string PaperData::missing(Varied which) const {
  // values of which at least one sample is finished, and all runs
  std::set<double> planned, there;
  int runs = 0, done = 0;
  for (const CampaignPoint& point : campaign_.points) {
    if (point.varied != which) continue;
    planned.insert(point.value);
    ++runs;
    if (!serves(point)) continue;
    there.insert(point.value);
    ++done;
  }
  if (done == runs) return {};
  return "PARTIAL: " + std::to_string(there.size()) + " of " + std::to_string(planned.size()) +
         ' ' + plural_of(which) + ", " + std::to_string(done) + " of " + std::to_string(runs) +
         " runs.";
}

}  // namespace ballast
