#pragma once
// Where the paper and Ballast differ, and what was varied to find out why: the parts of that
// section.

#include <string>
#include <vector>

#include "experiments/paper/paper_data.hpp"
#include "experiments/paper/section.hpp"

namespace ballast {

/// One candidate cause: what the runs with it gave, by frequency.
struct Variant {
  std::string name;
  std::vector<VariedValue> values;  ///< value: nu [Hz], growing
  int reference = -1;  ///< index of the variant that differs from this one in the one thing alone
                       ///< (the same sample and periods); -1: none
  const VariedValue* at(double frequency) const;
};
/// The campaign's mean, its sample 1, then the causes that have been driven at more than one
/// frequency. Empty while the campaign has no sample 1 at two of its compared frequencies.
std::vector<Variant> variants_of(PaperData& data);

/// Exponent of a quantity between two values of what is varied: the mean over the samples that both
/// have, each compared with itself, since what a sample does at both values cancels.
SampleMean exponent_between(const VariedValue& a, const VariedValue& b,
                            double Observation::*quantity);
/// The quantity at x = `at` on the power law through two values of what is varied: the mean over
/// the samples that both have.
SampleMean interpolated(const VariedValue& a, const VariedValue& b, double at,
                        double Observation::*quantity);

/// Exponents between neighbouring frequencies, and between neighbouring f_max: two figures, two
/// tables.
void add_local_exponents(PaperData& data, const std::vector<Variant>& variants,
                         PaperSection& section);
/// What follows from rigid grains alone: the box at half scale, and the exponent of g from those of
/// nu and f_max.
void add_similarity(PaperData& data, PaperSection& section);

}  // namespace ballast
