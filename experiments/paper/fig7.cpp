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

/// The normal forces of one state near the middle plane: segments between the centres of touching
/// grains (to the contact at walls).
struct Chains {
  struct Segment {
    Vec3 from, to;
    double force;  ///< normal [N]
  };
  std::vector<Segment> segments = {};
  double mean = 0.0;                          ///< normal force of all contacts of the state [N]
  double left = 0.0, right = 0.0, top = 0.0;  ///< of the box [m]
};

Chains chains_of(const StoredState& state) {
  Chains chains;
  chains.left = state.wall(wall_x_min).x();
  chains.right = state.wall(wall_x_max).x();
  chains.top = state.wall(wall_lid).z();
  const std::vector<PairForce> pairs = state.pairs();
  const auto centre = [&](int body, const PairForce& pair) -> Vec3 {
    return body < state.system.grain_count ? state.at.state.pose[static_cast<size_t>(body)].position
                                           : pair.position;
  };
  for (const PairForce& pair : pairs) {
    chains.mean += pair.normal_force() / static_cast<double>(pairs.size());
    if (std::abs(pair.position.y() - state.middle()) < half_section_of_contacts)
      chains.segments.push_back(
          {centre(pair.body_a, pair), centre(pair.body_b, pair), pair.normal_force()});
  }
  return chains;
}

/// Thickness in eight classes of `width` newtons, the same in all panels. Three of them stand in
/// the key.
Panel panel_of(const Chains& chains, double width, const std::string& title, bool has_key) {
  // one curve for each thickness: gnuplot draws a curve in one width
  std::array<Curve, classes> curves;
  for (const Chains::Segment& segment : chains.segments) {
    Curve& curve =
        curves[static_cast<size_t>(std::min(classes - 1.0, std::floor(segment.force / width)))];
    for (const Vec3& end : {segment.from, segment.to}) {
      curve.x.push_back(end.x());
      curve.y.push_back(end.z());
    }
    curve.x.push_back(not_known);
    curve.y.push_back(not_known);
  }
  const Curve walls{.x = {chains.right, chains.left, chains.left, chains.right},
                    .y = {0.0, 0.0, chains.top, chains.top},
                    .ink = Ink::grey},
      driven{.x = {chains.right, chains.right},
             .y = {0.0, chains.top},
             .ink = Ink::vermilion,
             .width = 3.0};
  Panel panel{.x_label = "{/:Italic x}  (m)   " + title,
              .y_label = "{/:Italic z}  (m)",
              .y_min = -margin,
              .y_max = chains.top + margin,
              .x_min = chains.left - margin,
              .x_max = chains.right + margin,
              .curves = {walls, driven}};
  const auto newtons = [&](size_t n) {
    return plot_label(page::number(width * static_cast<double>(n), 2));
  };
  for (size_t k = 0; k < classes; ++k) {
    if (curves[k].x.empty()) continue;
    curves[k].ink = Ink::black;
    curves[k].width = 0.3 + 0.75 * static_cast<double>(k);
    if (has_key && (k == 1 || k == 4))
      curves[k].title = newtons(k) + " to " + newtons(k + 1) + " N";
    if (has_key && k == classes - 1) curves[k].title = "above " + newtons(k) + " N";
    panel.curves.push_back(curves[k]);
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

/// "Nearly" horizontal or vertical [degrees].
constexpr double nearly = 20.0;

}  // namespace

PaperSection fig7_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig7.intro")}};
  const std::vector<MotionRun> runs = read_motion(data, section);
  std::array<std::vector<double>, 3> angles, ratios;  // by phase, one of each run
  std::array<Chains, 3> drawn;                        // of the first run's fastest states
  std::array<double, 3> fastest{};
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
        drawn[k] = chains_of(state);
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
                           {"active", words_of(mean[active])},
                           {"mean_in", page::number(drawn[passive].mean)},
                           {"mean_out", page::number(drawn[active].mean)}};
  if (!drawn[passive].segments.empty() && !drawn[active].segments.empty()) {
    // one scale for both: eight classes, to four times the larger mean force
    const double width = 0.5 * std::max(drawn[passive].mean, drawn[active].mean);
    const Panel in = panel_of(drawn[passive], width, "passive: the wall moves in", true),
                out = panel_of(drawn[active], width, "active: the wall moves out", false);
    const double aspect = (*in.y_max - *in.y_min) / (*in.x_max - *in.x_min);
    section.draw("fig7",
                 {.width = 760,
                  .height = static_cast<int>(2.0 * (100.0 + 640.0 * aspect)),
                  .panels = {in, out}},
                 words);
  }
  section.claim("fig7.passive", words, PaperRange::at_most(nearly), found(mean[passive]));
  section.claim("fig7.active", words, PaperRange::at_least(90.0 - nearly), found(mean[active]));
  return section;
}

}  // namespace ballast
