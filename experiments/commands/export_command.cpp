// The commands export (states of a run as files or pictures) and view (a page in 3D).

#include <cmath>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "experiments/commands/command.hpp"
#include "experiments/export/state_export.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/view/view.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/files/problem_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  fs::path source, output;
  double time = not_known;  ///< [s]
  bool all = false;
  std::optional<std::pair<size_t, size_t>> frames;  ///< numbers of the first and last
  StillOptions still;
};

/// Parses "35" or "20:40".
std::optional<std::pair<size_t, size_t>> parsed_frames(const std::string& word) {
  if (word.empty()) return std::nullopt;
  const std::vector<std::string> ends = split(word, ':');
  const auto first = parsed<int>(ends[0]), last = parsed<int>(ends.back());
  if (ends.size() > 2 || !first || !last || *first < 0 || *last < *first)
    throw std::invalid_argument("'" + word + "': expected the number of a frame, or FIRST:LAST");
  return std::pair(static_cast<size_t>(*first), static_cast<size_t>(*last));
}

ViewData run_view(const fs::path& folder) {
  std::optional<ViewData> view = view_of_run(read_run_data(folder));
  if (!view) throw Error(folder.string() + ": no poses are stored there");
  return std::move(*view);
}

bool is_picture(const ExportOptions& options) { return options.output.extension() == ".png"; }

/// The numbers of the first and last frame that are asked for.
std::pair<size_t, size_t> chosen_frames(const ExportOptions& options, const ViewData& view) {
  const size_t count = view.frames.size();
  if (options.all) return {0, count - 1};
  const size_t one =
      std::isnan(options.time) ? count - 1 : nearest_frame(view.frames, options.time);
  const auto chosen = options.frames.value_or(std::pair(one, one));
  if (chosen.second >= count)
    throw Error(options.source.string() + ": has frames 0 to " + std::to_string(count - 1) +
                printed(", not --frames %zu:%zu", chosen.first, chosen.second));
  return chosen;
}

ExitCode say(const std::string& files, const MotionState& first, const MotionState& last) {
  const bool is_one = first.step == last.step;
  std::cout << files << (is_one ? ": state at " : ": states from ") << first.time << " s, step "
            << first.step;
  if (!is_one) std::cout << ", to " << last.time << " s, step " << last.step;
  std::cout << '\n';
  return ExitCode::ok;
}

/// Exports stored frames: all, each as its own file; one; or some as one animated picture.
ExitCode export_frames(const ExportOptions& options) {
  const ViewData view = run_view(options.source);
  if (options.still.with_chains && !view.contacts)
    throw Error(options.source.string() +
                ": no forces are stored there (--set record.forces=true)");
  const auto [first, last] = chosen_frames(options, view);
  const auto write = [&](const fs::path& file, size_t from, size_t to) {
    if (!is_picture(options)) return export_state(view.system, view.frames[from], file);
    std::vector<size_t> chosen(to - from + 1);
    std::iota(chosen.begin(), chosen.end(), from);
    write_whole_file(file, still_png(view, chosen, options.still));
  };
  const MotionState &begin = view.frames[first], &end = view.frames[last];
  const fs::path& file = options.output;
  if (!options.all) {
    write(file, first, last);
    return say(file.string(), begin, end);
  }
  if (file.has_parent_path()) create_folder(file.parent_path());
  for (size_t k = first; k <= last; ++k) write(series_file(file, view.frames[k].step), k, k);
  if (file.extension() == ".vtp") write_series(view.frames, view.contacts, file);
  return say(series_file(file, begin.step).string() + " to " +
                 series_file(file, end.step).filename().string(),
             begin, end);
}

/// The folder of the run that a checkpoint, or one of its states, belongs to.
fs::path run_of(const fs::path& checkpoint) {
  const fs::path folder = fs::absolute(checkpoint).lexically_normal().parent_path();
  return RunFolder(folder.parent_path()).has_run() ? folder.parent_path() : folder;
}

ExitCode export_run(const ExportOptions& options) {
  const std::string output = options.output.string();
  if (!is_picture(options) && options.still != StillOptions{})
    throw UsageError(output + ": --view, --chains, --width and --height go with .png alone");
  if (!is_picture(options) && options.frames && options.frames->first < options.frames->second)
    throw UsageError(output + ": --frames FIRST:LAST goes with .png alone; --all: every frame");
  if (!path_exists(options.source))
    throw Error(options.source.string() + ": no such run folder or checkpoint");
  const bool from_folder = is_folder(options.source);
  if (options.all || options.frames || !std::isnan(options.time) || is_picture(options)) {
    if (from_folder) return export_frames(options);
    throw Error(options.source.string() +
                ": a checkpoint is one state: for frames and pictures give the run's folder");
  }
  MotionState state;
  const RunFolder run(from_folder ? options.source : run_of(options.source));
  const MechanicalSystem system = recorded_system(run.path(), state);
  if (!from_folder) state = run.read_state(options.source).state;
  if (state.pose.size() != system.bodies.size())
    throw Error(options.source.string() + ": holds " + std::to_string(state.pose.size()) +
                " bodies, the scene beside it " + std::to_string(system.bodies.size()));
  export_state(system, state, options.output);
  return say(options.output.string(), state, state);
}

