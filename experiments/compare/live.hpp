#pragma once
// The closed loop: one scene from one start under several backends and tolerances, and what that
// does to the physics.

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

/// What one backend made of a common start: every step's scalars, and where the grains went.
struct Trajectory {
  static constexpr const char* complete = "complete";

  std::string solver, law;
  double tolerance = 0.0;  ///< natural map rms, over the comparison's velocity scale; NaN: none
  int iterations = 0;      ///< of every solve, whatever the error; 0: as many as it takes
  std::string ended;       ///< complete, or why not: "time limit", "failed", a backend's own words
  std::vector<StepRecord> steps;
  std::vector<double> frame_times;         ///< [s]
  std::vector<Eigen::VectorXd> positions;  ///< centres of all grains, 3 each [m]; one per frame
  bool is_complete() const { return ended == complete; }
  /// The judge's, rms over contacts [m/s]. Not finite where that of a step is not, or without
  /// steps.
  double mean_error() const;
  std::string backend() const;  ///< "pgs", "sap (convex_relaxation)"
  std::string label() const;    ///< "pgs 0.0001", "nncg 50 iterations"
};

/// Of exact law and complete, the one of the least mean error, first listed; -1: there is none.
int reference_of(const std::vector<Trajectory>& trajectories);

/// rms over grains of the distance from the reference at each frame that both have [m].
std::vector<double> distances(const Trajectory& trajectory, const Trajectory& reference);

/// Of those of a comparison count the solvers, the tolerances (in g h; in m/s without gravity), the
/// wall clock of one solve, and the folder, for start/ (a run), trajectories/<key>.bin, live.csv
/// and live.html.
struct LiveOptions : CompareOptions {
  std::string scene;                   ///< name or path
  std::vector<std::string> overrides;  ///< "dotted.key=value"
  double start = 0.0;     ///< simulated time up to which the scene's own solver goes, once for all
                          ///< [s]; at least one step
  double duration = 0.1;  ///< simulated from there under each backend [s]
  std::vector<int> iterations = {};     ///< after the tolerances: so many in every step, whatever
                                        ///< the error
  int threads = 1;                      ///< of the step and its solver: the same bits
  double trajectory_seconds = 600.0;    ///< wall clock of one trajectory
  std::filesystem::path packing_cache;  ///< empty: <folder>/packings
  Progress::Style style = StatusLine::style_of_stderr();  ///< of the start
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
  /// Of the command line, without --solvers, --tolerances and --iterations: what makes them again.
  std::string command;
};

/// Steps every backend to every tolerance, and by every number of iterations, in a child process of
/// its own; trajectories that are there are not made again. `said` hears of each; returning false
/// stops. Throws Error.
LiveComparison run_live(const LiveOptions& options,
                        const std::function<bool(const Trajectory&)>& said);

}  // namespace ballast
