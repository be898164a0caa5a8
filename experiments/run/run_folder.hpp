#pragma once
// The folder of one run: what is where, and who may write into it.

#include <filesystem>
#include <string>
#include <vector>

#include "platform/atomic_file.hpp"

namespace ballast {

class Manifest;

class RunFolder {
 public:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}
  /// The folder `output`, or results/<scene name> where that is empty.
  static RunFolder of(const std::filesystem::path& output, const std::string& scene_name);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path scene() const { return path_ / "scene.toml"; }
  std::filesystem::path manifest() const { return path_ / "manifest.json"; }
  std::filesystem::path checkpoint() const { return path_ / "checkpoint.bin"; }
  std::filesystem::path capture() const { return path_ / "capture"; }
  /// Whole states kept at record.state_rate: checkpoint files of single steps.
  std::filesystem::path states() const { return path_ / "states"; }
  std::filesystem::path state_at(long step) const;
  /// Those that there are, in the order of time.
  std::vector<std::filesystem::path> state_files() const;
  std::filesystem::path steps_log() const { return path_ / "log" / "steps.bin"; }
  bool has_run() const { return is_there(scene()); }
  /// It holds all of the run of this key: every step, and records that have been closed.
  bool is_finished(const std::string& key) const;

  /// A fresh run: manifest.json and scene.toml are written. Refuses a folder that holds a run,
  /// unless `overwrite`: then the files of that run are removed, by their names, and nothing else.
  /// Refuses a folder with files but without a run of ours: they are somebody's, and are neither
  /// removed nor mixed with a run's.
  void begin(const std::string& scene_text, const Manifest& manifest, bool overwrite) const;
  /// A run to continue: refuses a folder without one, or with another scene than `scene_text`.
  void reopen(const std::string& scene_text) const;

 private:
  bool is_of_a_run() const;
  void clear() const;

  std::filesystem::path path_;
};

/// Entry of a manifest's summary: steps that are still to be done. 0 is written last of all.
inline constexpr const char* steps_left_entry = "steps_left";

}  // namespace ballast
