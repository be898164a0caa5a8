#pragma once
// The folder of one run: the places of its files, the rules for writing into it, its description
// of itself (manifest.json), and the bodies of the run.
//
//   {"ballast":  {"version", "commit": 40 digits or "unknown", "modified": true where tracked files
//                 differed from it, "compiler", "build_type", "flags",
//                 "libraries": {name: version}},
//    "machine":  {"cpu", "cores", "memory_GB", "load_average": [1, 5, 15 min],
//                 "environment": {name: value}},
//    "scene": name, "overrides": ["dotted.key=value"], "started": UTC,
//    "key": of the resolved scene,
//    "resumed":  [{"step", "at": UTC, "commit", "modified", "cpu"}],
//    "summary":  {name: number or text}}
//
// Times of day and the machine are here alone, and as a copy of this file in record.h5.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "platform/atomic_file.hpp"

namespace ballast {

struct Checkpoint;
struct MechanicalSystem;
struct MotionState;

/// The program in words: "ballast 0.1.0 (0123456789ab, modified), GNU 12.2.0, Release".
std::string build_line();

/// The processor as the kernel names it; "unknown" where it doesn't (other architectures).
std::string cpu_model();

/// The manifest of a run or other measurement: its program, machine, time and results.
class Manifest {
 public:
  /// The manifest of a run that starts at this moment, on this machine, with this program.
  Manifest(const std::string& scene, const std::vector<std::string>& overrides,
           const std::string& key);
  /// Throws Error naming the file: missing, no JSON, no manifest.
  static Manifest read(const std::filesystem::path& file);

  /// Notes that the run goes on from `step`, with the present time, machine and program.
  void resumed(long step);

  /// Sets one entry of the summary; a name set before is overwritten in its place. NaN and infinity
  /// become null.
  void summary(const std::string& name, double value);
  void summary(const std::string& name, const std::string& value);

  std::string key() const;
  /// The commit of the program that began the run, 12 digits; "-dirty" follows where its sources
  /// were modified.
  std::string commit() const;
  /// Processor and number of cores; "unknown" where the manifest has none.
  std::string machine() const;
  std::string started() const;  ///< UTC, "2026-11-22T09:30:00Z"
  /// NaN when there is no such number.
  double summary_number(const std::string& name) const;
  std::map<std::string, double> summary_numbers() const;  ///< all numbers in the summary

  std::string text() const;
  /// Writes beside the target and renames. Throws Error.
  void write(const std::filesystem::path& file) const;

 private:
  explicit Manifest(const nlohmann::ordered_json& json);
  std::shared_ptr<nlohmann::ordered_json> json_;  // not shared; shared_ptr for its deleter
};

class RunFolder {
 public:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path scene() const { return path_ / "scene.toml"; }
  std::filesystem::path manifest() const { return path_ / "manifest.json"; }
  std::filesystem::path checkpoint() const { return path_ / "checkpoint.bin"; }
  std::filesystem::path capture() const { return path_ / "capture"; }
  /// Whole states kept at record.state_rate: checkpoint files of single steps.
  std::filesystem::path states() const { return path_ / "states"; }
  std::filesystem::path state_at(long step) const;
  /// Reads the checkpoint or one of the states. Throws Error, also for those of another run.
  Checkpoint read_state(const std::filesystem::path& file) const;
  /// The existing files in states(), in the order of time.
  std::vector<std::filesystem::path> state_files() const;
  std::filesystem::path steps_log() const { return path_ / "log" / "steps.bin"; }
  bool has_run() const { return path_exists(scene()); }
  /// Returns whether the folder holds the complete run of this key: all steps and closed records.
  bool is_finished(const std::string& key) const;

  /// Begins a run: writes manifest.json and scene.toml. Refuses a folder that holds a run, unless
  /// `overwrite`: then it removes the files of that run, by their names, and nothing else. Refuses
  /// a folder with files but without a run: they belong to somebody else, and are neither removed
  /// nor mixed with those of a run.
  void begin(const std::string& scene_text, const Manifest& manifest, bool overwrite) const;

 private:
  std::filesystem::path path_;
};

/// The entry of a manifest's summary for the steps still to be done. 0 is written last of all.
inline constexpr const char* steps_left_entry = "steps_left";

/// The system of a run's folder, rebuilt from its scene.toml, with the state of its latest
/// checkpoint. Throws Error, also where a mesh has changed since the run began.
MechanicalSystem system_of_run(const std::filesystem::path& folder, MotionState& state);

/// The same for display, not for stepping: bodies, walls and shapes come from record.h5 where it
/// exists, whatever has become of the scene's files. It says which wall is driven, but not how.
MechanicalSystem recorded_system(const std::filesystem::path& folder, MotionState& state);

}  // namespace ballast
