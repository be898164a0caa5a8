#include "experiments/run/run_folder.hpp"

#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace fs = std::filesystem;

RunFolder RunFolder::of(const fs::path& output, const std::string& scene_name) {
  return RunFolder(output.empty() ? fs::path("results") / scene_name : output);
}

bool RunFolder::is_finished(const std::string& key) const {
  for (const fs::path& file : {manifest(), path_ / "steps.csv", path_ / "record.h5"})
    if (!fs::exists(file)) return false;
  const Manifest found = Manifest::read(manifest());
  return found.key() == key && found.summary_number(steps_left_entry) == 0.0;
}

void RunFolder::begin(const std::string& scene_text, bool overwrite) const {
  if (has_run() && !overwrite)
    throw Error(path_.string() +
                ": holds a run already: --resume continues it, --overwrite replaces it");
  create_folder(path_);
  if (overwrite)  // only what a run writes: never a folder as a whole
    for (const char* name :
         {"scene.toml", "manifest.json", "checkpoint.bin", "steps.csv", "record.h5", "report.html",
          "log", "figures", "paraview", "capture", "states"}) {
      std::error_code error;
      fs::remove_all(path_ / name, error);
      if (error) throw Error((path_ / name).string() + ": cannot remove: " + error.message());
    }
  write_whole_file(scene(), scene_text);
}

fs::path RunFolder::state_at(long step) const { return states() / printed("step_%08ld.bin", step); }

void RunFolder::reopen(const std::string& scene_text) const {
  if (!has_run())
    throw Error(path_.string() + ": no run to resume: " + scene().filename().string() +
                " is missing");
  if (read_whole_file(scene()) != scene_text)
    throw Error(path_.string() +
                ": holds a run of other settings: give the same scene and --set, or --overwrite");
}

}  // namespace ballast
