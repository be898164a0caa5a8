#pragma once
// Friction problems taken out of a run, as files that FCLIB's tools and `ballast compare` read
// (problems/files/captured_problem).
//
// Consecutive steps are taken together: only so is a warm start what a run would have had.

#include <filesystem>
#include <string_view>

#include "experiments/step/time_step.hpp"
#include "problems/files/captured_problem.hpp"

namespace ballast {

/// Which steps (counted from 1): of every `every` steps the first `steps`, between `from` and `to`.
/// As made: none.
struct CaptureSettings {
  long every = 0;  ///< 0: no group begins anew, all steps from `from` on are one
  long steps = 2;  ///< of each group; where every is 1 and it is not said: 1
  long from = 1, to = 0;
  long also = 0;  ///< one more step, wherever it is; 0: none

  /// "every=50", "from=1000,to=1020", "every=100,steps=3,from=2000,also=10"; nothing: none. Throws
  /// std::invalid_argument saying what is wrong.
  static CaptureSettings parse(std::string_view text);
  bool takes(long step) const;
};

/// Writes step_0000050.hdf5, ... into `folder`, made with the first; `h` [s], `g` [m/s^2]: the
/// run's. Steps are only looked at: a run has the same bits with and without.
class StepCapture {
 public:
  StepCapture(const CaptureSettings& settings, std::filesystem::path folder, double h, double g);

  /// A step of before, of a run that goes on.
  void see(const StepRecord& record);
  /// After a step. Throws Error.
  void observe(const TimeStepper& stepper, const MotionState& state, const StepMemory& memory,
               const StepRecord& record);

 private:
  CaptureSettings settings_;
  std::filesystem::path folder_;
  double h_, g_;
  double fastest_wall_ = 0.0;  ///< so far [m/s]
};

}  // namespace ballast
