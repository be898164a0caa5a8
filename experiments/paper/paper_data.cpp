#include "experiments/paper/paper_data.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <sstream>
#include <stdexcept>

#include "experiments/record/record_file.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace {

using Run = const RunSummary&;

/// A number of a run. NaN: not known in this run.
struct RunColumn {
  const char* name;  ///< snake_case
  const char* unit;  ///< "1" without one
  const char* meaning;
  double (*value)(Run run);
};
/// The columns of runs.csv after its texts.
const RunColumn all_columns[] = {
    // the settings
    {"seed", "1", "of the grains: the sample", [](Run r) -> double { return r.facts.seed; }},
    {"frequency", "Hz", "nu", [](Run r) { return r.facts.frequency; }},
    {"force_over_weight", "1", "f_max/(m g)",
     [](Run r) { return r.facts.f_max / r.facts.weight(); }},
    {"gravity", "m/s^2", "g", [](Run r) { return r.facts.gravity; }},
    {"wall_mass_over_grains", "1", "m_w/m",
     [](Run r) { return r.facts.wall_mass / r.facts.grain_mass; }},
    {"grain_mass", "kg", "m, all grains", [](Run r) { return r.facts.grain_mass; }},
    {"grains", "1", "number", [](Run r) { return r.facts.grains; }},
    {"length", "m", "L of the box", [](Run r) { return r.facts.length; }},
    {"height", "m", "H, top of the packing", [](Run r) { return r.facts.height; }},
    {"aspect", "1", "L/H", [](Run r) { return r.facts.length / r.facts.height; }},
    {"largest_size", "m", "largest distance centre - vertex of a grain",
     [](Run r) { return r.facts.largest_size; }},
    {"lid_raise", "m", "gap under the lid", [](Run r) { return r.facts.lid_raise; }},
    {"friction", "1", "mu of the drive", [](Run r) { return r.facts.friction; }},
    {"deposit_friction", "1", "mu of the deposit", [](Run r) { return r.facts.deposit_friction; }},
    {"lid_pressure", "1", "on the lid while depositing, grain weights; 0: placed",
     [](Run r) { return r.facts.lid_pressure; }},
    {"step", "s", "h", [](Run r) { return r.facts.step; }},
    {"iterations_most", "1", "allowed to the solver per step",
     [](Run r) { return r.facts.iterations_most; }},
    {"tolerance", "g h", "of the solver", [](Run r) { return r.facts.tolerance; }},
    // the solver
    {"iterations", "1", "mean per step", [](Run r) { return r.iterations.mean; }},
    {"error", "g h", "rms natural map, mean over the steps that count",
     [](Run r) { return r.error_counted; }},
    {"penetration", "m", "deepest overlap", [](Run r) { return r.penetration_max; }},
    // the motion
    {"periods", "1", "that count", [](Run r) -> double { return r.wall.periods.size(); }},
    {"rise", "m", "Delta x_max", [](Run r) { return r.rise.mean; }},
    {"speed_in", "m/s", "v_max", [](Run r) { return r.speed_in.mean; }},
    {"net", "m", "contraction per period", [](Run r) { return -r.net.mean; }},
    {"eq3", "m", "X, right side of Eq. 3", [](Run r) { return eq3_displacement(r.facts); }},
    {"prefactor", "1", "C = Delta x_max / X", [](Run r) { return r.prefactor; }},
    {"first_contraction", "m", "least x of the first period, at least 0.3 s",
     [](Run r) { return r.contraction.size; }},
    {"first_time90", "s", "t90, when 90 % of it is reached",
     [](Run r) { return r.contraction.time90; }},
    // the forces
    {"push", "N", "F = a/(1 - w)", [](Run r) { return r.law.push; }},
    {"push_over_weight", "1", "F/(m g)", [](Run r) { return r.law.push / r.facts.weight(); }},
    {"yield_over_weight", "1", "f/(m g) where the stroke begins",
     [](Run r) { return r.yield_load.mean / r.facts.weight(); }},
    {"carried_mass", "kg", "M = m_w w/(1 - w)", [](Run r) { return r.law.carried_mass; }},
    {"prefactor_theory", "1", "(9/4 pi^2) (F/(m g))^2 (m + m_w)/(m_w + M)",
     [](Run r) { return r.law.prefactor; }},
    // the jam
    {"jam_share", "1", "of the time", [](Run r) { return r.jammed.share; }},
    {"jam_force", "1", "mean |f_g - f|/f_max", [](Run r) { return r.jammed.force_mean; }},
    {"jam_speed", "m/s", "mean |v|", [](Run r) { return r.jammed.speed_mean; }},
    // the packing
    {"density_before", "1", "rho before the drive",
     [](Run r) { return r.facts.solid_fraction_initial; }},
    {"density_reference", "1", "rho_0, at 0.2 s", [](Run r) { return r.compaction.reference; }},
    {"gain", "1", "Delta rho_1 per period", [](Run r) { return r.compaction.gain; }},
    {"rate", "1/s", "Eq. 4, from 0.2 s to the end", [](Run r) { return r.compaction.rate; }},
    {"rate_common", "1/s", "Eq. 4, within 0.4 to 1 s",
     [](Run r) { return r.compaction.rate_common; }},
    {"rate_first", "1/s", "Eq. 4, within 0.2 to 1 s",
     [](Run r) { return r.compaction.rate_first; }},
    {"rate_late", "1/s", "Eq. 4, within 0.5 to 1.5 s",
     [](Run r) { return r.compaction.rate_late; }},
    {"roll_top", "m", "mean displacement of a period, clockwise, along the top of the middle half",
     [](Run r) { return r.roll.along[0]; }},
    {"roll_right", "m", "", [](Run r) { return r.roll.along[1]; }},
    {"roll_bottom", "m", "", [](Run r) { return r.roll.along[2]; }},
    {"roll_left", "m", "", [](Run r) { return r.roll.along[3]; }},
    {"circulation", "m^2", "around that rectangle, per period",
     [](Run r) { return r.roll.circulation; }},
};

