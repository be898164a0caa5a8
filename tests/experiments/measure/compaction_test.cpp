#include "experiments/measure/compaction.hpp"

#include <cmath>
#include <numbers>

#include "tests/catch.hpp"

namespace ballast {
namespace {

constexpr double row_step = 1e-3, load_frequency = 5.0;

/// rho grows by `gain` a period and swings within it, which must not enter.
std::vector<StepRecord> growing(double gain, double duration) {
  std::vector<StepRecord> steps;
  for (long k = 1; k <= std::lround(duration / row_step); ++k) {
    StepRecord step;
    step.time = static_cast<double>(k) * row_step;
    const double turns = step.time * load_frequency;
    step.solid_fraction = 0.5 + gain * turns + 0.01 * std::sin(2.0 * std::numbers::pi * turns);
    steps.push_back(step);
  }
  return steps;
}

Compaction measured(const std::vector<StepRecord>& steps) {
  return compaction_of(steps, wall_cycles(steps, load_frequency, row_step).periods, 0.49,
                       load_frequency, row_step);
}

TEST_CASE("compaction of a solid fraction that grows and swings") {
  const auto steps = growing(0.002, 2.0);
  const Compaction compaction = measured(steps);
  CHECK(compaction.initial == 0.49);
  CHECK(compaction.reference == Approx(0.502));  // one period after the start
  CHECK(compaction.last == Approx(0.52));
  CHECK(compaction.gain == Approx(0.002));
  CHECK(compaction.relative_gain == Approx(0.002 / 0.502));
  CHECK(compaction.rate == Approx(0.002 * load_frequency / 0.502));
  CHECK(compaction.rate_common == Approx(compaction.rate));
}

TEST_CASE("the two windows of Eq. 4 see what happens in them") {
  auto steps = growing(0.0, 2.0);
  for (StepRecord& step : steps)
    if (step.time > 1.5) step.solid_fraction += 0.01;
  const Compaction compaction = measured(steps);
  CHECK(compaction.rate == Approx(0.01 / (0.5 * 1.8)));
  CHECK(compaction.rate_common == Approx(0.0).margin(1e-12));  // ends at 1 s
}

TEST_CASE("too short for a whole period there is neither gain nor rate") {
  const Compaction compaction = measured(growing(0.002, 0.3));
  CHECK(compaction.reference == Approx(0.502));
  CHECK(std::isnan(compaction.gain));
  CHECK(std::isnan(compaction.rate));
  CHECK(
      std::isnan(compaction_rate(growing(0.002, 1.0), load_frequency, row_step, 0.5, {0.85, 1.0})));
  CHECK(std::isnan(compaction_rate({}, load_frequency, row_step, 0.5, paper_window)));
}

TEST_CASE("without a known frequency the solid fraction is still told") {
  const auto steps = growing(0.002, 1.0);
  const Compaction compaction = compaction_of(steps, {}, 0.49, not_known, row_step);
  CHECK(compaction.reference == Approx(0.502));
  CHECK(std::isnan(compaction.gain));
  CHECK(std::isnan(compaction.rate));
}

}  // namespace
}  // namespace ballast
