#include "experiments/plans/resolved_run.hpp"

#include "experiments/box/vibrated_box.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/row_log.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace fs = std::filesystem;

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
    const RowReader reader(log);
    const std::uintmax_t bytes = fs::file_size(log) - reader.header_bytes();
    return static_cast<long>(bytes /
                             (sizeof(double) * reader.header().row_size + sizeof(std::uint64_t)));
  } catch (const Error&) {  // just being made
    return 0;
  }
}

}  // namespace ballast
