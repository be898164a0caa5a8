#pragma once
// The 5 Hz runs as Figs. 3, 4, 5, 6 and 7 need them.

#include "experiments/paper/sections.hpp"

namespace ballast {

/// A run with its summary: periods counted by the campaign's rule.
struct MotionRun {
  RunData data;
  RunSummary summary;
};

/// Finished 5 Hz runs; what is missing is noted in `section`.
std::vector<MotionRun> read_motion(PaperData& data, PaperSection& section);

/// Mean over runs of a number of the summary, with its standard error.
template <class Function>
SampleMean mean_over(const std::vector<MotionRun>& runs, const Function& quantity) {
  std::vector<double> values;
  for (const MotionRun& run : runs) values.push_back(quantity(run.summary));
  return sample_mean(values);
}

}  // namespace ballast
