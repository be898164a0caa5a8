// Fig. 6: velocities of the grains in the passive state, in a section along the middle; mean
// vorticity of the xz plane.

#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/stored_states.hpp"

namespace ballast {
namespace {

constexpr double half_section_of_grains =
    0.05;  // grains whose centres are this near the middle plane are drawn [m]: two layers

/// Arrows as lines: shaft and two barbs, NaN between them. Lengths in the plot's units (axes of
/// equal scale).
void add_arrow(Curve& curve, double x, double z, double dx, double dz) {
  const auto add = [&](double a, double b) {
    curve.x.push_back(a);
    curve.y.push_back(b);
  };
  const double length = std::hypot(dx, dz);
  if (!(length > 0.0)) return;
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
  double speed = 0.0;  ///< rms of the grains drawn [m/s]
};

Field draw(const StoredState& state) {
  const MotionState& motion = state.at.state;
  const auto wall = [&](BoxWall which) { return wall_place(state.system, motion, which); };
  const double middle = 0.5 * (wall(wall_y_min).y() + wall(wall_y_max).y());
  std::vector<size_t> section;
  double squares = 0.0;
  for (size_t k = 0; k < static_cast<size_t>(state.system.grain_count); ++k)
    if (std::abs(motion.pose[k].position.y() - middle) < half_section_of_grains) {
      section.push_back(k);
      squares += motion.velocity[k].squaredNorm();
    }
  Field field;
  field.speed = std::sqrt(squares / std::max<double>(1.0, static_cast<double>(section.size())));
  Curve arrows, box;
  const double scale =
      field.speed > 0.0 ? 0.025 / field.speed : 0.0;  // an rms arrow is 2.5 cm long
  for (const size_t k : section)
    add_arrow(arrows, motion.pose[k].position.x(), motion.pose[k].position.z(),
              scale * motion.velocity[k].x(), scale * motion.velocity[k].z());
  arrows.width = 1.2;
  const double left = wall(wall_x_min).x(), right = wall(wall_x_max).x(), top = wall(wall_lid).z();
  box.x = {left, right, right, left, left};
  box.y = {0.0, 0.0, top, top, 0.0};
  box.ink = Ink::black;
  Panel panel;
  panel.x_label = "{/:Italic x}  (m): the driven wall is on the right";
  panel.y_label = "{/:Italic z}  (m)";
  panel.curves = {box, arrows};
  const double margin = 0.03;
  panel.x_min = left - margin, panel.x_max = right + margin;
  panel.y_min = -margin, panel.y_max = top + margin;
  field.figure.name = "fig06";
  field.figure.title = "Velocities of the grains while the wall moves in";
  field.figure.width = 800;
  field.figure.height = static_cast<int>(
      78.0 + 680.0 * (top + 2.0 * margin) /
                 (right - left + 2.0 * margin));  // equal scales: margins of plot_script
  field.figure.panels = {panel};
  return field;
}

}  // namespace

PaperSection fig6_section(PaperData& data) {
  PaperSection section;
  section.text = {page::words("fig6.intro")};
  const std::vector<MotionRun> runs = read_motion(data, section);
  std::vector<double> passive, active, relative;
  double fastest = 0.0;
  Field field;
  for (const MotionRun& run : runs) {
    std::vector<double> in, out;
    for_each_state(run, [&](const StoredState& state) {
      const double vorticity = vorticity_xz(velocity_gradient(state.system, state.at.state));
      if (state.phase == WallPhase::active) out.push_back(vorticity);
      if (state.phase != WallPhase::passive) return;
      in.push_back(vorticity);
      if (&run == &runs.front() && -state.wall_speed > fastest) {
        fastest = -state.wall_speed;
        field = draw(state);
      }
    });
    passive.push_back(statistics(in).mean);
    active.push_back(statistics(out).mean);
    relative.push_back(passive.back() / (run.summary.speed_in.mean / run.data.scene->box.length));
  }
  const SampleMean seen = sample_mean(passive), back = sample_mean(active),
                   share = sample_mean(relative);
  if (seen.samples == 0 || field.figure.panels.empty()) {
    section.notes.push_back("PARTIAL: no stored state in the passive phase.");
    return section;
  }
  PaperFigure figure;
  figure.plot = field.figure;
  figure.paper = page::words("fig6.paper");
  figure.found = page::words("fig6.found", {{"wall", page::number(1e3 * fastest)},
                                            {"arrow", page::number(1e3 * field.speed)},
                                            {"passive", page::with_error(seen.mean, seen.error)},
                                            {"share", page::number(share.mean, 2)},
                                            {"active", page::with_error(back.mean, back.error)}});
  section.figures = {figure};
  const bool is_sure = seen.samples > 1 && std::abs(seen.mean) > 2.0 * seen.error;
  const std::string sense = seen.mean > 0.0 ? "clockwise" : "counter-clockwise";
  // the text doesn't say on which side the paper's wall is: seen from the other side every roll
  // turns round
  section.rows = {
      {"Fig. 6", "a convection roll in the passive state, clockwise (its view is not said)",
       "vorticity " + page::with_error(seen.mean, seen.error) + " 1/s: " + sense +
           " with the driven wall on the right" + (is_sure ? "" : "; not beyond its error"),
       is_sure            ? Agreement::agrees
       : seen.samples > 1 ? Agreement::differs
                          : Agreement::reported}};
  return section;
}

}  // namespace ballast
