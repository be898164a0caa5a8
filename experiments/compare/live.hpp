#pragma once
// The closed loop: one scene is stepped from one start under several backends and tolerances, to
// see their effect on the physics.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "experiments/compare/comparison.hpp"
#include "experiments/record/progress.hpp"
#include "experiments/step/step_record.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

/// The motion under one backend from the common start: every step's scalars and the grains' places.
struct Trajectory {
  static constexpr const char* complete = "complete";

  std::string solver, law;
  double tolerance = 0.0;  ///< natural map rms, over the comparison's velocity scale; NaN: none
  int iterations = 0;      ///< of every solve, whatever the error; 0: until the tolerance
  std::string ended;       ///< complete, or why not: "time limit", "failed", a backend's own words
  std::vector<StepRecord> steps;
  std::vector<double> frame_times;         ///< [s]
  std::vector<Eigen::VectorXd> positions;  ///< centres of all grains, 3 each [m]; one per frame
  bool is_complete() const { return ended == complete; }
  /// The judge's error, rms over contacts, mean over steps [m/s]. Not finite without steps, or
  /// where the error of a step is not finite.
  double mean_error() const;
  std::string backend() const;  ///< "pgs", "sap (convex_relaxation)"
  std::string label() const;    ///< "pgs 0.0001", "nncg 50 iterations"
};

/// The index of the complete Coulomb trajectory of least mean error, the first of equals; -1: none.
int reference_of(const std::vector<Trajectory>& trajectories);

/// rms over grains of the distance from the reference at each frame that both have [m].
std::vector<double> distances(const Trajectory& trajectory, const Trajectory& reference);

/// Only these of CompareOptions are used: the solvers, the tolerances (in g h; in m/s without
/// gravity), the wall clock of one solve, and the folder, for start/ (a run),
/// trajectories/<key>.bin, live.csv and live.html.
struct LiveOptions : CompareOptions {
  std::string scene;                   ///< name or path
  std::vector<std::string> overrides;  ///< "dotted.key=value"
  double start = 0.0;     ///< simulated time up to which the scene's own solver steps, once for all
                          ///< backends [s]; at least one step
  double duration = 0.1;  ///< simulated time from there under each backend [s]
  std::vector<int> iterations = {};  ///< tried after the tolerances: fixed numbers of iterations in
                                     ///< every step, whatever the error
  int threads = 1;                   ///< of the step and its solver; changes no bit
  double trajectory_seconds = 600.0;                      ///< limit of one trajectory's wall clock
  std::filesystem::path packing_cache;                    ///< empty: <folder>/packings
  Progress::Style style = StatusLine::style_of_stderr();  ///< of the start's run
};

struct LiveComparison {
  Scene scene;
  double velocity_scale = 1.0;  ///< [m/s]: tolerances are relative to it
  bool has_driven_wall = false;
  int reference = -1;  ///< reference_of(trajectories)
  std::vector<Trajectory> trajectories;
  const Trajectory* reference_trajectory() const {
    return reference < 0 ? nullptr : &trajectories[static_cast<size_t>(reference)];
  }
  /// The command that makes the trajectories again, but for --solvers, --tolerances, --iterations.
  std::string command;
};

/// Steps the scene under every backend to every tolerance, and by every number of iterations, each
/// in a child process. Stored trajectories are not made again. `said` is called with each
/// trajectory; returning false stops the comparison. Throws Error.
LiveComparison run_live(const LiveOptions& options,
                        const std::function<bool(const Trajectory&)>& said);

}  // namespace ballast
