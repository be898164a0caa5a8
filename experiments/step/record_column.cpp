#include "experiments/step/record_column.hpp"

namespace ballast {

std::vector<double> record_column(std::span<const StepRecord> steps, double StepRecord::*value,
                                  double factor) {
  std::vector<double> values;
  values.reserve(steps.size());
  for (const StepRecord& step : steps) values.push_back(factor * (step.*value));
  return values;
}

double step_seconds(const StepRecord& step) {
  return step.seconds_detect + step.seconds_assemble + step.seconds_solve + step.seconds_judge +
         step.seconds_correct + step.seconds_other;
}

}  // namespace ballast
