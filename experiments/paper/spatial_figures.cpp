// Figs. 6 and 7: fields in a section along the middle of the box. Fig. 6 shows the velocities of
// the grains while the wall moves in, and the net motion over whole periods, in which a roll would
// be seen. Fig. 7 shows the normal forces, passive and active, and the principal directions of
// the stress.

#include "experiments/paper/spatial_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "experiments/record/record_file.hpp"
#include "experiments/run/run_folder.hpp"

namespace ballast {

double major_inclination(const Mat3& tensor) {
  // Mohr's circle: the direction of the larger principal value within the plane
  const double angle = 0.5 * std::atan2(tensor(0, 2) + tensor(2, 0),
                                        tensor(0, 0) - tensor(2, 2));  // in (-90, 90] degrees
  return std::abs(angle) * 180.0 / std::numbers::pi;
}

std::vector<PairForce> StoredState::pairs() const {
  const std::vector<ContactPoint>& contacts = at.memory.contacts;
  std::vector<PairForce> pairs;
  for (size_t k = 0; k < contacts.size();) {
    const ContactPoint& first = contacts[k];
    // the points of one pair follow each other: contacts are sorted by (a, b)
    PairForce pair{first.body_a, first.body_b, first.normal, Vec3::Zero(), Vec3::Zero()};
    double weight = 0.0;
    for (; k < contacts.size() && contacts[k].body_a == first.body_a &&
           contacts[k].body_b == first.body_b;
         ++k) {
      const Vec3 force = at.memory.impulses[k] / step;
      const double normal = std::max(0.0, force.dot(contacts[k].normal));
      pair.force += force;
      pair.position += normal * contacts[k].position;
      weight += normal;
    }
    if (!(weight > 0.0)) continue;  // a pair without compression is left out
    pair.position /= weight;
    pairs.push_back(pair);
  }
  return pairs;
}

Mat3 StoredState::stress() const {
  Mat3 sum = Mat3::Zero();
  // The Love-Weber formula: force times branch vector, from the centre of a to that of b.
  for (const PairForce& pair : pairs())
    sum += pair.force * (centre(pair.body_b, pair) - centre(pair.body_a, pair)).transpose();
  const double volume = (wall(wall_x_max).x() - wall(wall_x_min).x()) *
                        (wall(wall_y_max).y() - wall(wall_y_min).y()) *
                        (wall(wall_lid).z() - wall(wall_floor).z());
  return 0.5 * (sum + sum.transpose()) / volume;
}

Vec3 StoredState::centre(int body, const PairForce& pair) const {
  return body < system.grain_count ? at.state.pose[body].position : pair.position;
}

Vec3 StoredState::wall(BoxWall which) const {
  return at.state.pose[system.grain_count + which].position;
}

namespace {

/// Calls `see` for every stored state after the transient, in the order of time. States whose wall
/// moves, but slower than 20 % of its largest speed, are left out: they are neither active nor
/// passive yet. Returns the number of states seen. Throws Error.
int for_each_state(const MeasuredRun& run, const std::function<void(const StoredState&)>& see) {
  const WallCycles& wall = run.summary.wall;
  const std::vector<std::filesystem::path> files = RunFolder(run.data.folder).state_files();
  if (files.empty() || wall.periods.empty()) return 0;
  MotionState unused;
  const MechanicalSystem system = system_of_run(run.data.folder, unused);
  int count = 0;
  for (const auto& file : files) {
    StoredState state{system, read_checkpoint(file), run.summary.facts.step};
    // row k of the record is step k + 1
    const size_t row = static_cast<size_t>(state.at.state.step - 1);
    if (row < wall.periods.front().first || row >= wall.periods.back().last) continue;
    state.phase = wall.phase[row];
    state.wall_speed = wall.velocity[row];
    const bool is_out = state.phase == WallPhase::active;
    const double largest = (is_out ? run.summary.speed_out : run.summary.speed_in).mean;
    if ((is_out || state.phase == WallPhase::passive) && std::abs(state.wall_speed) < 0.2 * largest)
      continue;
    see(state);
    ++count;
  }
  return count;
}

/// Grains whose centres are this near the middle plane are drawn [m]: two layers.
constexpr double half_section_of_grains = 0.05;
constexpr double rms_arrow = 0.025;  // length of the arrow of the rms velocity [m]

/// Adds an arrow as lines: shaft and two barbs, NaN between them. Lengths are in the plot's units
/// (axes of equal scale).
void add_arrow(Curve& curve, double x, double z, double dx, double dz) {
  const double length = std::hypot(dx, dz);
  if (!(length > 0.0)) return;
  // barbs at 2.6 rad (150 degrees) to the shaft
  const double barb = 0.3 * length, c = std::cos(2.6), s = std::sin(2.6);
  curve.add(x, z);
  curve.add(x + dx, z + dz);
  for (const double side : {-s, s}) {
    curve.add(not_known, not_known);
    curve.add(x + dx, z + dz);
    curve.add(x + dx + barb * (c * dx - side * dz) / length,
              z + dz + barb * (side * dx + c * dz) / length);
  }
  curve.add(not_known, not_known);
}

/// The figure of arrows in the box around them, on axes of equal scale. An arrow of length `rms` is
/// drawn rms_arrow long.
Figure arrows_in_box(const std::vector<Displacement>& moves, double rms, const XzRectangle& box) {
  Curve arrows{.width = 1.2};
  const double scale = rms > 0.0 ? rms_arrow / rms : 0.0;
  for (const Displacement& one : moves)
    add_arrow(arrows, one.place.x(), one.place.z(), scale * one.move.x(), scale * one.move.z());
  constexpr double margin = 0.03;  // [m]
  const Curve walls{.x = {box.x_lo, box.x_hi, box.x_hi, box.x_lo, box.x_lo},
                    .y = {0.0, 0.0, box.z_hi, box.z_hi, 0.0},
                    .ink = Ink::black};
  const double aspect = (box.z_hi + 2.0 * margin) / (box.x_hi - box.x_lo + 2.0 * margin);
  return {.width = 800,
          .height = static_cast<int>(78.0 + 680.0 * aspect),  // margins of the plot
          .panels = {{.x_label = page::marked("*x*  (m): the driven wall is on the right"),
                      .y_label = page::marked("*z*  (m)"),
                      .y_min = -margin,
                      .y_max = box.z_hi + margin,
                      .x_min = box.x_lo - margin,
                      .x_max = box.x_hi + margin,
                      .curves = {walls, std::move(arrows)}}}};
}

/// The figure of the grains' velocities in the section. Sets `rms` to their rms [m/s].
Figure velocity_field(const StoredState& state, double& rms) {
  const MotionState& motion = state.at.state;
  std::vector<Displacement> section;
  double squares = 0.0;
  for (size_t k = 0; k < static_cast<size_t>(state.system.grain_count); ++k)
    if (std::abs(motion.pose[k].position.y() - state.middle()) < half_section_of_grains) {
      section.push_back({motion.pose[k].position, motion.velocity[k]});
      squares += motion.velocity[k].squaredNorm();
    }
  rms = std::sqrt(squares / std::max<double>(1.0, static_cast<double>(section.size())));
  return arrows_in_box(section, rms, state.box());
}

/// The mean displacement of a period on a grid, where a roll would close. Sets its `rms` [m].
Figure period_field(const MeasuredRun& run, double& rms) {
  const RunFacts& facts = run.summary.facts;
  const XzRectangle box{0.0, facts.length, 0.0, facts.height};
  const auto frames = read_record_poses(run.data.folder / "record.h5");
  const std::vector<Displacement> cells =
      cell_means(period_displacements(frames, run.summary), box, 9, 8);
  double squares = 0.0;
  for (const Displacement& cell : cells)
    squares += cell.move.x() * cell.move.x() + cell.move.z() * cell.move.z();
  rms = std::sqrt(squares / static_cast<double>(cells.size()));
  return arrows_in_box(cells, rms, box);
}

/// Contacts this near the middle plane are drawn [m].
constexpr double half_section_of_contacts = 0.08;
constexpr size_t classes = 8;          // of thickness
constexpr double chain_margin = 0.02;  // around the box [m]

/// The normal forces of one state near the middle plane: segments between the centres of touching
/// grains (to the contact at walls).
struct Chains {
  struct Segment {
    Vec3 from, to;
    double force;  ///< normal [N]
  };
  std::vector<Segment> segments = {};
  double mean = 0.0;  ///< mean normal force of all contacts of the state [N]
  XzRectangle box = {};
};

Chains chains_of(const StoredState& state) {
  Chains chains{.box = state.box()};
  const std::vector<PairForce> pairs = state.pairs();
  for (const PairForce& pair : pairs) {
    chains.mean += pair.normal_force() / static_cast<double>(pairs.size());
    if (std::abs(pair.position.y() - state.middle()) < half_section_of_contacts)
      chains.segments.push_back(
          {state.centre(pair.body_a, pair), state.centre(pair.body_b, pair), pair.normal_force()});
  }
  return chains;
}

/// The panel of chains, with eight classes of thickness of `width` newtons each, the same in all
/// panels. The key, if `has_key`, names three of them.
Panel panel_of(const Chains& chains, double width, const std::string& title, bool has_key) {
  // one curve for each thickness: gnuplot draws a curve in one width
  std::array<Curve, classes> curves;
  for (const Chains::Segment& segment : chains.segments) {
    Curve& curve =
        curves[static_cast<size_t>(std::min(classes - 1.0, std::floor(segment.force / width)))];
    for (const Vec3& end : {segment.from, segment.to}) curve.add(end.x(), end.z());
    curve.add(not_known, not_known);
  }
  const Curve walls{.x = {chains.box.x_hi, chains.box.x_lo, chains.box.x_lo, chains.box.x_hi},
                    .y = {0.0, 0.0, chains.box.z_hi, chains.box.z_hi},
                    .ink = Ink::grey},
      driven{.x = {chains.box.x_hi, chains.box.x_hi},
             .y = {0.0, chains.box.z_hi},
             .ink = Ink::vermilion,
             .width = 3.0};
  Panel panel{.x_label = page::marked("*x*  (m)   ") + title,
              .y_label = page::marked("*z*  (m)"),
              .y_min = -chain_margin,
              .y_max = chains.box.z_hi + chain_margin,
              .x_min = chains.box.x_lo - chain_margin,
              .x_max = chains.box.x_hi + chain_margin,
              .curves = {walls, driven}};
  const auto newtons = [&](size_t n) { return page::number(width * static_cast<double>(n), 2); };
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

/// The phases in the order of the table.
constexpr std::pair<WallPhase, const char*> phases[] = {
    {WallPhase::passive, "passive"}, {WallPhase::jammed, "jammed"}, {WallPhase::active, "active"}};
constexpr size_t passive = 0, jammed = 1, active = 2;

/// The largest deviation from horizontal or vertical that is "nearly" so [degrees].
constexpr double nearly = 20.0;

}  // namespace

void fill_velocities(PaperData& data, PaperSection& section) {
  const std::vector<MeasuredRun> runs = data.records("motion");
  // the state with the fastest inward wall of the first sample is drawn
  Figure field;
  double wall = 0.0, speed = 0.0;  // wall speed, inward; rms of the grains [m/s]
  if (!runs.empty())
    for_each_state(runs.front(), [&](const StoredState& state) {
      if (state.phase != WallPhase::passive || !(-state.wall_speed > wall)) return;
      wall = -state.wall_speed;
      field = velocity_field(state, speed);
    });
  if (field.panels.empty()) {
    section.notes.push_back("PARTIAL: no stored state in the passive phase.");
    return;
  }
  // Seen from the other side a roll has the opposite sense, and the text does not say from which
  // side the paper looks: a roll of either sense counts.
  std::vector<double> round;
  double closed = 0.0;
  for (const RunRow* row : data.rows("motion")) {
    round.push_back(
        Roll{{(*row)["roll_top"], (*row)["roll_right"], (*row)["roll_bottom"], (*row)["roll_left"]},
             (*row)["circulation"]}
            .side_ratio());
    closed += round.back() > 0.0;
  }
  const SampleMean side_ratio = sample_mean(round);
  page::Values words{{"wall", page::number(1e3 * wall)},
                     {"arrow", page::number(1e3 * speed)},
                     {"round", words_of(side_ratio)},
                     {"closed", page::number(closed)},
                     {"samples", std::to_string(round.size())}};
  section.draw("fig6", field, words);
  if (side_ratio.samples > 0) {
    double rms = 0.0;
    const Figure drift = period_field(runs.front(), rms);
    words.emplace("drift", page::number(1e3 * rms));
    section.draw("fig6b", drift, words);
  }
  section.claim("fig6.roll", words, PaperRange::at_least(0.0), found(side_ratio));
}

void fill_chains(PaperData& data, PaperSection& section) {
  const std::vector<MeasuredRun> runs = data.records("motion");
  std::array<std::vector<double>, 3> angles, ratios;  // by phase, one of each run
  std::array<Chains, 3> drawn;                        // of the first run's fastest states
  std::array<double, 3> fastest{};
  int states = 0;
  for (const MeasuredRun& run : runs) {
    std::array<Mat3, 3> stress;  // sum over the run's states
    stress.fill(Mat3::Zero());
    states += for_each_state(run, [&](const StoredState& state) {
      for (size_t k = 0; k < 3; ++k) {
        if (state.phase != phases[k].first) continue;
        stress[k] += state.stress();
        // the states with the fastest wall of the first sample are drawn
        const double speed = std::abs(state.wall_speed);
        if (k == jammed || &run != &runs.front() || speed <= fastest[k]) continue;
        fastest[k] = speed;
        drawn[k] = chains_of(state);
      }
    });
    for (size_t k = 0; k < 3; ++k) {
      const bool is_known = !stress[k].isZero(0.0);
      angles[k].push_back(is_known ? major_inclination(stress[k]) : not_known);
      ratios[k].push_back(is_known ? stress[k](0, 0) / stress[k](2, 2) : not_known);
    }
  }
  if (states == 0) {
    section.notes.push_back("PARTIAL: no stored states.");
    return;
  }
  // angles and ratios are means over samples: one number of each run
  page::Table table = page::words_table("fig7.table");
  std::array<SampleMean, 3> mean;
  for (size_t k = 0; k < 3; ++k) {
    mean[k] = sample_mean(angles[k]);
    table.rows.push_back({phases[k].second, words_of(mean[k]), words_of(sample_mean(ratios[k]))});
  }
  section.add(table);
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
}

}  // namespace ballast
