#pragma once
// The content of a page's replay, before it is packed: bodies at some moments, contacts and curves,
// of a run, a scene, a mesh or a captured problem.

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

/// The error of one backend's answers to the problem of a single frame, contact by contact.
struct ViewErrors {
  std::string backend;
  std::vector<int> iterations;             ///< the budgets, ascending
  std::vector<std::vector<double>> error;  ///< [budget][contact], over the velocity scale
  std::vector<double> rms;                 ///< [budget], over the velocity scale
};

struct ViewData {
  std::string title;
  MechanicalSystem system;          ///< its driven wall moves as the series "x" says, outward [mm]
  bool has_shapes = true;           ///< false: bodies are hulls of their contact points
  std::vector<MotionState> frames;  ///< at least one
  /// Returns the contacts with a force in a frame, by its number; empty: no contacts are known. A
  /// run's contacts are read when they are asked for.
  std::function<std::vector<FrameContact>(size_t frame)> contacts;
  bool has_forces_later = false;  ///< once the run's record is finished, which holds them
  std::vector<double> series_time;
  std::vector<ViewSeries> series;
  std::vector<ViewPlot> plots;
  std::vector<ViewErrors> errors;  ///< of the contacts of the one frame
};

/// Returns the view of a run: its stored frames, forces where the record has them, curves of the
/// driven wall if there is one, and of the solid fraction of grains or else of energy and contacts.
/// Returns nothing where no pose is stored. Throws Error on a damaged record.
std::optional<ViewData> view_of_run(const RunData& run);

/// Returns the view of a scene before its first step. With grains it is the packing, where the
/// cache has it, else the rain from which the packing would be made.
ViewData view_of_scene(const Scene& scene, const std::filesystem::path& packing_cache);

/// One convex body of an OBJ or STL file, in its own frame. Throws MeshFileError.
ViewData view_of_mesh(const std::filesystem::path& file);

/// Returns the number of the frame nearest in time [s]. Needs at least one frame.
size_t nearest_frame(const std::vector<MotionState>& frames, double time);

// A captured problem in space, and where answers to it are wrong.

/// The backends that answer, the most iterations of each (budgets of 1, 3, 10, 30, ... are tried as
/// well), and their start.
struct ErrorQuestion {
  std::vector<std::string> backends = {"pgs", "auto"};
  int most_iterations = 1000;
  bool is_warm = false;  ///< from the captured start; else from zero
  bool operator==(const ErrorQuestion&) const = default;
};

/// Returns the bodies of a captured problem with its contacts and forces, and the judge's error of
/// every contact under each backend and budget, over the problem's velocity scale. The bodies are
/// those of the run whose capture/ holds the file, at the stored frame nearest to the problem's
/// time, or without such a run hulls of their contact points. Throws UnknownSolver, MissingSolver,
/// UnsupportedProblem, Error.
ViewData view_of_problem(const std::filesystem::path& file, const ErrorQuestion& question);

}  // namespace ballast
