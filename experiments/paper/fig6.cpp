// Fig. 6: velocities of the grains in the passive state, in a section along the middle; mean
// vorticity of the xz plane.

#include <cmath>

#include "experiments/paper/motion.hpp"

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
  // the box around them, on axes of equal scale
  const double left = state.wall(wall_x_min).x(), right = state.wall(wall_x_max).x(),
               top = state.wall(wall_lid).z(), margin = 0.03;
  const Curve box{
      .x = {left, right, right, left, left}, .y = {0.0, 0.0, top, top, 0.0}, .ink = Ink::black};
  const double aspect = (top + 2.0 * margin) / (right - left + 2.0 * margin);
  return {{.width = 800,
           .height = static_cast<int>(78.0 + 680.0 * aspect),  // margins of plot_layout
           .panels = {{.x_label = "{/:Italic x}  (m): the driven wall is on the right",
                       .y_label = "{/:Italic z}  (m)",
                       .y_min = -margin,
                       .y_max = top + margin,
                       .x_min = left - margin,
                       .x_max = right + margin,
                       .curves = {box, arrows}}}},
          -state.wall_speed,
          speed};
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
  // the text doesn't say on which side the paper's wall is: seen from the other side every roll
  // turns round
  const bool is_sure = seen.samples > 1 && std::abs(seen.mean) > 2.0 * seen.error;
  const page::Values words{{"wall", page::number(1e3 * field.wall)},
                           {"arrow", page::number(1e3 * field.speed)},
                           {"passive", words_of(seen)},
                           {"active", words_of(sample_mean(active))},
                           {"share", page::number(sample_mean(relative).mean, 2)},
                           {"sense", seen.mean > 0.0 ? "clockwise" : "counter-clockwise"},
                           {"doubt", is_sure ? "" : "; not beyond its error"}};
  section.draw("fig6", field.figure, words);
  // shear and rotation together, of one instant, and the paper does not say from which side it
  // looks: nothing is decided
  section.claim("fig6.roll", words, PaperRange::at_least(0.0), {.value = seen.mean});
  return section;
}

}  // namespace ballast
