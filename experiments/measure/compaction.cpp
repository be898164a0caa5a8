#include "experiments/measure/compaction.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ballast {
namespace {

/// Last sample at or before t (a quarter of a step for rounding); -1 when t is before the first.
long sample_at(std::span<const StepRecord> steps, double t, double h) {
  const auto later = std::find_if(steps.begin(), steps.end(),
                                  [&](const StepRecord& s) { return s.time > t + 0.25 * h; });
  return static_cast<long>(later - steps.begin()) - 1;
}

/// rho at the end of a period minus rho at its begin: both at the same phase of the load, so that
/// the swing within the period drops out. NaN when the begin is not in the record.
double gain_of(std::span<const StepRecord> steps, const WallPeriod& period) {
  if (period.first == 0) return not_known;
  return steps[period.last - 1].solid_fraction - steps[period.first - 1].solid_fraction;
}

}  // namespace

double compaction_rate(std::span<const StepRecord> steps, double frequency, double step,
                       double reference, const TimeWindow& window) {
  if (steps.empty()) return not_known;
  // from the first begin of a period in the window to the last end of one
  const double slack = 0.25 * step, end = std::min(window.end, steps.back().time);
  // Periods begin at multiples of 1 / nu: the first one not before a, the last one not after b.
  const double a = std::ceil((window.begin - slack) * frequency) / frequency,
               b = std::floor((end + slack) * frequency) / frequency;
  if (!(b > a + slack)) return not_known;
  const long first = sample_at(steps, a, step), last = sample_at(steps, b, step);
  if (first < 0 || last <= first) return not_known;
  // C = (rho(b) - rho(a)) / (rho_reference (b - a)) [1/s].
  return (steps[static_cast<size_t>(last)].solid_fraction -
          steps[static_cast<size_t>(first)].solid_fraction) /
         (reference * (b - a));
}

Compaction compaction_of(std::span<const StepRecord> steps, std::span<const WallPeriod> periods,
                         double initial, double frequency, double step) {
  Compaction compaction;
  compaction.initial = initial;
  compaction.last = steps.back().solid_fraction;
  // The reference is the solid fraction where the paper's window begins.
  for (const StepRecord& row : steps)
    if (row.time >= paper_window.begin - 0.25 * step) {
      compaction.reference = row.solid_fraction;
      break;
    }
  for (const WallPeriod& period : periods) compaction.gains.push_back(gain_of(steps, period));
  compaction.gain = statistics(compaction.gains).mean;
  compaction.relative_gain = compaction.gain / compaction.reference;
  const auto rate = [&](const TimeWindow& window) {
    return compaction_rate(steps, frequency, step, compaction.reference, window);
  };
  compaction.rate = rate(paper_window);
  compaction.rate_common = rate(common_window);
  return compaction;
}

}  // namespace ballast
