#pragma once
// Quantities of a record: one over its steps, and what a step took.

#include <span>
#include <vector>

#include "experiments/step/step_record.hpp"

namespace ballast {

/// One entry per step, times `factor` (from SI to what a figure shows).
std::vector<double> record_column(std::span<const StepRecord> steps, double StepRecord::*value,
                                  double factor = 1.0);

/// Wall clock of a step: all its phases [s].
double step_seconds(const StepRecord& step);

}  // namespace ballast
