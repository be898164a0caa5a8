// Fig. 7: normal forces in a section, passive and active; principal directions of the stress.

#include <array>
#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/stored_states.hpp"

namespace ballast {
namespace {

constexpr double half_section_of_contacts =
    0.08;                   // contacts this near the middle plane are drawn [m]
constexpr int classes = 8;  // of thickness

/// Segments between the centres of touching grains (to the contact at walls), thicker for larger
/// normal forces.
Panel chains(const StoredState& state, const char* title) {
  const MotionState& motion = state.at.state;
  const auto wall = [&](BoxWall which) { return wall_place(state.system, motion, which); };
  const double middle = 0.5 * (wall(wall_y_min).y() + wall(wall_y_max).y());
  const std::vector<PairForce> pairs =
      pair_forces(state.at.memory.contacts, state.at.memory.impulses, state.step);
  double mean = 0.0;
  for (const PairForce& pair : pairs)
    mean += pair.normal_force() / static_cast<double>(pairs.size());
  std::array<Curve, classes> curves;
  const auto centre = [&](int body, const PairForce& pair) -> Vec3 {
    return body < state.system.grain_count ? motion.pose[static_cast<size_t>(body)].position
                                           : pair.position;
  };
  for (const PairForce& pair : pairs) {
    if (std::abs(pair.position.y() - middle) > half_section_of_contacts) continue;
    const Vec3 a = centre(pair.body_a, pair), b = centre(pair.body_b, pair);
    const double relative =
        pair.normal_force() / mean;  // up to 4 means the thickness grows with the force
    const auto k = static_cast<size_t>(std::min(classes - 1.0, std::floor(2.0 * relative)));
    for (const Vec3& end : {a, b}) {
      curves[k].x.push_back(end.x());
      curves[k].y.push_back(end.z());
    }
    curves[k].x.push_back(not_known);
    curves[k].y.push_back(not_known);
  }
  Panel panel;
  panel.x_label = std::string("{/:Italic x}  (m)   ") + title;
  panel.y_label = "{/:Italic z}  (m)";
  for (int k = 0; k < classes; ++k) {
    if (curves[static_cast<size_t>(k)].x.empty()) continue;
    curves[static_cast<size_t>(k)].ink = Ink::black;
    curves[static_cast<size_t>(k)].width = 0.3 + 0.75 * k;
    panel.curves.push_back(curves[static_cast<size_t>(k)]);
  }
  panel.x_min = wall(wall_x_min).x() - 0.02, panel.x_max = wall(wall_x_max).x() + 0.02;
  panel.y_min = -0.02, panel.y_max = wall(wall_lid).z() + 0.02;
  return panel;
}

/// Mean stress of one run's states in each phase.
struct PhaseStress {
  std::array<Mat3, 4> sum = {Mat3::Zero(), Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
  std::array<int, 4> count{};

  void add(const StoredState& state) {
    const std::vector<PairForce> pairs =
        pair_forces(state.at.memory.contacts, state.at.memory.impulses, state.step);
    const size_t phase = static_cast<size_t>(state.phase);
    sum[phase] += stress_tensor(state.system, state.at.state, pairs,
                                box_volume(state.system, state.at.state));
    ++count[phase];
  }
  double inclination(WallPhase phase) const {
    const size_t k = static_cast<size_t>(phase);
    return count[k] ? major_inclination(sum[k]) : not_known;
  }
  double ratio(WallPhase phase) const {  // sigma_xx / sigma_zz
    const size_t k = static_cast<size_t>(phase);
    return count[k] ? sum[k](0, 0) / sum[k](2, 2) : not_known;
  }
};

constexpr std::pair<WallPhase, const char*> stress_phases[] = {
    {WallPhase::passive, "passive"}, {WallPhase::jammed, "jammed"}, {WallPhase::active, "active"}};

/// Within 20 degrees of the direction that the paper names: agrees; within 45: partly.
Agreement judge_direction(const SampleMean& angle, bool is_horizontal) {
  if (angle.samples == 0) return Agreement::reported;
  const double off = is_horizontal ? angle.mean : 90.0 - angle.mean;
  return off < 20.0 ? Agreement::agrees : off < 45.0 ? Agreement::partly : Agreement::differs;
}

/// Force chains in a section, passive above active. `aspect`: height over width of a panel.
PaperFigure chains_figure(const std::array<Panel, 2>& panels, double aspect,
                          const std::array<SampleMean, 3>& mean) {
  PaperFigure figure;
  figure.plot.name = "fig07";
  figure.plot.title = "Normal forces in a section while the wall moves in and out";
  figure.plot.width = 760;
  figure.plot.height = static_cast<int>(2.0 * (78.0 + 640.0 * aspect));
  figure.plot.panels = {panels[0], panels[1]};
  figure.paper = page::words("fig7.paper");
  figure.found =
      page::words("fig7.found", {{"passive", page::with_error(mean[0].mean, mean[0].error)},
                                 {"active", page::with_error(mean[2].mean, mean[2].error)}});
  return figure;
}

}  // namespace

PaperSection fig7_section(PaperData& data) {
  PaperSection section;
  section.text = {page::words("fig7.intro")};
  const std::vector<MotionRun> runs = read_motion(data, section);
  std::array<std::vector<double>, 3> angles, ratios;
  std::array<Panel, 2> panels;  // passive, active
  std::array<double, 2> fastest{};
  double aspect = 1.0;
  int states = 0;
  for (const MotionRun& run : runs) {
    PhaseStress stress;
    states += for_each_state(run, [&](const StoredState& state) {
      stress.add(state);
      if (&run != &runs.front() ||
          (state.phase != WallPhase::passive && state.phase != WallPhase::active))
        return;
      const size_t k = state.phase == WallPhase::active;
      if (std::abs(state.wall_speed) <= fastest[k]) return;
      fastest[k] = std::abs(state.wall_speed);
      panels[k] = chains(state, k ? "active: the wall moves out" : "passive: the wall moves in");
      aspect = (*panels[k].y_max - *panels[k].y_min) / (*panels[k].x_max - *panels[k].x_min);
    });
    for (size_t k = 0; k < 3; ++k) {
      angles[k].push_back(stress.inclination(stress_phases[k].first));
      ratios[k].push_back(stress.ratio(stress_phases[k].first));
    }
  }
  page::Table table{"Principal direction by phase, means over samples ± standard error",
                    {"phase", "angle to the horizontal (°)", "σ_xx/σ_zz"},
                    {}};
  std::array<SampleMean, 3> mean;
  for (size_t k = 0; k < 3; ++k) {
    mean[k] = sample_mean(angles[k]);
    const SampleMean ratio = sample_mean(ratios[k]);
    table.rows.push_back({stress_phases[k].second, page::with_error(mean[k].mean, mean[k].error),
                          page::with_error(ratio.mean, ratio.error)});
  }
  if (states == 0) {
    section.notes.push_back("PARTIAL: no stored states.");
    return section;
  }
  section.tables = {table};
  if (!panels[0].curves.empty() && !panels[1].curves.empty()) {
    section.figures = {chains_figure(panels, aspect, mean)};
  }
  section.rows = {{"Fig. 7a", "major stress horizontal in the passive state",
                   page::with_error(mean[0].mean, mean[0].error) + "° to the horizontal",
                   judge_direction(mean[0], true)},
                  {"Fig. 7b", "major stress vertical in the active state",
                   page::with_error(mean[2].mean, mean[2].error) + "° to the horizontal",
                   judge_direction(mean[2], false)}};
  return section;
}

}  // namespace ballast
