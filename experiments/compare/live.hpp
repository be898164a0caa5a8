#pragma once
// The closed loop: one scene is stepped from one start under several backends and tolerances, to
// see their effect on the physics; its page, figures and tables.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "experiments/compare/comparison.hpp"
#include "experiments/page/page.hpp"
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
  std::vector<Trajectory> trajectories;
  /// The complete Coulomb trajectory of least mean error, the first of equals; null: none.
  const Trajectory* reference() const;
  /// The command that makes the trajectories again, but for --solvers, --tolerances, --iterations.
  std::string command;
};

/// Steps the scene under every backend to every tolerance, and by every number of iterations, each
/// in a child process, until all are made or an interrupt comes. Stored trajectories are not made
/// again. `said` is called with each trajectory. Throws Error.
LiveComparison run_live(const LiveOptions& options,
                        const std::function<void(const Trajectory&)>& said);

// The output (live_page.cpp).

/// A number that sums up a trajectory: a column of live.csv and, with a head, of the page's table.
struct LiveNumber {
  const char* name;  ///< in live.csv, in SI units, or in ms where it says so
  const char* head;  ///< of the page's column, in the notation of page::marked; null: no column
  const char* unit;  ///< on the page
  double factor;     ///< from the unit in live.csv to that on the page
  int digits;        ///< on the page
  /// Returns NaN where it is not known or does not exist (no steps, wall, grains or reference).
  double (*of)(const Trajectory& trajectory, const LiveComparison& comparison);
};
std::span<const LiveNumber> live_numbers();

/// One row for each trajectory.
std::string live_csv(const LiveComparison& comparison);

/// Figures with a line for every trajectory; the last one is error against cost, with a line for
/// every backend. Figures of the wall need a driven wall, distances need a reference. A figure
/// without known values has no panels.
std::vector<page::Picture> live_figures(const LiveComparison& comparison);

/// Reads manifest.json of `folder`; writes live.csv, trajectories as steps-<label>.csv,
/// figures/*.svg and live.html there. Throws Error.
void write_live_page(const std::filesystem::path& folder, const LiveComparison& comparison);

/// The k-th backend's line: eight colours, then the same dashed, then thin.
Curve backend_curve(size_t k, const std::string& title);

}  // namespace ballast
