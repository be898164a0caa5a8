// Things in 3D: a page that opens in a browser.

#include <algorithm>
#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/view/problem_view.hpp"
#include "experiments/view/view_page.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  std::string thing;
  fs::path output, packing_cache = "results/packings";
  std::vector<std::string> solvers, overrides;
  int iterations = 1000;
  bool warm = false, open = false;
};

/// 1, 3, 10, 30, ... up to the most.
std::vector<int> budgets_up_to(int most) {
  std::vector<int> budgets;
  for (int power = 1; power < most; power *= 10)
    for (const int budget : {power, 3 * power})
      if (budget < most) budgets.push_back(budget);
  budgets.push_back(most);
  return budgets;
}

ViewData view_of(const ViewOptions& options) {
  const fs::path path = options.thing;
  const std::string suffix = path.extension().string();
  if (RunFolder(path).has_run()) {
    const auto view = view_of_run(read_run_data(path));
    if (!view) throw Error(path.string() + ": no poses are stored there");
    return *view;
  }
  if (suffix == ".obj" || suffix == ".stl") return view_of_mesh(path);
  if (suffix == ".hdf5" || suffix == ".h5" || suffix == ".dat") {
    if (is_file(path) && !is_captured(path))
      throw Error(path.string() +
                  ": does not say where its contacts are, so there is nothing to show in 3D; "
                  "problems of ballast run --capture do");
    ErrorQuestion question;
    if (!options.solvers.empty()) question.backends = options.solvers;
    for (const std::string& name : question.backends) find_solver(name);
    question.iterations = budgets_up_to(options.iterations);
    question.is_warm = options.warm;
    return view_of_problem(path, question);
  }
  return view_of_scene(read_scene(find_scene(options.thing), options.overrides),
                       options.packing_cache);
}

/// Beside what is there already: in a run's folder, beside a problem; else here.
fs::path page_of(const ViewOptions& options) {
  if (!options.output.empty()) return options.output;
  const fs::path path = options.thing;
  if (is_folder(path)) return path / "view.html";
  const std::string name = path.stem().string() + ".view.html";
  return path.extension() == ".hdf5" || path.extension() == ".h5" ? path.parent_path() / name
                                                                  : fs::path(name);
}

ExitCode write_view(const ViewOptions& options) {
  const fs::path page = page_of(options);
  write_view_page(view_of(options), page);
  std::cout << page.string() << std::endl;
  if (options.open && !run_program("xdg-open", {fs::absolute(page).string()}, 20.0).succeeded())
    throw Error("xdg-open: cannot open " + page.string() + ": open it in a browser");
  return ExitCode::ok;
}

}  // namespace

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
       {"--solver NAME", &options->solvers,
        "Of a captured problem: the backends whose errors are shown (pgs and auto)"},
       {"--iterations N", &options->iterations,
        "Of a captured problem: the largest budget; 1, 3, 10, 30, ... below it are shown too",
        between(1, 100000), shown},
       {"--warm", &options->warm, "Of a captured problem: begin where the run did, not at zero"},
       {"--set KEY=VALUE", &options->overrides, "Of a scene: dotted.key=value"},
       {"--packing-cache DIR", &options->packing_cache,
        "Of a scene with grains: where its packing may be", shown}},
      [options] { return write_view(*options); }};
}

}  // namespace ballast
