#pragma once
// manifest.json: what a run was made by and from, and what came out, as JSON.
//
//   {"ballast":  {"version", "commit", "modified", "compiler", "build_type", "flags",
//                 "libraries": {name: version}},
//    "machine":  {"cpu", "cores", "memory_GB", "load_average": [1, 5, 15 min],
//                 "environment": {name: value}},
//    "scene": name, "overrides": ["dotted.key=value"], "started": UTC,
//    "key": scene_key() of the resolved scene,
//    "resumed":  [{"step", "at": UTC, "commit", "modified", "cpu"}],
//    "summary":  {name: number or text}}
//
// Times of day and the machine are here and nowhere else, so that records of equal runs are equal.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace ballast {

/// The processor as the kernel names it; "unknown" where it doesn't (other architectures).
std::string cpu_model();

class Manifest {
 public:
  /// Of a run that starts now, on this machine, with this program.
  Manifest(const std::string& scene, const std::vector<std::string>& overrides,
           const std::string& key);
  /// Of a run's folder. Throws Error naming the file: missing, no JSON, no manifest.
  static Manifest read(const std::filesystem::path& file);

  ~Manifest();
  Manifest(Manifest&&) noexcept;
  Manifest& operator=(Manifest&&) noexcept;

  /// Notes that the run goes on from `step`, now, here, with this program.
  void resumed(long step);

  /// Sets one entry of the summary; a name set before is overwritten in its place. NaN and infinity
  /// become null.
  void summary(const std::string& name, double value);
  void summary(const std::string& name, const std::string& value);

  std::string key() const;
  /// Of the program that began the run; "-dirty" when it was not quite that.
  std::string commit() const;
  /// Processor and number of cores; "unknown" where it is not told.
  std::string machine() const;
  std::string started() const;  ///< UTC, "2026-11-22T09:30:00Z"
  /// NaN when there is no such number.
  double summary_number(const std::string& name) const;

  std::string text() const;
  /// Writes beside and renames. Throws Error.
  void write(const std::filesystem::path& file) const;

 private:
  explicit Manifest(nlohmann::ordered_json json);
  std::unique_ptr<nlohmann::ordered_json> json_;
};

}  // namespace ballast
