// Fig. 7: normal forces in a section, passive and active; principal directions of the stress.

#include <array>
#include <cmath>

#include "experiments/paper/motion.hpp"

namespace ballast {
namespace {

/// Contacts this near the middle plane are drawn [m].
constexpr double half_section_of_contacts = 0.08;
constexpr size_t classes = 8;    // of thickness
constexpr double margin = 0.02;  // around the box [m]

/// Segments between the centres of touching grains (to the contact at walls), thicker for larger
/// normal forces.
Panel chains(const StoredState& state, const std::string& title) {
  const std::vector<PairForce> pairs = state.pairs();
  // the unit of thickness is the state's mean normal force
  double mean = 0.0;
  for (const PairForce& pair : pairs)
    mean += pair.normal_force() / static_cast<double>(pairs.size());
  const auto centre = [&](int body, const PairForce& pair) -> Vec3 {
    return body < state.system.grain_count ? state.at.state.pose[static_cast<size_t>(body)].position
                                           : pair.position;
  };
  // one curve for each thickness: gnuplot draws a curve in one width
  std::array<Curve, classes> curves;
  for (const PairForce& pair : pairs) {
    if (std::abs(pair.position.y() - state.middle()) > half_section_of_contacts) continue;
    const double relative = pair.normal_force() / mean;  // in 8 classes of half a mean
    Curve& curve = curves[static_cast<size_t>(std::min(classes - 1.0, std::floor(2.0 * relative)))];
    for (const Vec3& end : {centre(pair.body_a, pair), centre(pair.body_b, pair)}) {
      curve.x.push_back(end.x());
      curve.y.push_back(end.z());
    }
    curve.x.push_back(not_known);
    curve.y.push_back(not_known);
  }
  Panel panel{.x_label = "{/:Italic x}  (m)   " + title,
              .y_label = "{/:Italic z}  (m)",
              .y_min = -margin,
              .y_max = state.wall(wall_lid).z() + margin,
              .x_min = state.wall(wall_x_min).x() - margin,
              .x_max = state.wall(wall_x_max).x() + margin};
  for (size_t k = 0; k < classes; ++k) {
    curves[k].ink = Ink::black;
    curves[k].width = 0.3 + 0.75 * static_cast<double>(k);
    if (!curves[k].x.empty()) panel.curves.push_back(curves[k]);
  }
  return panel;
}

/// The phases in the order of the table, with the mean stress of a run's states in each.
constexpr std::pair<WallPhase, const char*> phases[] = {
    {WallPhase::passive, "passive"}, {WallPhase::jammed, "jammed"}, {WallPhase::active, "active"}};
constexpr size_t passive = 0, jammed = 1, active = 2;

struct PhaseStress {
  Mat3 sum = Mat3::Zero();
  bool is_known = false;

  void add(const StoredState& state) {
    sum += stress_tensor(state.system, state.at.state, state.pairs(),
                         box_volume(state.system, state.at.state));
    is_known = true;
  }
  double inclination() const { return is_known ? major_inclination(sum) : not_known; }
  double ratio() const { return is_known ? sum(0, 0) / sum(2, 2) : not_known; }
};

/// Within 20 degrees of the direction that the paper names: agrees; within 45: partly.
Agreement judge_direction(const SampleMean& angle, double expected) {
  const double off = std::abs(angle.mean - expected);
  return angle.samples == 0 ? Agreement::reported : graded(off < 20.0, off < 45.0);
}

}  // namespace

PaperSection fig7_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig7.intro")}};
  const std::vector<MotionRun> runs = read_motion(data, section);
  std::array<std::vector<double>, 3> angles, ratios;  // by phase, one of each run
  std::array<Panel, 3> panels;                        // of the first run's fastest states
  std::array<double, 3> fastest{};
  double aspect = 1.0;  // height over width of a panel
  int states = 0;
  for (const MotionRun& run : runs) {
    std::array<PhaseStress, 3> stress;
    states += for_each_state(run, [&](const StoredState& state) {
      for (size_t k = 0; k < 3; ++k) {
        if (state.phase != phases[k].first) continue;
        stress[k].add(state);
        // of the first sample the states with the fastest wall are drawn
        const double speed = std::abs(state.wall_speed);
        if (k == jammed || &run != &runs.front() || speed <= fastest[k]) continue;
        fastest[k] = speed;
        panels[k] = chains(
            state, k == active ? "active: the wall moves out" : "passive: the wall moves in");
        aspect = (*panels[k].y_max - *panels[k].y_min) / (*panels[k].x_max - *panels[k].x_min);
      }
    });
    for (size_t k = 0; k < 3; ++k) {
      angles[k].push_back(stress[k].inclination());
      ratios[k].push_back(stress[k].ratio());
    }
  }
  if (states == 0) {
    section.notes.push_back("PARTIAL: no stored states.");
    return section;
  }
  // angles and ratios are means over samples: one number of each run
  page::Table table = page::words_table("fig7.table");
  std::array<SampleMean, 3> mean;
  for (size_t k = 0; k < 3; ++k) {
    mean[k] = sample_mean(angles[k]);
    table.rows.push_back({phases[k].second, words_of(mean[k]), words_of(sample_mean(ratios[k]))});
  }
  section.tables = {table};
  const page::Values words{{"passive", words_of(mean[passive])},
                           {"active", words_of(mean[active])}};
  if (!panels[passive].curves.empty() && !panels[active].curves.empty())
    section.draw("fig7",
                 {.width = 760,
                  .height = static_cast<int>(2.0 * (78.0 + 640.0 * aspect)),
                  .panels = {panels[passive], panels[active]}},
                 words);
  section.claim("fig7.passive", words, judge_direction(mean[passive], 0.0));
  section.claim("fig7.active", words, judge_direction(mean[active], 90.0));
  return section;
}

}  // namespace ballast
