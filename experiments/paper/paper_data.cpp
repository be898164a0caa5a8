#include "experiments/paper/paper_data.hpp"

#include <algorithm>
#include <set>

#include <unistd.h>

#include "experiments/record/record_file.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {

namespace fs = std::filesystem;

std::string campaign_plan();  // campaign.toml

namespace {

constexpr const char* usual_scene = "vibrated_box";

/// A plan is a file, so that its scenes have a place.
Plan built_in_plan() {
  const fs::path file =
      fs::temp_directory_path() / ("ballast-campaign-" + std::to_string(getpid()) + ".toml");
  write_whole_file(file, campaign_plan());
  const Plan plan = read_plan(file);
  fs::remove(file);
  return plan;
}

/// Measured values of what was set, from records and from files of nine digits, are the same.
double rounded(double value) { return parsed_number(printed("%.6g", value)).value_or(value); }

bool takes(const Selection& selection, const RunRow& row) {
  const bool is_stage =
      std::ranges::any_of(selection.stages, [&](const char* stage) { return row.stage == stage; });
  return is_stage && (!selection.holds || selection.holds(row));
}

}  // namespace

std::vector<CampaignRun> read_campaign(const CampaignSettings& settings) {
  Plan plan = settings.plan.empty() ? built_in_plan() : read_plan(settings.plan);
  for (PlannedRun& run : plan.runs) {
    if (!settings.scene.empty() && run.scene == usual_scene) run.scene = settings.scene;
    run.overrides.insert(run.overrides.end(), settings.overrides.begin(), settings.overrides.end());
    run = planned_run(run.name, run.scene, run.overrides);
  }
  if (!settings.only.empty()) plan.runs = select(plan, settings.only);
  std::vector<CampaignRun> runs;
  for (const PlannedRun& run : plan.runs) {
    if (run.packing.empty())
      throw SceneFileError(run.scene + ": has no [grains], expected a vibrated box");
    runs.push_back({run, run.name.substr(0, run.name.find_first_of("-.")), run.key, run.steps});
  }
  return runs;
}

const RunRow* Group::like(const RunRow& other) const {
  for (const RunRow* row : samples)
    if ((*row)["seed"] == other["seed"]) return row;
  return nullptr;
}

std::vector<double> Group::values(RunMeasure measure) const {
  std::vector<double> all;
  for (const RunRow* row : samples) all.push_back(measure(*row));
  return all;
}

std::vector<double> Group::logs(RunMeasure measure) const {
  std::vector<double> all = values(measure);
  for (double& one : all) one = std::log(one);
  return all;
}

const Group* at(const Groups& groups, double value) {
  const auto found = std::ranges::find(groups, value, &Group::value);
  return found == groups.end() ? nullptr : &*found;
}

Points points_of(const Groups& groups, RunMeasure x, RunMeasure y, double x_factor,
                 double y_factor) {
  Points points;
  for (const Group& group : groups) {
    const SampleMean mean = group.mean(y);
    const double place = x_factor * group.mean(x).mean;
    if (std::isfinite(mean.mean) && std::isfinite(place))
      points.add(place, {y_factor * mean.mean, y_factor * mean.error, mean.samples});
  }
  return points;
}

SampleMean log_change(const Group& from, const Group& to, RunMeasure measure) {
  std::vector<double> changes;
  for (const RunRow* row : from.samples)
    if (const RunRow* same = to.like(*row))
      changes.push_back(std::log(measure(*same)) - std::log(measure(*row)));
  return sample_mean(changes);
}

SampleMean exponent_by_sample(const Groups& groups, RunMeasure along, RunMeasure measure,
                              size_t fewest) {
  std::map<double, Points> samples;  // by seed
  for (const Group& group : groups)
    for (const RunRow* row : group.samples)
      samples[(*row)["seed"]].add(along(*row), {measure(*row)});
  std::vector<double> exponents;
  for (const auto& [seed, points] : samples)
    if (points.x.size() >= fewest) exponents.push_back(fit_power(points.x, points.y).exponent);
  return sample_mean(exponents);
}

PooledError scatter_between(const Groups& groups, RunMeasure measure) {
  std::vector<std::vector<double>> logs;
  for (const Group& group : groups) logs.push_back(group.logs(measure));
  return pooled_error(logs);
}

PooledError scatter_paired(const Groups& groups, RunMeasure measure) {
  std::set<double> seeds;
  for (const Group& group : groups)
    for (const RunRow* row : group.samples) seeds.insert((*row)["seed"]);
  // one list for each packing: what it misses of the mean in every group that has all packings
  std::map<double, std::vector<double>> misses;
  int complete = 0;
  for (const Group& group : groups) {
    const std::vector<double> logs = group.logs(measure);
    const SampleMean mean = sample_mean(logs);
    if (mean.samples < static_cast<int>(seeds.size())) continue;
    ++complete;
    for (size_t k = 0; k < logs.size(); ++k)
      misses[(*group.samples[k])["seed"]].push_back(logs[k] - mean.mean);
  }
  std::vector<std::vector<double>> lists;
  for (const auto& [seed, missed] : misses) lists.push_back(missed);
  PooledError pooled = pooled_error(lists);
  // the misses in one group add up to nothing: that takes a degree of freedom for each
  const int freedom = (complete - 1) * (static_cast<int>(seeds.size()) - 1);
  if (freedom < 1) return {};
  pooled.deviation *= std::sqrt(static_cast<double>(pooled.degrees_of_freedom) / freedom);
  pooled.degrees_of_freedom = freedom;
  return pooled;
}

