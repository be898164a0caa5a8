#pragma once
// The results of a campaign so far: one row for each run that is finished or whose row was given,
// and the statistics of rows. Missing runs are counted and reported; they are never an error.
// Figures draw means over samples; a comparison of two groups of rows compares every sample with
// the same sample of the other group.

#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/measure/run_data.hpp"
#include "experiments/plans/plan.hpp"

namespace ballast {

struct CampaignSettings {
  std::filesystem::path plan = {};  ///< empty: campaign.toml
  std::string scene = {};           ///< replaces vibrated_box, name or path; empty: keeps it
  std::vector<std::string> overrides = {};  ///< for every run, after the plan's own
  std::string only = {};                    ///< shell pattern for the runs' names; empty: all
};

/// The text of campaign.toml, built into the program.
std::string campaign_plan();
/// The runs of a campaign stage by stage, the most important first. Equal runs of several stages
/// have one key. Throws Error naming plan, run, key and value.
std::vector<PlannedRun> read_campaign(const CampaignSettings& settings);
/// The stage of a run: its name up to the first "-" or ".".
std::string stage_of(const PlannedRun& run);

/// The name of a number of a run: a column of runs.csv, or a number that RunRow::operator[] takes
/// from columns. SI units; NaN: not known.
using RunMeasure = std::string_view;
/// The unit as it is written behind a value: " Hz"; empty without a unit.
std::string unit_suffix(RunMeasure measure);

struct RunRow {
  std::string name, stage;  ///< of the campaign
  std::string key;          ///< of the resolved scene; it names the folder of the record
  std::string record;  ///< hash of the record's steps without wall clock: equal runs, equal hash
  std::string solver;
  std::vector<double> numbers;  ///< the columns of runs.csv after these texts; NaN: not known

  /// A row in which nothing is known yet.
  RunRow();
  explicit RunRow(const RunSummary& run);
  /// Throws std::invalid_argument when there is no number of this name.
  double operator[](RunMeasure measure) const;
  double& operator[](std::string_view column);
};

/// Rows as CSV: a line of names, a line of units, then one line for each row.
std::string runs_csv(std::span<const RunRow> rows);
/// Reads such a table of this or an earlier version. Columns with unknown names are left out; the
/// numbers of columns that the table lacks are not known. Throws Error naming file, line and column
/// where the file is no such table.
std::vector<RunRow> read_runs_csv(const std::filesystem::path& file);
/// The columns and their meaning as CSV: column, unit, description.
std::string run_columns_csv();

/// The hash of all columns of the steps except wall clock, to the last bit.
std::string record_hash(std::span<const StepRecord> steps);

/// Rows of some stages, each with conditions on its rows: "force; sizes name~wide grains>600".
/// Conditions on numbers are =, ! (unequal), < and >, to six digits; on the solver = and !; and
/// name~part, for names that hold a part.
using Selection = std::string;

/// The runs at one value of the varied quantity.
struct Group {
  double value = 0.0;  ///< to six digits
  std::string label;
  std::vector<const RunRow*> samples = {};

  /// The sample of the same seed; null: none.
  const RunRow* like(const RunRow& other) const;
  std::vector<double> values(RunMeasure measure) const {
    return values_of(samples, [&](const RunRow* row) { return (*row)[measure]; });
  }
  SampleMean mean(RunMeasure measure) const { return sample_mean(values(measure)); }
  /// The logarithm of each sample's value.
  std::vector<double> logs(RunMeasure measure) const {
    return values_of(values(measure), [](double one) { return std::log(one); });
  }
  double log_mean(RunMeasure measure) const { return sample_mean(logs(measure)).mean; }
};
using Groups = std::vector<Group>;

/// The group at a value; null: none.
const Group* at(const Groups& groups, double value);

/// Means of `y` over samples against means of `x`. Groups where one is not known are left out.
Points points_of(const Groups& groups, RunMeasure x, RunMeasure y, double x_factor = 1.0,
                 double y_factor = 1.0);

/// ln of `measure` at `to` less that at `from`, over the samples that both groups have.
SampleMean log_change(const Group& from, const Group& to, RunMeasure measure);
/// By seed, the exponent of `measure` in `along` over the groups, fitted to each sample that has at
/// least `fewest` values. A factor that a packing has at all values drops out.
std::map<double, double> exponents_of_samples(const Groups& groups, RunMeasure along,
                                              RunMeasure measure, size_t fewest = 3);

/// The scatter of the logarithm of a measure, pooled over groups. scatter_between: between samples
/// of grains. scatter_paired: from run to run of one packing, without the offset that the packing
/// has in all groups (of the groups that have every packing).
PooledError scatter_between(const Groups& groups, RunMeasure measure);
PooledError scatter_paired(const Groups& groups, RunMeasure measure);

class PaperData {
 public:
  /// `rows` belong to runs whose records are elsewhere (a report's runs.csv). A run whose record is
  /// in `results` is measured from it. Rows of no run of this campaign are taken as they are.
  PaperData(std::vector<PlannedRun> campaign, std::filesystem::path results,
            std::vector<RunRow> rows = {});

  const std::vector<PlannedRun>& campaign() const { return campaign_; }

  /// Returns whether the record of the run is there, and finished.
  bool has(const PlannedRun& run) const { return finished_.contains(run.key); }
  /// Returns whether the run has such a record, or its row was given.
  bool knows(const PlannedRun& run) const { return has(run) || given_.contains(run.key); }
  std::filesystem::path folder(const std::string& key) const { return results_ / "runs" / key; }

  /// The rows of all known runs in the campaign's order, then the rows of no run of it. Records are
  /// measured once, on the first call. Throws Error where a record cannot be read.
  const std::vector<RunRow>& rows();
  std::vector<const RunRow*> rows(const Selection& selection);
  /// The groups by growing value of `along`. Each sample has one row, the first that is found.
  Groups groups(const Selection& selection, RunMeasure along);
  /// A group for each setting, whatever was varied: its rows have names that differ in the seed
  /// alone. A run or record that several stages share belongs to the first.
  Groups settings(const Selection& selection);

  /// The finished runs among these rows.
  std::vector<MeasuredRun> records(const Selection& selection);
  /// "PARTIAL: 6 of 30 runs of frequency."; empty when all planned runs are known.
  std::string missing(const std::string& stage) const;

  size_t planned() const { return keys_.size(); }  ///< different runs of the campaign
  size_t finished() const { return finished_.size(); }
  size_t known_by_row() const;                        ///< runs that are known by a row alone
  size_t foreign() const { return foreign_.size(); }  ///< rows of no run of this campaign
  /// The number of runs made here whose row was given too, and how many of them have equal hashes.
  std::pair<int, int> repeats();
  /// The parts of records that could not be read, one line each. Filled by rows().
  const std::vector<std::string>& notices() const { return notices_; }

 private:
  RunRow measured(const std::string& key);

  std::vector<PlannedRun> campaign_;
  std::set<std::string> keys_;  ///< of the campaign's runs
  std::filesystem::path results_;
  std::map<std::string, RunRow> finished_;  ///< by key; measured by rows()
  std::map<std::string, RunRow> given_;     ///< by key
  std::vector<RunRow> rows_, foreign_;
  std::vector<std::string> notices_;
};

}  // namespace ballast
