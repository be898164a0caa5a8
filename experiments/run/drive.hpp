#pragma once
// The loop of a run: step, measure, record, checkpoint; it ends with the scene, on request, or at a
// time limit.

#include <string>

#include "experiments/run/prepared_run.hpp"
#include "experiments/run/run_folder.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {

enum class DriveEnd { finished, interrupted, time_limit };

struct DriveOrder {
  RunFolder folder;           ///< where records and checkpoints go
  std::string capture;        ///< which steps to keep (CaptureSettings::parse); empty: none
  double max_seconds = 1e30;  ///< wall clock of the loop
  Telling telling = Telling::reader;
};

/// Steps from run.state to the end of the scene; `run` is then where it ended. A checkpoint is
/// written every record.checkpoint_seconds and at the end, whatever ends it; records are made safe
/// before it, so that they never lack what it has. Times, error and memory are noted in the
/// manifest. Throws Error.
DriveEnd drive(const ResolvedScene& resolved, const DriveOrder& order, PreparedRun& run,
               Manifest& manifest);

}  // namespace ballast
