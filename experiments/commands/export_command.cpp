// States of a run as files for other programs and as pictures; things in 3D as a page.

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "experiments/commands/command.hpp"
#include "experiments/export/state_export.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/record/recorder.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/view/still.hpp"
#include "experiments/view/view_page.hpp"
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
  std::optional<std::pair<size_t, size_t>> frames;  ///< of pictures: numbers of the first and last
  StillOptions still;
};

/// "35" or "20:40".
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

/// Every stored frame as a file of its own.
ExitCode export_all(const ExportOptions& options) {
  const ViewData view = run_view(options.source);
  export_series(view.system, view.frames, view.contacts, options.output);
  const MotionState &first = view.frames.front(), &last = view.frames.back();
  std::cout << series_file(options.output, first.step).string() << " to "
            << series_file(options.output, last.step).filename().string() << ": "
            << view.frames.size() << " states from " << first.time << " s to " << last.time
            << " s\n";
  return ExitCode::ok;
}

/// Stored frames drawn without a display: one, or a picture that moves.
ExitCode export_picture(const ExportOptions& options) {
  const ViewData view = run_view(options.source);
  if (options.still.with_chains && !view.contacts)
    throw Error(options.source.string() +
                ": no forces are stored there (--set record.forces=true)");
  const std::vector<MotionState>& frames = view.frames;
  const size_t one =
      std::isnan(options.time) ? frames.size() - 1 : nearest_frame(frames, options.time);
  const auto [first, last] = options.frames.value_or(std::pair(one, one));
  if (last >= frames.size())
    throw Error(options.source.string() + ": has frames 0 to " + std::to_string(frames.size() - 1) +
                printed(", not --frames %zu:%zu", first, last));
  std::vector<size_t> chosen;
  for (size_t frame = first; frame <= last; ++frame) chosen.push_back(frame);
  write_whole_file(options.output, still_png(view, chosen, options.still));
  std::cout << options.output.string() << ": frames " << first << " to " << last << ", from "
            << frames[first].time << " s to " << frames[last].time << " s\n";
  return ExitCode::ok;
}

ExitCode export_run(const ExportOptions& options) {
  if (options.output.extension() == ".png") return export_picture(options);
  if (!is_there(options.source))
    throw Error(options.source.string() + ": no such run folder or checkpoint");
  const bool from_folder = is_folder(options.source);
  const bool has_time = !std::isnan(options.time);
  if (!from_folder && (has_time || options.all))
    throw Error(options.source.string() + ": a checkpoint is one state: give the run's folder");
  if (options.all) return export_all(options);
  MechanicalSystem system;
  MotionState state;
  if (has_time) {
    ViewData view = run_view(options.source);
    state = view.frames[nearest_frame(view.frames, options.time)];
    system = std::move(view.system);
  } else {
    system = recorded_system(
        from_folder ? options.source : fs::absolute(options.source).parent_path(), state);
    if (!from_folder) state = read_checkpoint(options.source).state;
  }
  if (state.pose.size() != system.bodies.size())
    throw Error(options.source.string() + ": holds " + std::to_string(state.pose.size()) +
                " bodies, the scene beside it " + std::to_string(system.bodies.size()));
  export_state(system, state, options.output);
  std::cout << options.output.string() << ": state at " << state.time << " s, step " << state.step
            << '\n';
  return ExitCode::ok;
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
  const std::string suffix = path.extension().string();
  if (RunFolder(path).has_run()) return run_view(path);
  if (suffix == ".obj" || suffix == ".stl") return view_of_mesh(path);
  if (is_problem_file(path)) {
    if (is_file(path) && !is_captured(path))
      throw Error(path.string() +
                  ": does not say where its contacts are, so there is nothing to show in 3D; "
                  "problems of ballast run --capture do");
    for (const std::string& name : options.question.backends) find_solver(name);
    return view_of_problem(path, options.question);
  }
  return view_of_scene(read_scene(find_scene(options.thing), options.overrides),
                       options.packing_cache);
}

ExitCode write_view(const ViewOptions& options) {
  fs::path page = options.output;
  if (page.empty()) {
    // Beside what is there already: in a run's folder, beside a problem; else here.
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
      {{"source", &options->source, "A run's folder, or a checkpoint in it", required},
       {"--output FILE", &options->output,
        "The file to write: .obj, grains as meshes; .vtp, for ParaView; .png, a picture", required},
       {"--time S", &options->time, "The stored frame nearest to this time [s]", at_least(0)},
       {"--frames N", into(options->frames, parsed_frames),
        ".png: number of the stored frame (the last); FIRST:LAST: a picture that moves"},
       {"--view FROM",
        Parsed{"home", [options](const std::string& word) { set_view(options->still, word); }},
        ".png: home, x, -x, y, -y, z, or YAW,PITCH in degrees"},
       {"--chains", &options->still.with_chains,
        ".png: force chains, bodies as glass; needs a run with record.forces"},
       {"--width PIXELS", &options->still.width, "png", between(16, 8000)},
       {"--height PIXELS", &options->still.height, "png", between(16, 8000)},
       {"--all", &options->all,
        "Every stored frame: FILE with _<step> before its suffix; with .vtp also the .pvd that "
        "ParaView opens as one series, and the contacts of a run with record.forces",
        excludes("--time")}},
      [options] { return export_run(*options); }};
}

Command view_command() {
  const auto options = std::make_shared<ViewOptions>();
  return {
      "view",
      "Writes a page that shows something in 3D, and says its path",
      {{"thing", &options->thing,
        "A run's folder, a captured problem (.hdf5), a scene (name or TOML file), or a mesh (.obj, "
        ".stl)",
        required},
       {"--output FILE", &options->output,
        "The page (view.html in a run's folder, NAME.view.html else)"},
       {"--open", &options->open, "Opens it in the browser (xdg-open)"},
       {"--solver NAME", &options->question.backends,
        "Of a captured problem: the backends whose errors are shown"},
       {"--iterations N", &options->question.most_iterations,
        "Of a captured problem: the largest budget; 1, 3, 10, 30, ... below it are shown too",
        between(1, 100000)},
       {"--warm", &options->question.is_warm,
        "Of a captured problem: begin where the run did, not at zero"},
       {"--set KEY=VALUE", &options->overrides, "Of a scene: dotted.key=value"},
       {"--packing-cache DIR", &options->packing_cache,
        "Of a scene with grains: where its packing may be"}},
      [options] { return write_view(*options); }};
}

}  // namespace ballast
