// One state of a run as a file for other programs.

#include <cmath>
#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/export/state_export.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/record/recorder.hpp"
#include "experiments/run/prepared_run.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

struct ExportOptions {
  std::filesystem::path source, output;
  std::string format_name = "obj";
  ExportFormat format = ExportFormat::obj;
  double time = std::numeric_limits<double>::quiet_NaN();
  bool last = false;
};

/// The stored frame nearest in time.
void state_at(const std::filesystem::path& folder, double time, MotionState& state) {
  const std::vector<PoseFrame> frames = read_poses(folder);
  if (frames.empty()) throw Error(folder.string() + ": no poses are stored there");
  const PoseFrame* nearest = &frames.front();
  for (const PoseFrame& frame : frames)
    if (std::abs(frame.time - time) < std::abs(nearest->time - time)) nearest = &frame;
  state = {nearest->time, nearest->step, nearest->pose, nearest->velocity, nearest->spin};
}

ExitCode export_run(const ExportOptions& options) {
  if (!std::filesystem::exists(options.source))
    throw Error(options.source.string() + ": no such run folder or checkpoint");
  const bool is_folder = std::filesystem::is_directory(options.source);
  const std::filesystem::path folder =
      is_folder ? options.source : std::filesystem::absolute(options.source).parent_path();
  MotionState state;
  const MechanicalSystem system = system_of_run(folder, state);
  if (!is_folder) {
    state = read_checkpoint(options.source).state;
  } else if (!std::isnan(options.time)) {
    state_at(folder, options.time, state);
  }
  if (state.pose.size() != system.bodies.size())
    throw Error(options.source.string() + ": holds " + std::to_string(state.pose.size()) +
                " bodies, the scene beside it " + std::to_string(system.bodies.size()));
  export_state(system, state, options.format, options.output);
  std::cout << options.output.string() << ": state at " << state.time << " s, step " << state.step
            << '\n';
  return ExitCode::ok;
}

}  // namespace

Command export_command() {
  const auto options = std::make_shared<ExportOptions>();
  return {"export",
          "Writes one state of a run for other programs",
          {{"source", &options->source, "A run's folder, or a checkpoint in it", required},
           {"--format", &options->format_name,
            "obj: grains as meshes; text: a table of bodies; vtp: ParaView; engines: two files for "
            "other engines' benches",
            shown, into(options->format, export_format)},
           {"--output FILE", &options->output, "The file to write", required},
           {"--time", &options->time, "The stored frame nearest to this time [s]"},
           {"--last", &options->last, "The latest checkpoint (default)", excludes("--time")}},
          [options] { return export_run(*options); }};
}

}  // namespace ballast
