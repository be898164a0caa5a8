#pragma once
// Captures friction problems of a run as files that FCLIB's tools and `ballast compare` read
// (problems/files/captured_problem).
//
// Steps are captured in groups of consecutive ones: only then is a warm start the one of the run.

#include <filesystem>
#include <string_view>
#include <utility>

#include "experiments/step/time_step.hpp"
#include "problems/files/captured_problem.hpp"

namespace ballast {

/// The steps to capture, counted from 1: the first `steps` of every `every` steps, between `from`
/// and `to`. By default none.
struct CaptureSettings {
  long every = 0;  ///< 0: all steps from `from` to `to` are one group
  long steps = 2;  ///< of each group; default of parse() where every is 1: 1
  long from = 1, to = 0;
  long also = 0;  ///< one more step, also outside the range; 0: none

  /// Reads "every=50", "from=1000,to=1020", "every=100,steps=3,from=2000,also=10"; an empty text:
  /// none. Throws std::invalid_argument saying what is wrong.
  static CaptureSettings parse(std::string_view text);
  bool takes(long step) const;
};

/// Writes step_0000050.hdf5, ... into `folder`, which is made with the first file. `h` [s] and `g`
/// [m/s^2] are those of the run. Capture only reads: a run has the same bits with and without it.
class StepCapture {
 public:
  StepCapture(const CaptureSettings& settings, std::filesystem::path folder, double h, double g)
      : settings_(settings), folder_(std::move(folder)), h_(h), g_(g) {}

  /// To be called for every earlier step of a resumed run.
  void see(const StepRecord& record);
  /// To be called after a step. Throws Error.
  void observe(const TimeStepper& stepper, const MotionState& state, const StepMemory& memory,
               const StepRecord& record);

 private:
  CaptureSettings settings_;
  std::filesystem::path folder_;
  double h_, g_;
  double fastest_wall_ = 0.0;  ///< largest speed of the driven wall so far [m/s]
};

}  // namespace ballast
