#include "experiments/compare/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "platform/pack.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {
namespace {

constexpr SealedKind trajectory_kind{"BALTRAJ3", "trajectory", 1};

/// What a solver made of the start; who it was and to what tolerance is in the file's name.
template <class Carrier, class Of>
void carry(Carrier& carrier, Of& trajectory) {
  carrier.text(trajectory.ended);
  carrier.list(trajectory.steps, [&](auto& step) {
    for (const StepColumn& column : step_columns()) carrier.number(step.*column.value);
  });
  carrier.list(trajectory.frame_times);
  carrier.list(trajectory.positions, [&](auto& centres) { carrier.list(centres); });
}

}  // namespace

std::string Trajectory::label() const {
  char text[32];
  if (max_iterations > 0)
    std::snprintf(text, sizeof text, " %d iterations", max_iterations);
  else
    std::snprintf(text, sizeof text, " %g", tolerance);
  return solver + text + (law == name_of(ContactLaw::coulomb) ? "" : " (" + law + ")");
}

std::vector<double> distances(const Trajectory& trajectory, const Trajectory& reference) {
  std::vector<double> result;
  for (size_t k = 0; k < std::min(trajectory.positions.size(), reference.positions.size()); ++k) {
    const Eigen::VectorXd& p = trajectory.positions[k];
    const double grains = static_cast<double>(p.size()) / 3.0;
    result.push_back(grains > 0.0 ? std::sqrt((p - reference.positions[k]).squaredNorm() / grains)
                                  : 0.0);
  }
  return result;
}

std::string packed(const Trajectory& trajectory) {
  Packer packer;
  carry(packer, trajectory);
  return packer.bytes();
}

void unpack(const std::string& bytes, const std::string& origin, Trajectory& trajectory) {
  Unpacker unpacker(bytes, origin);
  carry(unpacker, trajectory);
  unpacker.finish();
  unpacker.require(trajectory.positions.size() == trajectory.frame_times.size());
}

void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory) {
  write_sealed_file(file, trajectory_kind, packed(trajectory));
}

void read_trajectory(const std::filesystem::path& file, Trajectory& trajectory) {
  unpack(read_sealed_file(file, trajectory_kind), file.string() + ": trajectory", trajectory);
}

}  // namespace ballast
