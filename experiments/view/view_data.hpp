#pragma once
// What a page's replay shows, before it is packed: bodies at some moments, contacts, curves; of a
// run, a scene, a mesh, a captured problem.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/measure/run_data.hpp"
#include "experiments/record/record_file.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// A quantity over time, in the unit that the reader sees.
struct ViewSeries {
  std::string name;    ///< short, for the page's script: "x"
  std::string symbol;  ///< for the reader: "f_g"
  std::string unit;
  std::string ink;             ///< colour of the page's style: "blue"
  std::vector<double> values;  ///< one for each entry of ViewData::series_time
};

struct ViewPlot {
  std::string over;  ///< name of a series; empty: time
  std::vector<std::string> series;
};

/// The error of one answer to the problem of a single frame, contact by contact.
struct ViewErrors {
  std::string backend;
  std::vector<int> iterations;             ///< the budgets, growing
  std::vector<std::vector<double>> error;  ///< [budget][contact], over the velocity scale
  std::vector<double> rms;                 ///< [budget], over the velocity scale
};

struct ViewData {
  std::string title;
  MechanicalSystem system;          ///< its driven wall moves as the series "x" says, outward [mm]
  bool has_shapes = true;           ///< false: bodies are drawn about what is known of them
  std::vector<MotionState> frames;  ///< at least one
  /// Those with a force of a frame, by its number; empty: none are known. A run's are read when
  /// they are asked for.
  std::function<std::vector<FrameContact>(size_t frame)> contacts;
  bool has_forces_later = false;  ///< when its record is finished, which holds them
  std::vector<double> series_time;
  std::vector<ViewSeries> series;
  std::vector<ViewPlot> plots;
  std::vector<ViewErrors> errors;  ///< of the contacts of the one frame
};

/// What there is to see of a run: stored frames, forces where the record has them, and the wall's
/// curves; without a driven wall the energy's. Nothing where no pose is stored. Throws Error on a
/// damaged record.
std::optional<ViewData> view_of_run(const RunData& run);

/// A scene before its first step. One with grains: its packing, where the cache has it, else the
/// rain from which it would be made.
ViewData view_of_scene(const Scene& scene, const std::filesystem::path& packing_cache);

/// One convex body of an OBJ or STL file, in its own frame. Throws MeshFileError.
ViewData view_of_mesh(const std::filesystem::path& file);

/// Number of the frame nearest in time [s]; at least one frame.
size_t nearest_frame(const std::vector<MotionState>& frames, double time);

// A captured problem in space: where answers to it are wrong.

/// The backends that are asked, how many iterations each may take at most (and 1, 3, 10, 30, ... of
/// them), and from where they begin.
struct ErrorQuestion {
  std::vector<std::string> backends = {"pgs", "auto"};
  int most_iterations = 1000;
  bool is_warm = false;  ///< from the captured start; else from zero
};

/// The bodies of a captured problem with its contacts and forces, and the judge's error of every
/// contact under each backend and budget, over the problem's velocity scale. The bodies are those
/// of the run whose capture/ holds the file, at the stored frame nearest to the problem's time;
/// where no run is around the file, hulls of their contact points. Throws UnknownSolver,
/// MissingSolver, UnsupportedProblem, Error.
ViewData view_of_problem(const std::filesystem::path& file, const ErrorQuestion& question);

}  // namespace ballast