/// The columns of text before them.
constexpr std::pair<const char*, std::string RunRow::*> text_columns[] = {
    {"name", &RunRow::name},
    {"stage", &RunRow::stage},
    {"key", &RunRow::key},
    {"record", &RunRow::record},
    {"solver", &RunRow::solver}};
constexpr size_t texts = std::size(text_columns);

/// The place of a column among the numbers. Throws std::invalid_argument naming the column.
size_t place_of(std::string_view column) {
  const auto* found = std::ranges::find(all_columns, column, &RunColumn::name);
  if (found == std::end(all_columns))
    throw std::invalid_argument("no column of runs is called " + std::string(column));
  return static_cast<size_t>(found - all_columns);
}

/// Rounds to six digits, in which settings from records and from files of nine digits are equal.
double rounded(double value) { return parsed_number(printed("%.6g", value)).value_or(value); }

/// Returns whether a row meets one condition of a selection: column, sign, value.
bool says(const RunRow& row, const std::string& condition) {
  const size_t place = condition.find_first_of("=!<>~");
  const std::string column = condition.substr(0, place), value = condition.substr(place + 1);
  const char sign = condition.at(place);
  if (column == "name") return row.name.find(value) != std::string::npos;
  if (column == "solver") return (row.solver == value) == (sign == '=');
  const double seen = rounded(row[column]), wanted = parsed_number(value).value();
  if (sign == '<') return seen < wanted;
  if (sign == '>') return seen > wanted;
  return (seen == wanted) == (sign == '=');
}

bool takes(const Selection& selection, const RunRow& row) {
  return std::ranges::any_of(split(selection, ';'), [&](const std::string& stage) {
    std::istringstream words(stage);
    std::string word;
    bool holds = words >> word && word == row.stage;
    while (holds && words >> word) holds = says(row, word);
    return holds;
  });
}

}  // namespace

std::vector<PlannedRun> read_campaign(const CampaignSettings& settings) {
  Plan plan =
      settings.plan.empty() ? plan_of(campaign_plan(), "campaign.toml") : read_plan(settings.plan);
  // Only the wanted runs: an override may fit no scene but theirs.
  if (!settings.only.empty()) plan.runs = select(plan, settings.only);
  for (PlannedRun& run : plan.runs) {
    if (!settings.scene.empty() && run.scene == "vibrated_box") run.scene = settings.scene;
    run.overrides.insert(run.overrides.end(), settings.overrides.begin(), settings.overrides.end());
    run = planned_run(run.name, run.scene, run.overrides);
    if (run.packing.empty()) throw Error(run.scene + ": has no [grains], expected a vibrated box");
  }
  return plan.runs;
}

