#pragma once
// A synthetic box in the form that the pages of a run read.

#include "experiments/measure/run_data.hpp"
#include "tests/support/synthetic_run.hpp"

namespace ballast {

inline MeasuredRun box_run(const SyntheticBox& box = {}) {
  MeasuredRun run;
  run.data.steps = synthetic_box(box);
  run.data.facts = facts_of(box);
  run.summary = summarise(run.data.steps, run.data.facts);
  return run;
}

inline MeasuredRun slide_run() {
  MeasuredRun run;
  run.data.steps = synthetic_slide();
  run.summary = summarise(run.data.steps, run.data.facts);
  return run;
}

}  // namespace ballast
