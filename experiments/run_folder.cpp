#include "experiments/run_folder.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace ballast {
namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RunError(folder.string() + ": cannot create the folder: " + error.message());
}

void write_text(const fs::path& file, const std::string& text) {
  const fs::path beside = file.string() + ".tmp";
  std::ofstream out(beside, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw RunError(file.string() + ": cannot write: " + std::strerror(errno));
  std::error_code error;
  fs::rename(beside, file, error);
  if (error) throw RunError(file.string() + ": cannot write: " + error.message());
}

RunFolder RunFolder::of(const RunOptions& options, const std::string& scene_name) {
  return RunFolder(options.output.empty() ? fs::path("results") / scene_name : options.output);
}

void RunFolder::begin(const std::string& scene_text, bool overwrite) const {
  if (has_run() && !overwrite)
    throw RunError(path_.string() + ": holds a run already: --resume continues it, --overwrite replaces it");
  make_folder(path_);
  if (overwrite)  // only what a run writes: never a folder as a whole
    for (const char* name : {"scene.toml", "manifest.json", "checkpoint.bin", "steps.csv", "record.h5", "report.html", "log",
                             "figures", "paraview"}) {
      std::error_code error;
      fs::remove_all(path_ / name, error);
      if (error) throw RunError((path_ / name).string() + ": cannot remove: " + error.message());
    }
  write_text(scene(), scene_text);
}

void RunFolder::reopen(const std::string& scene_text) const {
  std::ifstream in(scene(), std::ios::binary);
  if (!in) throw RunError(path_.string() + ": no run to resume: " + scene().filename().string() + " is missing");
  std::stringstream found;
  found << in.rdbuf();
  if (found.str() != scene_text)
    throw RunError(path_.string() + ": holds a run of other settings: give the same scene and --set, or --overwrite");
}

}  // namespace ballast