std::string stage_of(const PlannedRun& run) {
  return run.name.substr(0, run.name.find_first_of("-."));
}

RunRow::RunRow() : numbers(std::size(all_columns), not_known) {}

RunRow::RunRow(const RunSummary& run) : solver(run.facts.solver) {
  for (const RunColumn& column : all_columns) numbers.push_back(column.value(run));
}

double RunRow::operator[](RunMeasure measure) const {
  const RunRow& run = *this;
  if (measure == "relative_gain") return run["gain"] / run["density_reference"];
  if (measure == "first_compaction") return run["density_reference"] / run["density_before"] - 1.0;
  if (measure == "theory_ratio") return run["prefactor"] / run["prefactor_theory"];
  if (measure == "aspect_prefactor") return run["prefactor"] * run["aspect"];
  if (measure == "carried_share") return run["carried_mass"] / run["grain_mass"];
  if (measure == "yield_over_push") return run["yield_over_weight"] / run["push_over_weight"];
  if (measure == "grain_share") return 1.0 / (1.0 + run["wall_mass_over_grains"]);
  if (measure == "grains_across") return std::cbrt(run["grains"]);
  return numbers[place_of(measure)];
}

double& RunRow::operator[](std::string_view column) { return numbers[place_of(column)]; }

std::string unit_suffix(RunMeasure measure) {
  const std::string unit = all_columns[place_of(measure)].unit;
  return unit == "1" ? "" : ' ' + unit;
}

std::string runs_csv(std::span<const RunRow> rows) {
  CsvWriter csv;
  for (const auto& [name, text] : text_columns) csv.add(name);
  for (const RunColumn& column : all_columns) csv.add(column.name);
  csv.end_row();
  for (size_t k = 0; k < texts; ++k) csv.add("text");
  for (const RunColumn& column : all_columns) csv.add(column.unit);
  csv.end_row();
  for (const RunRow& row : rows) {
    for (const auto& [name, text] : text_columns) csv.add(row.*text);
    for (const double& value : row.numbers)  // the first is the seed: all digits
      csv.add(number_cell(value, &value == row.numbers.data() ? 17 : 9));
    csv.end_row();
  }
  return csv.take();
}

std::vector<RunRow> read_runs_csv(const std::filesystem::path& file) {
  CsvReader reader(file);
  if (!reader.next()) reader.fail("empty");
  const std::vector<std::string> names(reader.cells().begin(), reader.cells().end());
  for (size_t k = 0; k < texts; ++k)
    if (k >= names.size() || names[k] != text_columns[k].first)
      reader.fail("not a report's runs.csv: it begins with name,stage,key,record,solver");
  if (!reader.next()) reader.fail("the line of units is missing");
  std::vector<RunRow> rows;
  while (reader.next()) {
    reader.require_cells(names.size());
    const auto cells = reader.cells();
    RunRow& row = rows.emplace_back();
    for (size_t k = 0; k < texts; ++k) row.*text_columns[k].second = cells[k];
    for (const RunColumn& column : all_columns)
      if (const auto k = static_cast<size_t>(std::ranges::find(names, column.name) - names.begin());
          k < names.size() && !cells[k].empty())
        row[column.name] = reader.number(k, column.name);
  }
  return rows;
}

std::string run_columns_csv() {
  CsvWriter csv;
  csv.add_row({"column", "unit", "description"});
  for (const RunColumn& column : all_columns)
    csv.add_row({column.name, column.unit, column.meaning});
  return csv.take();
}

std::string record_hash(std::span<const StepRecord> steps) {
  std::uint64_t hash = fnv1a("");
  for (const StepRecord& step : steps)
    for (const StepColumn& column : step_columns()) {
      if (column.phase) continue;
      const auto bits = std::bit_cast<std::array<char, sizeof(double)>>(step.*column.value);
      hash = fnv1a({bits.data(), bits.size()}, hash);
    }
  return hash_text(hash);
}

