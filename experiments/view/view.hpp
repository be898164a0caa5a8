#pragma once
// What is shown in 3D: bodies at some moments, contacts and curves, of a run, a scene, a mesh or a
// captured problem (view_data.cpp); its page (view_page.cpp) and still pictures of it (still.cpp).

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/measure/run_data.hpp"
#include "experiments/page/page.hpp"
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

// Pages.

/// The most bytes of a replay in a page: frames and contacts are thinned out until it fits.
inline constexpr size_t replay_bytes = 12u << 20;

/// Packs the data of a replay, without picture and caption; experiments/page/replay/data.js reads
/// them. If they would be more than `most_bytes` in the page, every second, fourth, ... frame is
/// packed (the first and the last always), and the contacts of every second, ... of these frames.
/// Throws std::invalid_argument without a frame.
page::Replay pack_view(const ViewData& view, size_t most_bytes = replay_bytes);

/// Returns a view as a part of a page: its data, a still picture of its first frame, and a caption
/// that says how to use it.
page::Replay replay_of(const ViewData& view);

/// Writes the view as a page of its own, first beside `file`, then renamed to it. Throws Error.
void write_view_page(const ViewData& view, const std::filesystem::path& file);

// Pictures without a display, as PNG files.

/// How a still picture is taken.
struct StillOptions {
  double yaw = -52.0, pitch = 20.0;  ///< direction towards the eye [degrees]
  int width = 960, height = 640;     ///< [pixels]
  bool with_chains = false;          ///< draws force chains, and the bodies as glass
  bool operator==(const StillOptions&) const = default;
};

/// Sets yaw and pitch from a word of the command line: "home", "x", "-x", "y", "-y", "z", or
/// "<yaw>,<pitch>" in degrees. Throws std::invalid_argument.
void set_view(StillOptions& options, const std::string& word);

/// Draws one frame as a PNG: bodies with the sun's shadow and dark edges, walls as glass, the load
/// as an arrow. Colours show the speed of grains, on one scale for all frames of the view, or their
/// size in a view of a single frame. Several frames become an animated PNG, which moves in every
/// browser, with a tenth of a second for each.
std::string still_png(const ViewData& view, const std::vector<size_t>& frames,
                      const StillOptions& options);

}  // namespace ballast
