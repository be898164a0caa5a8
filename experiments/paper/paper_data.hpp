#pragma once
// What a campaign has produced so far: one row for each run that is finished, or of which a row was
// given, and what rows say together. Whatever is missing is counted and said, never an error.
//
// A selection takes rows by stage and by what they say. Its groups are the values of one thing that
// was varied, each with its samples: the seeds. Figures draw means over samples; what compares two
// groups compares every sample with itself.

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
  std::string scene = {};           ///< instead of vibrated_box, name or path; empty: that one
  std::vector<std::string> overrides = {};  ///< of every run, after the plan's own
  std::string only = {};                    ///< names of the runs, as a shell's pattern; empty: all
};

/// The text of campaign.toml, built into the program.
std::string campaign_plan();
/// Stage by stage, the most important first; equal runs of several stages have one key. Throws
/// Error naming plan, run, key and value.
std::vector<PlannedRun> read_campaign(const CampaignSettings& settings);
/// The stage of a run: its name to the first of "-.".
std::string stage_of(const PlannedRun& run);

/// A number of a run by its name: a column of runs.csv, or what follows from some:
///   relative_gain  Delta rho_1/rho_0
///   grain_share    m/(m + m_w)
///   grains_across  cube root of the number of grains
///   carried_share, yield_over_push          M/m; the load where the stroke begins, over F
///   theory_ratio, aspect_prefactor          C over the theory's; C L/H
/// SI units; NaN: not known.
using RunMeasure = std::string_view;
/// What stands behind a value of it: " Hz"; empty without a unit.
std::string unit_behind(RunMeasure measure);

struct RunRow {
  std::string name, stage;  ///< of the campaign
  std::string key;          ///< of the resolved scene: the folder of the record
  std::string record;  ///< hash of the record's steps without wall clock: equal runs, equal hash
  std::string solver;
  std::vector<double> numbers;  ///< the columns of runs.csv after these texts; NaN: not known

  /// Nothing is known yet.
  RunRow();
  explicit RunRow(const RunSummary& run);
  /// There must be one of this name (std::invalid_argument).
  double operator[](RunMeasure measure) const;
  double& operator[](std::string_view column);
};

/// Names, then units, then one row a run.
std::string runs_csv(std::span<const RunRow> rows);
/// Reads such a table, of this or an earlier version: what a column means that is not known here is
/// left out, and a column that is not in it is not known. Throws Error naming file, line and
/// column where it is none.
std::vector<RunRow> read_runs_csv(const std::filesystem::path& file);
/// The columns and what they mean, as CSV: column, unit, description.
std::string run_columns_csv();

/// Of all columns of the steps but wall clock, to the last bit.
std::string record_hash(std::span<const StepRecord> steps);

/// Rows of some stages, each with what its rows must say: "force; sizes name~wide grains>600".
/// A number is =, ! (another), < or > (to six digits), the solver = or !, and the name holds a
/// part.
using Selection = std::string;

/// One value of what is varied.
struct Group {
  double value = 0.0;  ///< to six digits
  std::string label;
  std::vector<const RunRow*> samples = {};

  /// The sample of the same seed; null: none.
  const RunRow* like(const RunRow& other) const;
  std::vector<double> values(RunMeasure measure) const;
  SampleMean mean(RunMeasure measure) const { return sample_mean(values(measure)); }
  /// One logarithm of each sample.
  std::vector<double> logs(RunMeasure measure) const;
  double log_mean(RunMeasure measure) const { return sample_mean(logs(measure)).mean; }
};
using Groups = std::vector<Group>;

/// The one at a value; null: none.
const Group* at(const Groups& groups, double value);

/// Means over samples, `y` against the mean `x`; what is not known is left out.
Points points_of(const Groups& groups, RunMeasure x, RunMeasure y, double x_factor = 1.0,
                 double y_factor = 1.0);

/// Over the samples that both have: ln of `measure` at `to` less that at `from`.
SampleMean log_change(const Group& from, const Group& to, RunMeasure measure);
/// Exponent of `measure` in `along` over the groups, fitted to each sample by itself that has at
/// least so many values, by its seed. What a packing does at all values drops out.
std::map<double, double> exponents_of_samples(const Groups& groups, RunMeasure along,
                                              RunMeasure measure, size_t fewest = 3);

/// How the logarithm of a measure scatters, pooled over groups: between samples of grains; and from
/// run to run of one packing, where what a packing has in common in all groups is taken out (of the
/// groups that have every packing).
PooledError scatter_between(const Groups& groups, RunMeasure measure);
PooledError scatter_paired(const Groups& groups, RunMeasure measure);

class PaperData {
 public:
  /// `rows`: of runs whose records are elsewhere (a report's runs.csv). Where a run is there its
  /// own record is measured. Rows of no run of this campaign are taken as they are.
  PaperData(std::vector<PlannedRun> campaign, std::filesystem::path results,
            std::vector<RunRow> rows = {});

  const std::vector<PlannedRun>& campaign() const { return campaign_; }

  /// Its record is there, and finished.
  bool has(const PlannedRun& run) const { return finished_.contains(run.key); }
  /// The same, or its row was given.
  bool knows(const PlannedRun& run) const { return has(run) || given_.contains(run.key); }
  std::filesystem::path folder(const std::string& key) const { return results_ / "runs" / key; }

  /// Every run that is known, measured, in the campaign's order; then the rows of no run of it.
  /// Measured once, on the first call. Throws Error where a record cannot be read.
  const std::vector<RunRow>& rows();
  std::vector<const RunRow*> rows(const Selection& selection);
  /// By growing value of `along`; one row for each sample: the first.
  Groups groups(const Selection& selection, RunMeasure along);
  /// A group for each setting, whatever was varied: rows whose names differ in the seed alone. A
  /// run that several stages share belongs to the first.
  Groups settings(const Selection& selection);

  /// The records of a stage's finished runs at a frequency (any, where NaN).
  std::vector<RunData> records(const std::string& stage, double frequency = not_known);
  /// "PARTIAL: 6 of 30 runs of frequency.": empty when everything planned is there.
  std::string missing(const std::string& stage) const;

  size_t planned() const { return keys_.size(); }  ///< different runs of the campaign
  size_t finished() const { return finished_.size(); }
  size_t known_by_row() const;                        ///< runs of which a row alone is known
  size_t foreign() const { return foreign_.size(); }  ///< rows of no run of this campaign
  /// Runs made here whose row was given too: how many, and of how many both have the same hash.
  std::pair<int, int> repeats();
  /// What could not be read of the records, one line each. After rows().
  const std::vector<std::string>& notices() const { return notices_; }

 private:
  RunRow measured(const std::string& key);

  std::vector<PlannedRun> campaign_;
  std::set<std::string> keys_;  ///< of its runs
  std::filesystem::path results_;
  std::map<std::string, RunRow> finished_;  ///< by key; measured by rows()
  std::map<std::string, RunRow> given_;     ///< by key
  std::vector<RunRow> rows_, foreign_;
  std::vector<std::string> notices_;
};

}  // namespace ballast