const RunRow* Group::like(const RunRow& other) const {
  for (const RunRow* row : samples)
    if ((*row)["seed"] == other["seed"]) return row;
  return nullptr;
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
      changes.push_back(std::log((*same)[measure]) - std::log((*row)[measure]));
  return sample_mean(changes);
}

std::map<double, double> exponents_of_samples(const Groups& groups, RunMeasure along,
                                              RunMeasure measure, size_t fewest) {
  std::map<double, Points> samples;  // by seed
  for (const Group& group : groups)
    for (const RunRow* row : group.samples)
      samples[(*row)["seed"]].add((*row)[along], {(*row)[measure]});
  std::map<double, double> exponents;
  for (const auto& [seed, points] : samples)
    if (points.x.size() >= fewest) exponents[seed] = fit_power(points.x, points.y).exponent;
  return exponents;
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
  // one list for each packing: its deviations from the mean of every group that has all packings
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
  // the deviations in one group sum to zero: that takes a degree of freedom for each
  const int freedom = (complete - 1) * (static_cast<int>(seeds.size()) - 1);
  if (freedom < 1) return {};
  pooled.deviation *= std::sqrt(static_cast<double>(pooled.degrees_of_freedom) / freedom);
  pooled.degrees_of_freedom = freedom;
  return pooled;
}

PaperData::PaperData(std::vector<PlannedRun> campaign, std::filesystem::path results,
                     std::vector<RunRow> rows)
    : campaign_(std::move(campaign)), results_(std::move(results)) {
  for (const PlannedRun& run : campaign_)
    if (keys_.insert(run.key).second && RunFolder(folder(run.key)).is_finished(run.key))
      finished_[run.key];
  for (RunRow& row : rows)
    if (keys_.contains(row.key))
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
  for (const PlannedRun& run : campaign_) {
    if (!knows(run)) continue;
    rows_.push_back(has(run) ? finished_.at(run.key) : given_.at(run.key));
    rows_.back().name = run.name;
    rows_.back().stage = stage_of(run);
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
  Groups groups;
  for (const RunRow* row : rows(selection)) {
    const double value = rounded((*row)[along]);
    if (!std::isfinite(value)) continue;
    auto group = std::ranges::find(groups, value, &Group::value);
    if (group == groups.end()) group = groups.insert(group, {value, printed("%g", value)});
    if (!group->like(*row)) group->samples.push_back(row);
  }
  std::ranges::sort(groups, {}, &Group::value);
  return groups;
}

Groups PaperData::settings(const Selection& selection) {
  Groups groups;
  std::set<std::string> seen;  // equal runs and equal records count once
  for (const RunRow* row : rows(selection)) {
    if (!seen.insert(row->record.empty() ? row->key : row->record).second) continue;
    std::string setting = row->stage + row->name;
    if (const size_t seed = setting.find("seed="); seed != std::string::npos)
      setting.erase(seed, setting.find_first_not_of("0123456789", seed + 5) - seed);
    auto group = std::ranges::find(groups, setting, &Group::label);
    if (group == groups.end()) group = groups.insert(group, {0.0, setting});
    if (!group->like(*row)) group->samples.push_back(row);
  }
  return groups;
}

std::vector<MeasuredRun> PaperData::records(const Selection& selection) {
  std::vector<MeasuredRun> found;
  for (const RunRow* row : rows(selection)) {
    if (!finished_.contains(row->key)) continue;
    MeasuredRun& run = found.emplace_back(MeasuredRun{read_run_data(folder(row->key)), {}});
    run.summary = summarise(run.data.steps, run.data.facts);
  }
  return found;
}

std::string PaperData::missing(const std::string& stage) const {
  int planned = 0, known = 0;
  for (const PlannedRun& run : campaign_)
    if (stage_of(run) == stage) {
      ++planned;
      known += knows(run);
    }
  if (known == planned) return {};
  return printed("PARTIAL: %d of %d runs of %s.", known, planned, stage.c_str());
}

size_t PaperData::known_by_row() const {
  return static_cast<size_t>(std::ranges::count_if(
      given_, [&](const auto& given) { return !finished_.contains(given.first); }));
}

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
