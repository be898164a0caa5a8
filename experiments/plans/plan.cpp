#include "experiments/plans/plan.hpp"

#include <set>

#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

void check_name(const std::string& name, const std::string& what, const std::string& origin) {
  if (!is_plain(name, "_-.=") || name[0] == '.' || name[0] == '-')
    throw SceneFileError(origin + ": " + what + " = \"" + name +
                         "\": expected letters, digits, _, -, . and =");
}

}  // namespace

void validate(const Plan& plan, const std::string& origin) {
  check_name(plan.name, "name", origin);
  std::set<std::string> names;
  for (const PlannedRun& run : plan.runs) {
    check_name(run.name, "run.name", origin);
    if (!names.insert(run.name).second)
      throw SceneFileError(origin + ": run.name = \"" + run.name +
                           "\": stands twice, expected another name for each run");
    try {
      run_key(run);
    } catch (const SceneFileError& error) {
      throw SceneFileError(origin + ": run " + run.name + ": " + error.what());
    }
  }
}

void write_plan(const Plan& plan, const fs::path& file) {
  toml::array runs;
  for (const PlannedRun& run : plan.runs) {
    toml::array set;
    for (const std::string& text : run.overrides) set.push_back(text);
    // a path is relative to the plan's file when it is read
    const bool is_path = is_file(run.scene);
    const std::string scene =
        is_path ? fs::absolute(run.scene).lexically_normal().string() : run.scene;
    runs.push_back(toml::table{{"name", run.name}, {"scene", scene}, {"set", std::move(set)}});
  }
  write_whole_file(file, toml_text(toml::table{{"name", plan.name}, {"run", std::move(runs)}}));
}

std::string run_key(const PlannedRun& run) {
  return resolve_scene(find_scene(run.scene), run.overrides).key;
}

fs::path folder_of(const fs::path& results, const PlannedRun& run) {
  return results / "runs" / run_key(run);
}

bool is_finished(const fs::path& results, const PlannedRun& run) {
  const std::string key = run_key(run);
  return RunFolder(results / "runs" / key).is_finished(key);
}

}  // namespace ballast
