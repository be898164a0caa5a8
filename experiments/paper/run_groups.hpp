#pragma once
// Groups of runs that are compared: one thing was varied alone, and each value of it has its
// samples. The sections beyond the paper are tables over such groups, and what follows from them.

#include <string>
#include <vector>

#include "experiments/paper/sections.hpp"

namespace ballast {

struct RunGroup {
  std::string name;
  std::vector<VariedValue> values = {};  ///< growing
  int reference = -1;  ///< index of the group that differs from this one in the one thing alone
                       ///< (the same sample and periods); -1: none

  const VariedValue* at(double value) const;  ///< null: none
  /// Not known where there is no such value.
  SampleMean mean_at(double value, double Observation::*quantity) const;
};

/// Logarithms of a quantity, one of each sample.
std::vector<double> logs_of(const VariedValue& value, double Observation::*quantity);

/// How the logarithm of a quantity scatters, pooled over values of what is varied: between samples
/// of grains; and from run to run of one packing, where what a packing has in common at all values
/// is taken out (of the values that have every packing).
PooledError scatter_between(const std::vector<VariedValue>& values, double Observation::*quantity);
PooledError scatter_paired(const std::vector<VariedValue>& values, double Observation::*quantity);

/// The words of a table, in which {observables} stands for the heads of observable_columns().
page::Table observable_table(const std::string& name);

/// Exponent of a quantity between two values of what is varied: the mean over the samples that both
/// have, each compared with itself, since what a sample does at both values cancels.
SampleMean exponent_between(const VariedValue& a, const VariedValue& b,
                            double Observation::*quantity);
/// The quantity at x = `at` on the power law through two values of what is varied: the mean over
/// the samples that both have.
SampleMean interpolated(const VariedValue& a, const VariedValue& b, double at,
                        double Observation::*quantity);

/// What was varied to find out where the paper and Ballast differ; values: nu [Hz]. The campaign's
/// mean, its sample 1, then the causes that have been driven at more than one frequency. Empty
/// while the campaign has no sample 1 at two of its compared frequencies.
std::vector<RunGroup> causes_of(PaperData& data);

/// Exponents between neighbouring frequencies, and between neighbouring f_max: two figures, two
/// tables.
void add_local_exponents(PaperData& data, const std::vector<RunGroup>& causes,
                         PaperSection& section);
/// What follows from rigid grains alone: the box at half scale, and the exponent of g from those of
/// nu and f_max.
void add_similarity(PaperData& data, PaperSection& section);

}  // namespace ballast
