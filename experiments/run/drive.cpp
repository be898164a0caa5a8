#include "experiments/run/drive.hpp"

#include <sys/resource.h>

#include <cmath>
#include <optional>

#include "experiments/export/paraview.hpp"
#include "experiments/record/progress.hpp"
#include "experiments/record/recorder.hpp"
#include "experiments/run/capture.hpp"
#include "experiments/step/step_record.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/interrupt.hpp"

namespace ballast {
namespace {

/// Steps between two that are `rate` [Hz] apart, at least one; 0: none is asked for.
long steps_between(double rate, double h) {
  return rate > 0.0 ? std::max(1L, std::lround(1.0 / (rate * h))) : 0;
}

/// The loop with all that it writes.
class Drive {
 public:
  Drive(const ResolvedScene& resolved, const DriveOrder& order, const StepSettings& settings,
        PreparedRun& run, Recorder& recorder)
      : scene_(resolved.scene),
        key_(resolved.key),
        order_(order),
        h_(settings.h),
        run_(run),
        stepper_(run.system, settings, run.driven_wall),
        recorder_(recorder),
        pose_every_(steps_between(scene_.record.pose_rate, h_)),
        state_every_(steps_between(scene_.record.state_rate, h_)),
        progress_(order.telling) {
    if (scene_.record.paraview) paraview_.emplace(order.folder.path(), run.system, run.state.step);
    if (!order.capture.empty())
      capture_.emplace(CaptureSettings::parse(order.capture), order.folder.capture(), h_,
                       scene_.gravity.norm());
    if (state_every_ > 0) create_folder(order.folder.states());
  }

  DriveEnd loop() {
    const Stopwatch watch;
    Stopwatch since_saved;
    DriveEnd end = DriveEnd::finished;
    // The first frame is the state that the drive begins with.
    if (run_.state.step == 0) store_poses();
    while (run_.state.step < scene_.step_count()) {
      StepRecord record = stepper_.step(run_.state, run_.memory);
      measure(record);
      store(record);
      if (run_.state.step >= scene_.step_count()) continue;
      if (InterruptGuard::requested())
        end = DriveEnd::interrupted;
      else if (watch.seconds() > order_.max_seconds)
        end = DriveEnd::time_limit;
      if (end != DriveEnd::finished) break;
      if (since_saved.seconds() > scene_.record.checkpoint_seconds) {
        save();
        since_saved.restart();
      }
    }
    save();
    progress_.finish();
    return end;
  }

 private:
  bool is_due(long every) const { return every > 0 && run_.state.step % every == 0; }

  /// What is measured between steps counts as part of the step's wall clock, here alone.
  void measure(StepRecord& record) {
    const Stopwatch watch;
    if (run_.control_volume)
      record.solid_fraction =
          run_.control_volume->solid_fraction(run_.system, run_.state, stepper_.team());
    if (capture_) capture_->observe(stepper_, run_.state, record);
    record.seconds_other += watch.seconds();
  }

  void store(const StepRecord& record) {
    recorder_.add_step(record);
    if (is_due(pose_every_)) store_poses();
    if (is_due(state_every_))
      write_checkpoint(order_.folder.state_at(run_.state.step), checkpoint());
    progress_.show(scene_.name, run_.state.time, scene_.duration, record);
  }

  void store_poses() {
    recorder_.add_poses(run_.state);
    recorder_.add_forces(run_.state, run_.memory, h_);
    if (paraview_) paraview_->add(run_.state, run_.memory.contacts, run_.memory.impulses, h_);
  }

  Checkpoint checkpoint() const { return {key_, "drive", run_.state, run_.memory, {}}; }

  void save() {
    recorder_.flush();
    write_checkpoint(order_.folder.checkpoint(), checkpoint());
  }

  const Scene& scene_;
  const std::string& key_;
  const DriveOrder& order_;
  double h_;
  PreparedRun& run_;
  TimeStepper stepper_;
  Recorder& recorder_;
  long pose_every_, state_every_;
  std::optional<ParaviewSeries> paraview_;
  std::optional<StepCapture> capture_;
  Progress progress_;
};

/// Of all steps, also those before the run was last resumed.
void note_record(const RunFolder& folder, double velocity_scale, Manifest& manifest) {
  const std::vector<StepRecord> steps = read_steps(folder.path());
  double seconds = 0.0, error = 0.0;
  for (const StepRecord& row : steps) {
    error += row.error_rms / velocity_scale / static_cast<double>(steps.size());
    seconds += step_seconds(row);
  }
  manifest.summary("drive_seconds", seconds);
  manifest.summary("error_mean_relative", error);
}

}  // namespace

DriveEnd drive(const ResolvedScene& resolved, const DriveOrder& order, PreparedRun& run,
               Manifest& manifest) {
  const StepSettings settings = step_settings(resolved.scene);
  manifest.summary("step_s", settings.h);
  manifest.summary("velocity_scale_m_s", settings.velocity_scale());
  Recorder recorder(order.folder.path(), run.system, run.state.step, resolved.scene.record.forces);
  const Stopwatch watch;
  const long first = run.state.step;
  // What the steps need is given back before the record is put together in memory.
  const DriveEnd end = Drive(resolved, order, settings, run, recorder).loop();
  if (run.state.step > first)
    manifest.summary("ms_per_step",
                     1e3 * watch.seconds() / static_cast<double>(run.state.step - first));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  manifest.summary("peak_memory_MB", static_cast<double>(usage.ru_maxrss) / 1024.0);
  manifest.summary(steps_left_entry,
                   static_cast<double>(resolved.scene.step_count() - run.state.step));
  recorder.finish(resolved.text, manifest.text());
  note_record(order.folder, settings.velocity_scale(), manifest);
  return end;
}

}  // namespace ballast
