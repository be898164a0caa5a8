// Fig. 6: velocities of the grains in the passive state, in a section along the middle; mean
// vorticity of the xz plane; and what is left of the motion over whole periods, where a roll would
// be seen.

#include <cmath>

#include "experiments/paper/motion.hpp"
#include "experiments/record/record_file.hpp"

namespace ballast {
namespace {

/// Grains whose centres are this near the middle plane are drawn [m]: two layers.
constexpr double half_section_of_grains = 0.05;
constexpr double rms_arrow = 0.025;  // how long the rms velocity is drawn [m]

/// Arrows as lines: shaft and two barbs, NaN between them. Lengths in the plot's units (axes of
/// equal scale).
void add_arrow(Curve& curve, double x, double z, double dx, double dz) {
  const auto add = [&](double a, double b) {
    curve.x.push_back(a);
    curve.y.push_back(b);
  };
  const double length = std::hypot(dx, dz);
  if (!(length > 0.0)) return;
  // barbs at 2.6 rad (150 degrees) to the shaft
  const double barb = 0.3 * length, c = std::cos(2.6), s = std::sin(2.6);
  add(x, z);
  add(x + dx, z + dz);
  for (const double side : {-s, s}) {
    add(not_known, not_known);
    add(x + dx, z + dz);
    add(x + dx + barb * (c * dx - side * dz) / length,
        z + dz + barb * (side * dx + c * dz) / length);
  }
  add(not_known, not_known);
}

/// Arrows in the box around them, on axes of equal scale.
Figure arrows_in_box(Curve arrows, const XzRectangle& box) {
  constexpr double margin = 0.03;  // [m]
  const Curve walls{.x = {box.x_lo, box.x_hi, box.x_hi, box.x_lo, box.x_lo},
                    .y = {0.0, 0.0, box.z_hi, box.z_hi, 0.0},
                    .ink = Ink::black};
  const double aspect = (box.z_hi + 2.0 * margin) / (box.x_hi - box.x_lo + 2.0 * margin);
  return {.width = 800,
          .height = static_cast<int>(78.0 + 680.0 * aspect),  // margins of plot_layout
          .panels = {{.x_label = "{/:Italic x}  (m): the driven wall is on the right",
                      .y_label = "{/:Italic z}  (m)",
                      .y_min = -margin,
                      .y_max = box.z_hi + margin,
                      .x_min = box.x_lo - margin,
                      .x_max = box.x_hi + margin,
                      .curves = {walls, std::move(arrows)}}}};
}

struct Field {
  Figure figure;
  double wall = 0.0;   ///< inward speed of the wall [m/s]
  double speed = 0.0;  ///< rms of the grains drawn [m/s]
};

Field draw(const StoredState& state) {
  const MotionState& motion = state.at.state;
  // the grains of the section, and how fast they are
  std::vector<size_t> section;
  double squares = 0.0;
  for (size_t k = 0; k < static_cast<size_t>(state.system.grain_count); ++k)
    if (std::abs(motion.pose[k].position.y() - state.middle()) < half_section_of_grains) {
      section.push_back(k);
      squares += motion.velocity[k].squaredNorm();
    }
  const double speed =
      std::sqrt(squares / std::max<double>(1.0, static_cast<double>(section.size())));
  const double scale = speed > 0.0 ? rms_arrow / speed : 0.0;
  Curve arrows{.width = 1.2};
  for (const size_t k : section)
    add_arrow(arrows, motion.pose[k].position.x(), motion.pose[k].position.z(),
              scale * motion.velocity[k].x(), scale * motion.velocity[k].z());
  const double right = state.wall(wall_x_max).x(), left = state.wall(wall_x_min).x();
  return {arrows_in_box(std::move(arrows), {left, right, 0.0, state.wall(wall_lid).z()}),
          -state.wall_speed, speed};
}

/// The mean displacement of a period on a grid: a roll would close. `rms` of the cells [m].
Figure period_field(const MotionRun& run, double& rms) {
  constexpr int columns = 9, rows = 8;
  const auto frames = read_record_poses(run.data.folder / "record.h5");
  const Scene& scene = *run.data.scene;
  const XzRectangle box{0.0, scene.box.length, 0.0, run.data.summary_number("packing_top_m")};
  const RollField field =
      roll_field(period_displacements(frames, run.summary.wall.periods, run.summary.facts.step,
                                      static_cast<size_t>(grain_count(run.data))),
                 box, columns, rows);
  double squares = 0.0, cells = 0.0;
  for (size_t k = 0; k < field.x.size(); ++k)
    if (std::isfinite(field.move_x[k])) {
      squares += field.move_x[k] * field.move_x[k] + field.move_z[k] * field.move_z[k];
      cells += 1.0;
    }
  rms = std::sqrt(squares / cells);
  Curve arrows{.width = 1.2};
  for (size_t k = 0; k < field.x.size(); ++k)
    if (std::isfinite(field.move_x[k]))
      add_arrow(arrows, field.x[k], field.z[k], rms_arrow / rms * field.move_x[k],
                rms_arrow / rms * field.move_z[k]);
  return arrows_in_box(std::move(arrows), box);
}

}  // namespace

PaperSection fig6_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig6.intro")}};
  const std::vector<MotionRun> runs = read_motion(data, section);
  std::vector<double> passive, active, relative;
  Field field;
  for (const MotionRun& run : runs) {
    std::vector<double> in, out;
    for_each_state(run, [&](const StoredState& state) {
      const double vorticity = vorticity_xz(velocity_gradient(state.system, state.at.state));
      if (state.phase == WallPhase::active) out.push_back(vorticity);
      if (state.phase != WallPhase::passive) return;
      in.push_back(vorticity);
      // of the first sample the state with the fastest wall is drawn
      if (&run == &runs.front() && -state.wall_speed > field.wall) field = draw(state);
    });
    passive.push_back(statistics(in).mean);
    active.push_back(statistics(out).mean);
    relative.push_back(passive.back() / (run.summary.speed_in.mean / run.data.scene->box.length));
  }
  const SampleMean seen = sample_mean(passive);
  if (seen.samples == 0 || field.figure.panels.empty()) {
    section.notes.push_back("PARTIAL: no stored state in the passive phase.");
    return section;
  }
  // Seen from the other side every roll turns round, and the text does not say from which side the
  // paper looks: a roll of either sense will do. A mean vorticity holds shear too.
  std::vector<double> round;
  double closed = 0.0;
  for (const size_t run : data.motion())
    if (const RunObservables* observed = data.observables_of(run)) {
      round.push_back(observed->roll.roundness());
      closed += observed->roll.goes_round();
    }
  const SampleMean roundness = sample_mean(round);
  page::Values words{{"wall", page::number(1e3 * field.wall)},
                     {"arrow", page::number(1e3 * field.speed)},
                     {"passive", words_of(seen)},
                     {"active", words_of(sample_mean(active))},
                     {"share", page::number(sample_mean(relative).mean, 2)},
                     {"round", words_of(roundness)},
                     {"closed", page::number(closed)},
                     {"samples", std::to_string(round.size())}};
  section.draw("fig6", field.figure, words);
  if (roundness.samples > 0) {
    double rms = 0.0;
    const Figure drift = period_field(runs.front(), rms);
    words.emplace("drift", page::number(1e3 * rms));
    section.draw("fig6b", drift, words);
  }
  section.claim("fig6.roll", words, PaperRange::at_least(0.0), found(roundness));
  return section;
}

}  // namespace ballast
