#pragma once
// What a campaign has produced so far: finished runs, measured. Whatever is missing is counted and
// said, never an error.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/paper/campaign.hpp"
#include "experiments/paper/run_observables.hpp"

namespace ballast {

/// For Curve::origins: "runs 3 14", numbers in the campaign.
std::string origin_of_runs(const std::vector<size_t>& runs);

/// One value of what is varied, with what its seeds gave.
struct VariedValue {
  double value = 0.0;
  std::string label;
  int planned = 0;                   ///< seeds that the campaign has
  std::vector<Observation> samples;  ///< seeds that are finished
  std::vector<int> seeds;            ///< theirs, growing
  std::vector<size_t> runs = {};     ///< theirs, in the campaign
  std::string origin() const { return origin_of_runs(runs); }
  SampleMean mean(double Observation::*quantity) const;
  const Observation* of_seed(int seed) const;  ///< null: not finished
};

class PaperData {
 public:
  /// `rows`: of runs whose records are elsewhere (another's runs.csv); runs that are there have
  /// their own.
  PaperData(Campaign campaign, std::filesystem::path results,
            std::vector<RunObservables> rows = {});

  const Campaign& campaign() const { return campaign_; }
  const std::filesystem::path& results() const { return results_; }

  /// Values in growing order; those without a finished run are left out.
  std::vector<VariedValue> values(Varied which);
  /// "3 of 10 frequencies; 5 of 30 runs": empty when everything planned is there.
  std::string missing(Varied which) const;

  /// Its record is there.
  bool has(size_t run) const;
  /// Its record is there, or its row.
  bool knows(size_t run) const;
  std::filesystem::path folder(size_t run) const;
  /// A finished run's record. Throws Error.
  RunData read(size_t run) const;
  /// Every finished run, measured, in the campaign's order: read once, on the first call. Those of
  /// which only a row is known stand among them.
  const std::vector<RunObservables>& observables();
  /// The one of this run; null: not finished.
  const RunObservables* observables_of(size_t run);
  /// Finished ones of Campaign::motion.
  std::vector<size_t> motion() const;
  /// The finished run of a seed at this of the frequencies that are varied.
  std::optional<size_t> at_frequency(double frequency, int seed) const;
  int finished() const;
  /// Runs of which a row alone is known.
  int known_by_row() const;
  /// Names of given rows that are of no run of the campaign: nothing is drawn from them.
  std::vector<std::string> foreign_rows() const;
  /// Runs made here whose row was given too: how many, and of how many both have the same hash.
  struct Repeats {
    int made = 0, same = 0;
  };
  Repeats repeats();

 private:
  /// Is what the point asks for known?
  bool serves(const CampaignPoint& point) const;
  const Observation* observation(const CampaignPoint& point);
  const RunObservables* row_of(size_t run) const;  ///< null: none was given

  Campaign campaign_;
  std::filesystem::path results_;
  std::vector<bool> finished_;
  std::map<std::string, RunObservables> rows_;  ///< by key
  std::vector<RunObservables> observables_;
  std::map<std::pair<size_t, double>, Observation> seen_;  // by run and window
};

/// Many values of what is varied, as a note calls them: "frequencies".
const char* plural_of(Varied varied);

}  // namespace ballast