struct ViewOptions {
  std::string thing;
  fs::path output, packing_cache = "results/packings";
  std::vector<std::string> overrides;
  ErrorQuestion question;
  bool open = false;
};

ViewData view_of(const ViewOptions& options) {
  const fs::path path = options.thing;
  const bool is_run = RunFolder(path).has_run(), is_mesh = is_mesh_file(path),
             is_problem = is_problem_file(path);
  if (!is_problem && options.question != ErrorQuestion{})
    throw UsageError(path.string() +
                     ": --solver, --iterations and --warm go with a captured problem alone");
  if ((is_run || is_mesh || is_problem) && !options.overrides.empty())
    throw UsageError(path.string() + ": --set goes with a scene alone");
  if (is_run) return run_view(path);
  if (is_mesh) return view_of_mesh(path);
  if (is_problem) {
    if (!is_captured(path)) {
      read_problem(path);  // throws where it is no problem at all
      throw Error(path.string() +
                  ": does not say where its contacts are, so there is nothing to show in 3D; "
                  "problems of ballast run --capture do");
    }
    for (const std::string& name : options.question.backends) find_solver(name);
    return view_of_problem(path, options.question);
  }
  return view_of_scene(read_scene(find_scene(options.thing), options.overrides),
                       options.packing_cache);
}

ExitCode write_view(const ViewOptions& options) {
  fs::path page = options.output;
  if (is_file(page) && fs::canonical(page).extension() != ".html")
    throw Error(page.string() + ": is no page (.html): it would be written over");
  if (page.empty()) {
    // The page goes into a run's folder or beside a problem, else into the current folder.
    const fs::path path = options.thing, name = path.stem().string() + ".view.html";
    page = is_folder(path) ? path / "view.html"
                           : (is_problem_file(path) ? path.parent_path() : fs::path()) / name;
  }
  write_view_page(view_of(options), page);
  std::cout << page.string() << std::endl;
  if (options.open && !run_program("xdg-open", {fs::absolute(page).string()}, 20.0).succeeded())
    throw Error("xdg-open: cannot open " + page.string() + ": open it in a browser");
  return ExitCode::ok;
}

}  // namespace

Command export_command() {
  const auto options = std::make_shared<ExportOptions>();
  return {
      "export",
      "Writes one state of a run, or all, for other programs",
      {{"source", &options->source, "A run's folder, or a checkpoint or state in it", required},
       {"--output FILE", &options->output,
        "The file to write: .obj, grains as meshes; .vtp, for ParaView; .png, a picture", required},
       {"--time S", &options->time, "The stored frame nearest to this time [s]", at_least(0)},
       {"--frames N", into(options->frames, parsed_frames),
        "Number of the stored frame, from 0; .png: FIRST:LAST is a moving picture (default: last)",
        excludes("--time")},
       {"--view FROM",
        TextParser{"home", [options](const std::string& word) { set_view(options->still, word); }},
        ".png: seen from home, x, -x, y, -y, z, or YAW,PITCH in degrees"},
       {"--chains", &options->still.with_chains,
        ".png: draws force chains, and bodies as glass; needs a run with record.forces=true"},
       {"--width PIXELS", &options->still.width, ".png: width in pixels", between(16, 8000)},
       {"--height PIXELS", &options->still.height, ".png: height in pixels", between(16, 8000)},
       {"--all", &options->all,
        "Writes every stored frame: FILE with _<step> before its suffix; for .vtp also a .pvd, "
        "which ParaView opens as one series, and the contacts of a run with record.forces=true",
        excludes("--time"), excludes("--frames")}},
      [options] { return export_run(*options); }};
}

Command view_command() {
  const auto options = std::make_shared<ViewOptions>();
  return {
      "view",
      "Writes a page that shows a run, problem, scene or mesh in 3D; prints its path",
      {{"thing", &options->thing,
        "A run's folder, a captured problem (.hdf5), a scene (name or TOML file), or a mesh (.obj, "
        ".stl)",
        required},
       {"--output FILE", &options->output,
        "The page to write (default: view.html in a run's folder, else NAME.view.html)"},
       {"--open", &options->open, "Opens the page in the browser (xdg-open)"},
       {"--solver NAME", &options->question.backends,
        "Captured problem: shows the errors of this backend; may be repeated"},
       {"--iterations N", &options->question.most_iterations,
        "Captured problem: most iterations; also shows errors after 1, 3, 10, 30, ... iterations",
        between(1, 100000)},
       {"--warm", &options->question.is_warm,
        "Captured problem: starts at the run's warm start, not at zero"},
       {"--set KEY=VALUE", &options->overrides, "Scene: overrides one value: dotted.key=value"},
       {"--packing-cache DIR", &options->packing_cache,
        "Scene with grains: where deposited packings are kept"}},
      [options] { return write_view(*options); }};
}

}  // namespace ballast
