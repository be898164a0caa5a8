#pragma once
// What one backend made of a common start: every step's scalars, and where the grains went.

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "experiments/step/step_record.hpp"

namespace ballast {

struct Trajectory {
  static constexpr const char* complete = "complete";

  std::string solver, law;
  double tolerance = 0.0;  ///< natural map rms, over the comparison's velocity scale
  int max_iterations = 0;  ///< of one solve, the limit; 0: none
  std::string ended;       ///< complete, or why not: "time limit", "failed", a backend's own words
  std::vector<StepRecord> steps;
  std::vector<double> frame_times;         ///< [s]
  std::vector<Eigen::VectorXd> positions;  ///< centres of all grains, 3 each [m]; one per frame
  bool is_complete() const { return ended == complete; }
  std::string label() const;  ///< "pgs 1e-4", "nncg 50 iterations", "sap 1e-4 (convex)"
};

/// rms over grains of the distance from the reference at each frame that both have [m].
std::vector<double> distances(const Trajectory& trajectory, const Trajectory& reference);

/// The trajectory's end, steps and frames as bytes (platform/pack.hpp), and back into a trajectory
/// whose solver and limits are known. Throws Error that begins with `origin`.
std::string packed(const Trajectory& trajectory);
void unpack(const std::string& bytes, const std::string& origin, Trajectory& trajectory);

/// The same in a file that is read whole or refused. Throw Error naming it.
void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);
void read_trajectory(const std::filesystem::path& file, Trajectory& trajectory);

}  // namespace ballast
