#pragma once
// One quantity of a record, over its steps.

#include <span>
#include <vector>

#include "experiments/step_record.hpp"

namespace ballast {

/// One entry per step, times `factor` (from SI to what a figure shows).
std::vector<double> record_column(std::span<const StepRecord> steps, double StepRecord::*value, double factor = 1.0);

}  // namespace ballast
