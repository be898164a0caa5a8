#include "experiments/paper/run_observables.hpp"

#include <bit>
#include <cmath>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/measure/run_summary.hpp"
#include "experiments/record/record_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

RunSetup setup_of(const RunData& data) {
  RunSetup setup;
  setup.grains = grain_count(data);
  setup.height = data.summary_number("packing_top_m");
  if (!data.scene || !data.scene->grains) return setup;
  const Scene& scene = *data.scene;
  setup.seed = static_cast<int>(scene.grains->seed);
  setup.solver = scene.solver.name;
  setup.iterations_most = scene.solver.max_iterations;
  setup.tolerance = scene.solver.tolerance;
  setup.length = scene.box.length;
  setup.width = scene.box.width;
  setup.lid_raise = scene.drive.lid_raise;
  const double part = scene.grains->size_convention == SizeConvention::radius ? 1.0 : 0.5;
  for (const SizeClass& c : scene.grains->distribution)
    setup.largest_size = std::fmax(setup.largest_size, part * c.size);
  setup.friction = scene.friction;
  setup.deposit_friction = scene.deposit.friction;
  setup.lid_pressure = scene.deposit.lid_pressure_weight;
  setup.start_noise = scene.drive.start_noise;
  return setup;
}

/// rho at the stroke's begin, its peak and the period's end.
template <class Fraction>
PhaseGains gains_of(std::span<const StepRecord> steps, const std::vector<WallPeriod>& periods,
                    const Fraction& fraction_at) {
  std::vector<double> out, in;
  for (const WallPeriod& period : periods) {
    // the last step at the least place before the peak
    size_t start = period.first;
    for (size_t k = period.first; k <= period.peak; ++k)
      if (steps[k].wall_x <= period.x_before) start = k;
    const double peak = fraction_at(period.peak);
    out.push_back(peak - fraction_at(start));
    in.push_back(fraction_at(period.last - 1) - peak);
  }
  return {statistics(out).mean, statistics(in).mean};
}

/// What the poses of a run say.
class StoredPoses {
 public:
  StoredPoses(const RunData& data, const WallCycles& cycles)
      : steps_(data.steps),
        cycles_(cycles),
        scene_(*data.scene),
        system_(read_record_system(data.folder / "record.h5")),
        frames_(read_record_poses(data.folder / "record.h5")),
        top_(data.summary_number("packing_top_m")),
        volume_(box_control_volume(scene_, top_)) {}

  void measure(RunObservables& run) const {
    run.before = fractions_at(0.0);
    run.after = fractions_at(paper_window.begin);
    measure_layers(run);
    measure_roll(run);
  }

 private:
  /// The frame at a time, to a step; null without one.
  const PoseFrame* frame_at(double time) const {
    for (const PoseFrame& frame : frames_)
      if (std::abs(frame.time - time) < 0.6 * scene_.step) return &frame;
    return nullptr;
  }

  MotionState state_of(const PoseFrame& frame) const {
    return {frame.time, frame.step, frame.pose, frame.velocity, frame.spin};
  }

  SolidFractions fractions_at(double time) const {
    const PoseFrame* frame = frame_at(time);
    if (!frame) return {};
    const MotionState state = state_of(*frame);
    const double x_max =
        state.pose[static_cast<size_t>(system_.grain_count) + wall_x_max].position.x();
    const ControlVolume walls(Vec3::Zero(), Vec3(x_max, scene_.box.width, top_));
    return solid_fractions(system_, state, volume_, walls, scene_.control_volume.margin_x);
  }

  /// rho of the layers against time is read off the frames on both sides: only where these are
  /// dense enough to see a period.
  void measure_layers(RunObservables& run) const {
    const double period = 1.0 / scene_.drive.frequency;
    if (frames_.size() < 3 || frames_[1].time - frames_[0].time > 0.1 * period) return;
    std::vector<LayerFractions> fractions;
    for (const PoseFrame& frame : frames_)
      fractions.push_back(layer_fractions(system_, state_of(frame), volume_));
    for (size_t layer = 0; layer < run.layers.size(); ++layer)
      run.layers[layer] = gains_of(steps_, cycles_.periods, [&](size_t k) {
        return between_frames(steps_[k].time, fractions, layer);
      });
  }

  double between_frames(double time, const std::vector<LayerFractions>& fractions,
                        size_t layer) const {
    size_t k = 1;
    while (k + 1 < frames_.size() && frames_[k].time < time) ++k;
    const double part = (time - frames_[k - 1].time) / (frames_[k].time - frames_[k - 1].time);
    return std::lerp(fractions[k - 1][layer], fractions[k][layer], part);
  }

  /// Displacements over whole periods, along a rectangle halfway between the middle and the walls.
  void measure_roll(RunObservables& run) const {
    const std::vector<Displacement> all = period_displacements(
        frames_, cycles_.periods, scene_.step, static_cast<size_t>(system_.grain_count));
    const double length = scene_.box.length;
    run.roll = roll_of(all, {0.25 * length, 0.75 * length, 0.25 * top_, 0.75 * top_},
                       run.setup.largest_size);
  }

  std::span<const StepRecord> steps_;
  const WallCycles& cycles_;
  const Scene& scene_;
  MechanicalSystem system_;
  std::vector<PoseFrame> frames_;
  double top_;
  ControlVolume volume_;
};

}  // namespace

double grain_count(const RunData& data) {
  const double noted = data.summary_number("grains");
  if (std::isfinite(noted)) return noted;
  return data.scene && data.scene->grains ? data.scene->grains->count : not_known;
}

double RunObservables::force_over_weight() const {
  return seen.facts.f_max / (seen.facts.grain_mass * seen.facts.gravity);
}

double RunObservables::wall_mass_over_grains() const {
  return seen.facts.wall_mass / seen.facts.grain_mass;
}

std::string record_hash(std::span<const StepRecord> steps) {
  std::uint64_t hash = fnv1a("");
  for (const StepRecord& step : steps)
    for (const StepColumn& column : step_columns()) {
      if (column.phase) continue;
      const auto bits = std::bit_cast<std::array<char, sizeof(double)>>(step.*column.value);
      hash = fnv1a({bits.data(), bits.size()}, hash);
    }
  return hash_text(hash);
}

RunObservables observe_run(const RunData& data) {
  RunObservables run;
  run.record = record_hash(data.steps);
  run.setup = setup_of(data);
  run.seen = observe(data.steps, data.facts, run.setup.grains);
  const RunSummary summary = summarise(data.steps, data.facts);
  run.iterations = summary.iterations;
  run.jam = summary.jammed;
  run.speed_out = summary.speed_out.mean;
  const RunFacts& facts = summary.facts;
  if (!summary.wall.periods.empty()) {
    run.law = force_law(data.steps, summary.wall, facts.grain_mass, facts.wall_mass, facts.gravity);
    run.gains = gains_of(data.steps, summary.wall.periods,
                         [&](size_t k) { return data.steps[k].solid_fraction; });
  }
  // a record without poses still has its steps
  if (!data.scene || !data.scene->grains) return run;
  try {
    StoredPoses(data, summary.wall).measure(run);
  } catch (const Error&) {
  } catch (const std::invalid_argument&) {  // a control volume that is none
  }
  return run;
}

}  // namespace ballast
