#pragma once
// The closed loop: one scene from one start under several backends and tolerances, and what that
// does to the physics.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/compare/comparison.hpp"
#include "experiments/compare/trajectory.hpp"
#include "experiments/record/progress.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

struct LiveOptions {
  std::string scene;                   ///< name or path
  std::vector<std::string> overrides;  ///< "dotted.key=value"
  std::vector<ComparedSolver> solvers;
  std::vector<double> tolerances{1e-2, 1e-3,
                                 1e-4};  ///< natural map rms, in g h (in m/s without gravity)
  double start = 0.0;     ///< simulated time up to which the scene's own solver goes, once for all
                          ///< [s]; at least one step
  double duration = 0.1;  ///< simulated from there under each backend [s]
  double max_seconds = 60.0;            ///< wall clock of one solve
  int max_iterations = 0;               ///< of one solve; 0: as many as the tolerance needs
  int threads = 1;                      ///< of the step and its solver: the same bits
  double trajectory_seconds = 600.0;    ///< wall clock of one trajectory
  std::filesystem::path packing_cache;  ///< empty: <folder>/packings
  Telling telling = Telling::reader;    ///< of the start
  std::filesystem::path folder;  ///< start/ (a run), trajectories/<key>.bin, live.csv, live.html
};

struct LiveComparison {
  Scene scene;
  double velocity_scale = 1.0;  ///< [m/s]: tolerances are relative to it
  bool has_driven_wall = false;
  int reference = -1;  ///< index of the reference solution: exact law, tightest tolerance,
                       ///< complete, first listed; -1: none
  std::vector<Trajectory> trajectories;
  /// Of the command line, without --solvers and --tolerances: what makes them again.
  std::string command;
};

/// Steps every backend to every tolerance in a child process of its own; trajectories that are
/// there are not made again. `said` hears of each; returning false stops. Throws SceneFileError,
/// Error.
LiveComparison run_live(const LiveOptions& options,
                        const std::function<bool(const Trajectory&)>& said);

}  // namespace ballast
