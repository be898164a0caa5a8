#include "experiments/compare/collection.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/compare/compare_case.hpp"
#include "experiments/run/run.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/files/captured_problem.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

constexpr int grain_counts[] = {20, 60, 200, 600, 1200, 2600};

struct CollectedScene {
  const char* name;
  std::vector<std::string> overrides;
};

std::vector<CollectedScene> collected_scenes() {
  return {{"shaken", {"drive.frequency=20"}},
          {"pressed", {"drive.f_min_over_weight=3"}},
          {"agitated", {"drive.frequency=60", "drive.f_max_over_weight=6", "contact.friction=1"}}};
}

const std::vector<std::string> manifest_columns = {"file", "content", "contacts",
                                                   "rows", "step",    "phase"};

CollectedProblem described(const fs::path& file, const std::string& name) {
  const CapturedProblem captured = read_captured(file);
  return {name,
          content_of(captured.problem, captured.start, captured.velocity_scale()),
          captured.problem.contact_count(),
          captured.problem.row_count(),
          captured.step,
          captured.phase};
}

void write_manifest(const fs::path& file, std::span<const CollectedProblem> problems) {
  CsvWriter csv;
  csv.add_row(manifest_columns);
  for (const CollectedProblem& p : problems)
    csv.add_row(std::vector<std::string>{p.file, p.content, std::to_string(p.contacts),
                                         std::to_string(p.rows), std::to_string(p.step), p.phase});
  write_whole_file(file, csv.take());
}

}  // namespace

std::vector<CollectedRun> collection_runs(int most_grains) {
  std::vector<CollectedRun> runs;
  for (const int grains : grain_counts) {
    if (grains > most_grains) continue;
    // The paper's section scaled with the number of grains, but no narrower than four of them.
    const double width = std::max(0.22, 0.54 * std::cbrt(grains / 1200.0));
    for (const CollectedScene& scene : collected_scenes()) {
      CollectedRun run{printed("%s-%d", scene.name, grains),
                       {printed("grains.count=%d", grains), printed("box.length=%.3g", width),
                        printed("box.width=%.3g", width), "control_volume.margin_x=0.03",
                        "scene.duration=0.048", "solver.max_iterations=200"}};
      run.overrides.insert(run.overrides.end(), scene.overrides.begin(), scene.overrides.end());
      runs.push_back(std::move(run));
    }
  }
  return runs;
}

ExitCode make_collection(const fs::path& folder, std::span<const CollectedRun> runs,
                         const std::function<void(const CollectedRun&)>& told,
                         std::vector<CollectedProblem>& problems) {
  problems.clear();
  for (const CollectedRun& wanted : runs) {
    told(wanted);
    RunOptions options;
    options.scene = "vibrated_box";
    options.overrides = wanted.overrides;
    options.output = folder / "runs" / wanted.name;
    options.packing_cache = folder / "packings";
    options.begin_or_resume = true;
    options.capture = "every=60,steps=1";
    options.telling = Telling::nobody;
    if (const ExitCode code = run(options).code; code != ExitCode::ok) return code;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(options.output / "capture"))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    create_folder(folder / "problems" / wanted.name);
    for (const fs::path& file : files) {
      const std::string name = wanted.name + '/' + file.filename().string();
      write_whole_file(folder / "problems" / name, read_whole_file(file));
      problems.push_back(described(file, name));
    }
  }
  write_manifest(folder / "problems" / "manifest.csv", problems);
  return ExitCode::ok;
}

std::vector<CollectedProblem> read_collection(const fs::path& manifest) {
  CsvReader csv(manifest);
  if (!csv.next() || !std::equal(csv.cells().begin(), csv.cells().end(), manifest_columns.begin(),
                                 manifest_columns.end()))
    csv.fail("is no manifest of a collection: expected " + joined(manifest_columns));
  std::vector<CollectedProblem> problems;
  while (csv.next()) {
    csv.require_cells(manifest_columns.size());
    const auto text = [&](size_t k) { return std::string(csv.cells()[k]); };
    const auto count = [&](size_t k) {
      return static_cast<int>(csv.number(k, manifest_columns[k]));
    };
    problems.push_back({text(0), text(1), count(2), count(3), count(4), text(5)});
  }
  return problems;
}

std::vector<std::string> other_contents(std::span<const CollectedProblem> ours,
                                        std::span<const CollectedProblem> theirs) {
  std::map<std::string, std::string> known;
  for (const CollectedProblem& p : theirs) known[p.file] = p.content;
  std::vector<std::string> others;
  for (const CollectedProblem& p : ours)
    if (const auto found = known.find(p.file); found != known.end() && found->second != p.content)
      others.push_back(p.file);
  return others;
}

}  // namespace ballast
