#include "experiments/paper/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

std::vector<MotionRun> read_motion(PaperData& data) {
  std::vector<MotionRun> runs;
  for (RunData& record : data.records("motion")) {
    RunSummary summary = summarise(record.steps, record.facts);
    runs.push_back({std::move(record), std::move(summary)});
  }
  return runs;
}

int for_each_state(const MotionRun& run, const std::function<void(const StoredState&)>& see) {
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

}  // namespace ballast
