// States of a run as files for other programs.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "experiments/commands/command.hpp"
#include "experiments/export/state_export.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/record/recorder.hpp"
#include "experiments/run/prepared_run.hpp"
#include "experiments/view/still.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

struct ExportOptions {
  std::filesystem::path source, output;
  std::optional<double> time;  ///< [s]
  bool all = false;
  std::string time_word, view_word, frames_word;
  std::optional<std::pair<size_t, size_t>> frames;  ///< of pictures: numbers of the first and last
  StillOptions still;
};

std::optional<double> parsed_time(const std::string& word) {
  if (word.empty()) return std::nullopt;
  const std::optional<double> time = parsed_number(word);
  if (!time || !std::isfinite(*time))
    throw std::invalid_argument("'" + word + "' is no time: expected a finite number [s]");
  return time;
}

/// "35" or "20:40".
std::optional<std::pair<size_t, size_t>> parsed_frames(const std::string& word) {
  if (word.empty()) return std::nullopt;
  const std::vector<std::string> ends = split(word, ':');
  const auto first = parsed<int>(ends[0]), last = parsed<int>(ends.back());
  if (ends.size() > 2 || !first || !last || *first < 0 || *last < *first)
    throw std::invalid_argument("'" + word + "': expected the number of a frame, or FIRST:LAST");
  return std::pair(static_cast<size_t>(*first), static_cast<size_t>(*last));
}

std::vector<MotionState> frames_of(const std::filesystem::path& folder) {
  std::vector<MotionState> frames = read_poses(folder);
  if (frames.empty()) throw Error(folder.string() + ": no poses are stored there");
  return frames;
}

/// The stored frame nearest in time.
size_t frame_at(const std::vector<MotionState>& frames, double time) {
  const auto nearest = std::min_element(frames.begin(), frames.end(),
                                        [&](const MotionState& a, const MotionState& b) {
                                          return std::abs(a.time - time) < std::abs(b.time - time);
                                        });
  return static_cast<size_t>(nearest - frames.begin());
}

void require_bodies(const ExportOptions& options, const MechanicalSystem& system, size_t bodies) {
  if (bodies != system.bodies.size())
    throw Error(options.source.string() + ": holds " + std::to_string(bodies) +
                " bodies, the scene beside it " + std::to_string(system.bodies.size()));
}

/// Every stored frame as a file of its own.
ExitCode export_all(const ExportOptions& options, const MechanicalSystem& system) {
  const std::vector<MotionState> states = frames_of(options.source);
  require_bodies(options, system, states.front().pose.size());
  std::optional<RecordForces> forces;
  if (const auto record = options.source / "record.h5"; is_there(record)) forces.emplace(record);
  export_series(system, states, forces ? &*forces : nullptr, options.output);
  std::cout << series_file(options.output, states.front().step).string() << " to "
            << series_file(options.output, states.back().step).filename().string() << ": "
            << states.size() << " states from " << states.front().time << " s to "
            << states.back().time << " s\n";
  return ExitCode::ok;
}

/// Stored frames drawn without a display: one, or a picture that moves.
ExitCode export_picture(const ExportOptions& options) {
  const std::optional<ViewData> view = view_of_run(read_run_data(options.source));
  if (!view) throw Error(options.source.string() + ": no poses are stored there");
  if (options.still.with_chains && !view->contacts)
    throw Error(options.source.string() +
                ": no forces are stored there (--set record.forces=true)");
  const std::vector<MotionState>& frames = view->frames;
  const size_t one = frame_at(frames, options.time.value_or(frames.back().time));
  const auto [first, last] = options.frames.value_or(std::pair(one, one));
  if (last >= frames.size())
    throw Error(options.source.string() + ": has frames 0 to " + std::to_string(frames.size() - 1) +
                ", not --frames " + options.frames_word);
  std::vector<size_t> chosen;
  for (size_t frame = first; frame <= last; ++frame) chosen.push_back(frame);
  write_whole_file(options.output, still_png(*view, chosen, options.still));
  std::cout << options.output.string() << ": frames " << first << " to " << last << ", from "
            << frames[first].time << " s to " << frames[last].time << " s\n";
  return ExitCode::ok;
}

ExitCode export_run(const ExportOptions& options) {
  if (options.output.extension() == ".png") return export_picture(options);
  if (!is_there(options.source))
    throw Error(options.source.string() + ": no such run folder or checkpoint");
  const bool from_folder = is_folder(options.source);
  if (!from_folder && (options.time || options.all))
    throw Error(options.source.string() + ": a checkpoint is one state: give the run's folder");
  const std::filesystem::path folder =
      from_folder ? options.source : std::filesystem::absolute(options.source).parent_path();
  MotionState state;
  const MechanicalSystem system = recorded_system(folder, state);
  if (options.all) return export_all(options, system);
  if (!from_folder)
    state = read_checkpoint(options.source).state;
  else if (options.time)
    state = frames_of(folder)[frame_at(frames_of(folder), *options.time)];
  require_bodies(options, system, state.pose.size());
  export_state(system, state, options.output);
  std::cout << options.output.string() << ": state at " << state.time << " s, step " << state.step
            << '\n';
  return ExitCode::ok;
}

}  // namespace

Command export_command() {
  const auto options = std::make_shared<ExportOptions>();
  return {
      "export",
      "Writes one state of a run, or all, for other programs",
      {{"source", &options->source, "A run's folder, or a checkpoint in it", required},
       {"--output FILE", &options->output,
        "The file to write: .obj, grains as meshes; .vtp, for ParaView; .png, a picture", required},
       {"--time S", &options->time_word, "The stored frame nearest to this time [s]",
        into(options->time, parsed_time)},
       {"--frames N", &options->frames_word,
        ".png: number of the stored frame (the last); FIRST:LAST: a picture that moves",
        into(options->frames, parsed_frames)},
       {"--view FROM", &options->view_word, ".png: home, x, -x, y, -y, z, or YAW,PITCH in degrees",
        parsed([options](const std::string& word) { set_view(options->still, word); })},
       {"--chains", &options->still.with_chains,
        ".png: force chains, bodies as glass; needs a run with record.forces"},
       {"--width PIXELS", &options->still.width, "png", between(16, 8000), shown},
       {"--height PIXELS", &options->still.height, "png", between(16, 8000), shown},
       {"--all", &options->all,
        "Every stored frame: FILE with _<step> before its suffix; with .vtp also the .pvd that "
        "ParaView opens as one series, and the contacts of a run with record.forces",
        excludes("--time")}},
      [options] { return export_run(*options); }};
}

}  // namespace ballast
