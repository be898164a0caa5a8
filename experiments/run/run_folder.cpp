#include "experiments/run/run_folder.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <vector>

#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

/// What a run writes: files of this pattern in this folder of its own.
struct RunFile {
  const char *folder, *pattern;
};
constexpr RunFile run_files[] = {{"log", "steps.bin"},
                                 {"log", "poses.bin"},
                                 {"log", "forces.bin"},
                                 {"capture", "step_[0-9]*.hdf5"},
                                 {"states", "step_[0-9]*.bin"},
                                 {"", "checkpoint.bin"},
                                 {"", "steps.csv"},
                                 {"", "record.h5"},
                                 {"", "report.html"},
                                 {"", "scene.toml"},
                                 {"", "manifest.json"}};

/// What may be in a folder before its run has begun: a run that was killed meanwhile leaves it.
constexpr const char* beginnings[] = {"run.lock", "manifest.json", "manifest.json.tmp",
                                      "scene.toml.tmp"};

bool is_manifest(const fs::path& file) {
  try {
    Manifest::read(file);
    return true;
  } catch (const Error&) {
    return false;
  }
}

void remove_file(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw Error(file.string() + ": cannot remove: " + error.message());
}

/// The page's figures: our scripts, known by their first line, and what gnuplot made of them.
void clear_figures(const fs::path& folder) {
  std::error_code none;
  std::vector<fs::path> scripts;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".gnuplot" && entry.is_regular_file(none))
      scripts.push_back(entry.path());
  for (const fs::path& script : scripts) {
    const std::string name = script.stem().string();
    if (!read_whole_file(script).starts_with("# " + name + ": gnuplot ")) continue;
    remove_file(script);
    remove_file(folder / (name + ".svg"));
  }
  if (!scripts.empty()) fs::remove(folder, none);  // where nothing else is in it
}

template <class Names>
bool has_entries_but(const fs::path& folder, const Names& names) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (std::find(std::begin(names), std::end(names), entry.path().filename()) == std::end(names))
      return true;
  return false;
}

}  // namespace

RunFolder RunFolder::of(const fs::path& output, const std::string& scene_name) {
  return RunFolder(output.empty() ? fs::path("results") / scene_name : output);
}

bool RunFolder::is_finished(const std::string& key) const {
  for (const fs::path& file : {manifest(), path_ / "steps.csv", path_ / "record.h5"})
    if (!is_there(file)) return false;
  const Manifest found = Manifest::read(manifest());
  return found.key() == key && found.summary_number(steps_left_entry) == 0.0;
}

void RunFolder::begin(const std::string& scene_text, const Manifest& manifest,
                      bool overwrite) const {
  create_folder(path_);
  // A folder counts as new that holds nothing but what a run leaves that died while it began.
  const bool is_new = !has_entries_but(path_, beginnings) &&
                      (!is_there(this->manifest()) || is_manifest(this->manifest()));
  if (!is_new && !is_of_a_run())
    throw Error(path_.string() +
                ": holds files that are no run's: give a folder that is new or empty");
  if (!is_new && !overwrite)
    throw Error(path_.string() +
                ": holds a run already: --continue goes on with it, --overwrite replaces it");
  clear();
  // The manifest first: a scene.toml without one could be anybody's.
  manifest.write(this->manifest());
  write_whole_file(scene(), scene_text);
}

/// Its manifest is a run's, and its scene stands beside it.
bool RunFolder::is_of_a_run() const { return has_run() && is_manifest(manifest()); }

void RunFolder::clear() const {
  clear_figures(path_ / "figures");
  for (const RunFile& file : run_files) {
    std::error_code none;
    const fs::path folder = path_ / file.folder;
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
      if (fnmatch(file.pattern, entry.path().filename().c_str(), 0) == 0)
        found.push_back(entry.path());
    for (const fs::path& path : found) remove_file(path);
    // Where nothing else is in it.
    if (*file.folder && !found.empty()) fs::remove(folder, none);
  }
}

fs::path RunFolder::state_at(long step) const { return states() / printed("step_%08ld.bin", step); }

std::vector<fs::path> RunFolder::state_files() const {
  std::vector<fs::path> files;
  if (!is_folder(states())) return files;
  for (const auto& entry : fs::directory_iterator(states()))
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void RunFolder::reopen(const std::string& scene_text) const {
  if (!has_run())
    throw Error(path_.string() + ": no run to resume: " + scene().filename().string() +
                " is missing");
  if (read_whole_file(scene()) != scene_text)
    throw Error(path_.string() +
                ": holds a run of other settings: give the same scene and --set, or --overwrite");
}

}  // namespace ballast
