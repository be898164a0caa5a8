#include "experiments/compare/collection.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/compare/compare_case.hpp"
#include "experiments/run/run.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/text.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/files/problem_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

constexpr int grain_counts[] = {25, 80, 200, 600, 1200, 2400};
constexpr int settling_step = 10;  // 2 ms after the rain: no grain has come to rest

/// What all runs have in common. The packing is taken as soon as the highest grain has fallen, and
/// a light wall answers its drive within the run: 62 ms.
const std::vector<std::string> common_overrides = {
    "control_volume.margin_x=0.03",    "deposit.lid_pressure_weight=0",
    "deposit.settle_time=0",           "deposit.rest_velocity=0.5",
    "drive.wall_mass_over_grains=0.1", "scene.duration=0.062",
    "solver.max_iterations=400",       "record.forces=false"};

const CollectedRun scenes[] = {{"shaken", {"drive.frequency=20", "drive.f_max_over_weight=1"}},
                               {"pressed", {"drive.f_min_over_weight=3", "contact.friction=1"}},
                               {"released", {"drive.f_max_over_weight=0", "contact.friction=0.2"}}};

}  // namespace

std::vector<CollectedRun> collection_runs(int most_grains) {
  std::vector<CollectedRun> runs;
  for (const int grains : grain_counts) {
    if (grains > most_grains) continue;
    // The paper's section scaled with the number of grains, but no narrower than four of them.
    const double width = std::max(0.22, 0.54 * std::cbrt(grains / 1200.0));
    for (const CollectedRun& scene : scenes) {
      CollectedRun run{scene.name + "-" + std::to_string(grains),
                       {printed("grains.count=%d", grains), printed("box.length=%.3g", width),
                        printed("box.width=%.3g", width)}};
      run.overrides.insert(run.overrides.end(), common_overrides.begin(), common_overrides.end());
      run.overrides.insert(run.overrides.end(), scene.overrides.begin(), scene.overrides.end());
      runs.push_back(std::move(run));
    }
  }
  return runs;
}

ExitCode make_collection(const fs::path& folder, std::span<const CollectedRun> runs,
                         const std::function<void(const CollectedRun&)>& told) {
  CsvWriter manifest;
  manifest.add_row(
      std::vector<std::string>{"file", "content", "contacts", "rows", "step", "phase"});
  for (const CollectedRun& wanted : runs) {
    told(wanted);
    RunOptions options;
    options.scene = "vibrated_box";
    options.overrides = wanted.overrides;
    options.output = folder / "runs" / wanted.name;
    options.packing_cache = folder / "packings";
    options.resume = true;
    options.capture = CaptureSettings::parse(printed("every=95,steps=1,also=%d", settling_step));
    options.style = StatusLine::Style::quiet;
    if (const ExitCode code = run(options).code; code != ExitCode::ok) return code;
    create_folder(folder / "problems" / wanted.name);
    for (const FoundProblem& found : find_problems((options.output / "capture").string())) {
      const std::string name = wanted.name + '/' + found.name.string();
      write_whole_file(folder / "problems" / name, read_whole_file(found.file));
      const CapturedProblem captured = read_captured(found.file);
      const FrictionProblem& problem = captured.problem;
      manifest.add_row(std::vector<std::string>{
          name, content_of(problem, captured.start, captured.velocity_scale()),
          std::to_string(problem.contact_count()), std::to_string(problem.row_count()),
          std::to_string(captured.step),
          captured.step == settling_step ? "settling" : captured.phase});
    }
  }
  write_whole_file(folder / "problems" / "manifest.csv", manifest.take());
  return ExitCode::ok;
}

}  // namespace ballast
