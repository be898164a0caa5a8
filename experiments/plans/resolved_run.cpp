#include "experiments/plans/resolved_run.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/run/manifest.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/row_log.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

ResolvedRun resolve(const PlannedRun& run) {
  const ResolvedScene read = resolve_scene(find_scene(run.scene), run.overrides);
  const Scene& scene = read.scene;
  ResolvedRun resolved;
  resolved.run = run;
  resolved.key = read.key;
  resolved.steps = scene.step_count();
  // Work is counted in bodies times steps.
  const double bodies =
      scene.grains ? scene.grains->count : static_cast<double>(scene.bodies.size());
  resolved.work = bodies * static_cast<double>(resolved.steps);
  if (!scene.grains) return resolved;
  resolved.packing = packing_key(scene);
  const DepositSpec& deposit = scene.deposit;
  // the rain rests long before its time is up
  const double rain_time = deposit.max_time / 3.0;
  resolved.packing_work = bodies * ((rain_time + deposit.lid_time) / deposit.step +
                                    deposit.settle_time / deposit.settle_step);
  return resolved;
}

}  // namespace

std::vector<ResolvedRun> resolve(const Plan& plan) {
  std::vector<ResolvedRun> runs;
  for (const PlannedRun& run : plan.runs) runs.push_back(resolve(run));
  return runs;
}

fs::path run_folder(const fs::path& results, const ResolvedRun& run) {
  return results / "runs" / run.key;
}
fs::path packing_folder(const fs::path& results) { return results / "packings"; }

namespace {

std::vector<std::string> scene_arguments(const fs::path& results, const PlannedRun& run) {
  std::vector<std::string> words{"run", run.scene};
  for (const std::string& text : run.overrides) words.insert(words.end(), {"--set", text});
  words.insert(words.end(), {"--packing-cache", packing_folder(results).string()});
  return words;
}

}  // namespace

std::vector<std::string> run_arguments(const fs::path& results, const ResolvedRun& run) {
  std::vector<std::string> words = scene_arguments(results, run.run);
  words.insert(words.end(),
               {"--output", run_folder(results, run).string(), "--continue", "--no-report"});
  return words;
}

std::vector<std::string> deposit_arguments(const fs::path& results, const ResolvedRun& run) {
  std::vector<std::string> words = scene_arguments(results, run.run);
  words.push_back("--deposit-only");
  return words;
}

long steps_in_log(const fs::path& run_folder) {
  const fs::path log = RunFolder(run_folder).steps_log();
  if (!is_there(log)) return 0;
  try {
    return RowReader(log).row_count();
  } catch (const Error&) {  // just being made
    return 0;
  }
}

namespace {

fs::path plans_folder(const fs::path& results) { return results / "plans"; }

/// Empty where nothing is known.
std::string number_text(double x) {
  if (std::isnan(x)) return "";
  return printed("%.6g", x);
}

/// The row of a run after its plan, name and key: what its folder says of it.
std::vector<std::string> facts_of(const fs::path& path, const std::string& key, long steps,
                                  bool failed) {
  const RunFolder folder(path);
  std::string state = failed             ? "failed"
                      : folder.has_run() ? "begun"
                                         : "waiting",
              seconds, error, commit;
  long done = std::min(steps, steps_in_log(path));
  if (folder.has_run()) try {
      const Manifest manifest = Manifest::read(folder.manifest());
      if (folder.is_finished(key)) {
        state = "finished";
        done = steps;
      }
      seconds = number_text(manifest.summary_number("drive_seconds"));
      error = number_text(manifest.summary_number("error_mean_relative"));
      commit = manifest.commit();
    } catch (const Error&) {  // not written yet, or damaged: the run itself will say so
    }
  return {state, std::to_string(done), std::to_string(steps), seconds, error, commit};
}

/// The rows of one plan.
void add_rows(CsvWriter& csv, const fs::path& results, const fs::path& file,
              const std::map<std::string, std::string>& failed) {
  try {
    const Json plan = Json::parse(read_whole_file(file));
    for (const Json& run : plan.at("runs")) {
      const std::string key = run.at("key");
      const long steps = run.at("steps");
      std::vector<std::string> cells{plan.at("plan"), run.at("name"), key};
      for (const std::string& cell :
           facts_of(results / "runs" / key, key, steps, failed.contains(key)))
        cells.push_back(cell);
      csv.add_row(cells);
    }
  } catch (const Json::exception&) {
    throw Error(file.string() + ": is no plan that ballast noted: " + broken_json);
  }
}

}  // namespace

void note_plan(const fs::path& results, const std::string& plan,
               const std::vector<ResolvedRun>& runs) {
  Json list = Json::array();
  for (const ResolvedRun& run : runs)
    list.push_back({{"name", run.run.name},
                    {"key", run.key},
                    {"packing", run.packing},
                    {"steps", run.steps},
                    {"scene", run.run.scene},
                    {"overrides", run.run.overrides}});
  create_folder(plans_folder(results));
  const Json text{{"plan", plan}, {"runs", std::move(list)}};
  write_whole_file(plans_folder(results) / (plan + ".json"),
                   text.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void write_index(const fs::path& results, const std::map<std::string, std::string>& failed) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(plans_folder(results)))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  CsvWriter csv;
  csv.add_row(std::vector<std::string>{"plan", "name", "key", "state", "steps_done", "steps",
                                       "seconds", "error_mean", "commit"});
  // Plans may share a folder: all that were ever run there are in the one table.
  for (const fs::path& file : files) add_rows(csv, results, file, failed);
  write_whole_file(results / "index.csv", csv.take());
}

}  // namespace ballast