PaperData::PaperData(std::vector<CampaignRun> campaign, std::filesystem::path results,
                     std::vector<RunRow> rows)
    : campaign_(std::move(campaign)), results_(std::move(results)) {
  std::set<std::string> keys;
  for (const CampaignRun& run : campaign_)
    if (keys.insert(run.key).second && RunFolder(folder(run.key)).is_finished(run.key))
      finished_[run.key];
  for (RunRow& row : rows)
    if (keys.contains(row.key))
      given_.emplace(row.key, std::move(row));
    else
      foreign_.push_back(std::move(row));
}

RunRow PaperData::measured(const std::string& key) {
  const RunData data = read_run_data(folder(key));
  RunSummary run = summarise(data.steps, data.facts);
  try {
    run.roll = roll_of_periods(read_record_poses(data.folder / "record.h5"), run);
  } catch (const Error& error) {
    notices_.push_back(std::string("No poses: ") + error.what());
  }
  RunRow row(run);
  row.key = key;
  row.record = record_hash(data.steps);
  return row;
}

const std::vector<RunRow>& PaperData::rows() {
  if (!rows_.empty()) return rows_;
  for (auto& [key, row] : finished_) row = measured(key);
  for (const CampaignRun& run : campaign_) {
    if (!knows(run)) continue;
    rows_.push_back(has(run) ? finished_.at(run.key) : given_.at(run.key));
    rows_.back().name = run.planned.name;
    rows_.back().stage = run.stage;
  }
  rows_.insert(rows_.end(), foreign_.begin(), foreign_.end());
  return rows_;
}

std::vector<const RunRow*> PaperData::rows(const Selection& selection) {
  std::vector<const RunRow*> found;
  for (const RunRow& row : rows())
    if (takes(selection, row)) found.push_back(&row);
  return found;
}

Groups PaperData::groups(const Selection& selection, RunMeasure along) {
  std::map<double, Group> values;
  for (const RunRow* row : rows(selection)) {
    const double value = rounded(along(*row));
    if (!std::isfinite(value)) continue;
    Group& group = values[value];
    group.value = value;
    group.label = printed("%g", value);
    if (!group.like(*row)) group.samples.push_back(row);
  }
  Groups groups;
  for (auto& [value, group] : values) groups.push_back(std::move(group));
  return groups;
}

Groups PaperData::settings(const Selection& selection) {
  std::vector<Group> groups;
  std::map<std::string, size_t> known;  // where a setting's group stands
  for (const RunRow* row : rows(selection)) {
    std::string setting = row->stage + row->name;
    if (const size_t seed = setting.find("seed="); seed != std::string::npos)
      setting.erase(seed, setting.find_first_not_of("0123456789", seed + 5) - seed);
    const auto [place, is_new] = known.emplace(setting, groups.size());
    if (is_new) groups.push_back({0.0, setting});
    Group& group = groups[place->second];
    if (!group.like(*row)) group.samples.push_back(row);
  }
  return groups;
}

std::vector<RunData> PaperData::records(const std::string& stage, double frequency) {
  std::vector<RunData> found;
  for (const CampaignRun& run : campaign_) {
    if (run.stage != stage || !has(run)) continue;
    RunData data = read_run_data(folder(run.key));
    if (std::isnan(frequency) || data.facts.frequency == frequency)
      found.push_back(std::move(data));
  }
  return found;
}

std::string PaperData::missing(const std::string& stage) const {
  int planned = 0, known = 0;
  for (const CampaignRun& run : campaign_)
    if (run.stage == stage) {
      ++planned;
      known += knows(run);
    }
  if (known == planned) return {};
  return printed("PARTIAL: %d of %d runs of %s.", known, planned, stage.c_str());
}

size_t PaperData::planned() const {
  std::set<std::string> keys;
  for (const CampaignRun& run : campaign_) keys.insert(run.key);
  return keys.size();
}

size_t PaperData::known_by_row() const {
  return static_cast<size_t>(std::ranges::count_if(
      given_, [&](const auto& given) { return !finished_.contains(given.first); }));
}

size_t PaperData::foreign() const { return foreign_.size(); }

std::pair<int, int> PaperData::repeats() {
  rows();
  int made = 0, same = 0;
  for (const auto& [key, row] : finished_)
    if (const auto given = given_.find(key); given != given_.end()) {
      ++made;
      same += given->second.record == row.record;
    }
  return {made, same};
}

}  // namespace ballast
