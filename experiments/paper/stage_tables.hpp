#pragma once
// What the sections of the decisive stages share: one table over their groups of runs, and what a
// group changes, sample by sample.

#include <string>
#include <vector>

#include "experiments/paper/run_groups.hpp"

namespace ballast {

/// A measure of a run, SI units; NaN: not known.
using RunMeasure = double (*)(const RunObservables& run);

double rise_of(const RunObservables& run);           ///< Delta x_max [m]
double speed_of(const RunObservables& run);          ///< v_max [m/s]
double prefactor_of_run(const RunObservables& run);  ///< C = Delta x_max / X
double theory_of(const RunObservables& run);         ///< C by F and M as measured (force_law.hpp)
double push_of(const RunObservables& run);           ///< F/(m g)

/// The columns of stage_table, and their names with units.
struct StageColumn {
  const char* head;
  double factor;  ///< from SI
  RunMeasure value;
};
std::span<const StageColumn> stage_columns();

/// Mean over the finished samples of a value.
SampleMean mean_of(PaperData& data, const VariedValue& value, RunMeasure measure);

/// A row for each group and value. words(name) is "caption, then case || {columns}".
page::Table stage_table(PaperData& data, const std::string& name,
                        const std::vector<RunGroup>& cases);

/// ln of `measure` at `to` less that at `from`, over the samples that both have.
Difference log_change(PaperData& data, const VariedValue& from, const VariedValue& to,
                      RunMeasure measure);
/// "+3.1 % [0.2, 6.1]" with the 95 % interval of so few samples; one sample has none.
page::Text words_of_change(const Difference& change);

/// Exponent of `measure` in `along` over the values, fitted to each sample by itself: its mean over
/// the samples with at least so many values. What a packing does at all values drops out.
SampleMean exponent_by_sample(PaperData& data, const std::vector<VariedValue>& values,
                              RunMeasure along, RunMeasure measure, size_t fewest = 3);
/// "−1.00 [−1.2, −0.8]": the 95 % interval by Student's t; without one where there is one sample.
page::Text words_with_interval(const SampleMean& mean);

}  // namespace ballast
