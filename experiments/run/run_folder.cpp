#include "experiments/run/run_folder.hpp"

#include <fnmatch.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <string_view>
#include <thread>

#include <nlohmann/json.hpp>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/record/recorder.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {

namespace fs = std::filesystem;

const char* build_text();  // made by build_info.cmake

namespace {

using Json = nlohmann::ordered_json;

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

/// The program: version, commit, compiler, libraries.
Json build_json() { return Json::parse(build_text()); }

/// The computer, and how busy it was when the run began.
Json machine_json() {
  Json json = {{"cpu", cpu_model()}, {"cores", std::thread::hardware_concurrency()}};
  const double memory = 1.0 * sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGE_SIZE);
  json["memory_GB"] = std::round(memory / 1e8) / 10.0;
  double load[3] = {0.0, 0.0, 0.0};
  const bool is_known = getloadavg(load, 3) == 3;
  for (double& one : load) one = std::round(100.0 * one) / 100.0;
  json["load_average"] = is_known ? Json(load) : Json(nullptr);
  // variables that change the time or the bits of a threaded BLAS
  json["environment"] = Json::object();
  for (const char* name : {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"})
    if (const char* value = std::getenv(name)) json["environment"][name] = value;
  return json;
}

/// The files of a run: folders of its own, and the files in them as patterns; +(): one or more.
constexpr std::pair<const char*, const char*> run_files[] = {{"log", "steps.bin"},
                                                             {"log", "poses.bin"},
                                                             {"log", "forces.bin"},
                                                             {"capture", "step_+([0-9]).hdf5"},
                                                             {"states", "step_+([0-9]).bin"},
                                                             {"", "checkpoint.bin"},
                                                             {"", "steps.csv"},
                                                             {"", "record.h5"},
                                                             {"", "report.html"},
                                                             {"", "scene.toml"},
                                                             {"", "manifest.json"}};

/// Files that may be in a folder before its run has begun: a run killed early leaves them.
constexpr std::string_view beginnings[] = {"run.lock", "manifest.json", "manifest.json.tmp",
                                           "scene.toml.tmp"};

bool is_manifest(const fs::path& file) {
  try {
    Manifest::read(file);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// Removes the files that a run has written, by their names, and folders that are then empty.
void clear(const fs::path& run) {
  std::error_code none;
  // The page's figures: our scripts, known by their first line, and the pictures made from them.
  std::vector<fs::path> scripts;
  for (const fs::directory_entry& entry : fs::directory_iterator(run / "figures", none))
    if (entry.path().extension() == ".gnuplot" && entry.is_regular_file(none))
      scripts.push_back(entry.path());
  for (fs::path& script : scripts) {
    const std::string name = script.stem().string();
    if (!read_whole_file(script).starts_with("# " + name + ": gnuplot ")) continue;
    fs::remove(script);
    fs::remove(script.replace_extension(".svg"));
  }
  if (!scripts.empty()) fs::remove(run / "figures", none);  // only where it is empty
  for (const auto& [own, pattern] : run_files) {
    const fs::path folder = run / own;
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
      if (fnmatch(pattern, entry.path().filename().c_str(), FNM_EXTMATCH) == 0)
        found.push_back(entry.path());
    for (const fs::path& path : found) fs::remove(path);
    if (*own && !found.empty()) fs::remove(folder, none);
  }
}

}  // namespace

std::string build_line() {
  const Json build = build_json();
  const auto word = [&](const char* name) { return build.at(name).get<std::string>(); };
  return "ballast " + word("version") + " (" + word("commit").substr(0, 12) +
         (build.at("modified").get<bool>() ? ", modified" : "") + "), " + word("compiler") + ", " +
         word("build_type");
}

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(':');
    if (line.starts_with("model name") && colon + 2 < line.size()) return line.substr(colon + 2);
  }
  return "unknown";
}

Manifest::Manifest(const std::string& scene, const std::vector<std::string>& overrides,
                   const std::string& key)
    : Manifest(Json{{"ballast", build_json()},
                    {"machine", machine_json()},
                    {"scene", scene},
                    {"overrides", Json(overrides)},
                    {"key", key},
                    {"started", utc_now()},
                    {"resumed", Json::array()},
                    {"summary", Json::object()}}) {}

Manifest::Manifest(const Json& json) : json_(std::make_shared<Json>(json)) {}

Manifest Manifest::read(const fs::path& file) {
  Json json;
  try {
    json = Json::parse(read_whole_file(file));
  } catch (const Json::parse_error& error) {
    throw Error(file.string() + ": is no JSON: it cannot be read on from byte " +
                std::to_string(error.byte));
  }
  // Only the entries that are read below are checked: later programs may note more.
  const auto has = [&](const Json& in, const char* name, Json::value_t type) {
    if (!in.is_object() || !in.contains(name) || in[name].type() != type)
      throw Error(file.string() + ": is no manifest of a run: '" + name +
                  "' is missing or of the wrong type");
  };
  for (const char* name : {"ballast", "machine", "summary"}) has(json, name, Json::value_t::object);
  for (const char* name : {"scene", "key", "started"}) has(json, name, Json::value_t::string);
  for (const char* name : {"overrides", "resumed"}) has(json, name, Json::value_t::array);
  has(json["ballast"], "commit", Json::value_t::string);
  has(json["ballast"], "modified", Json::value_t::boolean);
  return Manifest(json);
}

void Manifest::resumed(long step) {
  const Json build = build_json();
  (*json_)["resumed"].push_back(Json{{"step", step},
                                     {"at", utc_now()},
                                     {"commit", build.at("commit")},
                                     {"modified", build.at("modified")},
                                     {"cpu", cpu_model()}});
}

void Manifest::summary(const std::string& name, double value) {
  (*json_)["summary"][name] = std::isfinite(value) ? Json(value) : Json(nullptr);
}

void Manifest::summary(const std::string& name, const std::string& value) {
  (*json_)["summary"][name] = value;
}

std::string Manifest::key() const { return json_->at("key").get<std::string>(); }

std::string Manifest::commit() const {
  const Json& ballast = json_->at("ballast");
  return ballast["commit"].get<std::string>().substr(0, 12) +
         (ballast["modified"].get<bool>() ? "-dirty" : "");
}

std::string Manifest::machine() const {
  const Json& machine = json_->at("machine");
  if (!machine.contains("cpu") || !machine["cpu"].is_string()) return "unknown";
  std::string text = machine["cpu"].get<std::string>();
  if (machine.contains("cores")) text += ", " + machine["cores"].dump() + " cores";
  return one_line(text, ' ');
}

std::string Manifest::started() const { return json_->at("started").get<std::string>(); }

double Manifest::summary_number(const std::string& name) const {
  const std::map<std::string, double> numbers = summary_numbers();
  const auto found = numbers.find(name);
  return found == numbers.end() ? std::nan("") : found->second;
}

std::map<std::string, double> Manifest::summary_numbers() const {
  std::map<std::string, double> numbers;
  for (const auto& [name, value] : json_->at("summary").items())
    if (value.is_number()) numbers[name] = value.get<double>();
  return numbers;
}

/// Names from a command line may not be UTF-8: invalid bytes are replaced, not refused.
std::string Manifest::text() const {
  return json_->dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void Manifest::write(const fs::path& file) const { write_whole_file(file, text()); }

bool RunFolder::is_finished(const std::string& key) const {
  for (const fs::path& file : {manifest(), path_ / "steps.csv", path_ / "record.h5"})
    if (!path_exists(file)) return false;
  const Manifest found = Manifest::read(manifest());
  return found.key() == key && found.summary_number(steps_left_entry) == 0.0;
}

void RunFolder::begin(const std::string& scene_text, const Manifest& manifest,
                      bool overwrite) const {
  create_folder(path_);
  const bool has_others = std::ranges::any_of(fs::directory_iterator(path_), [](const auto& entry) {
    return std::ranges::find(beginnings, entry.path().filename()) == std::end(beginnings);
  });
  const bool is_new =
      !has_others && (!path_exists(this->manifest()) || is_manifest(this->manifest()));
  if (!is_new && !(has_run() && is_manifest(this->manifest())))
    throw Error(path_.string() +
                ": holds files that are no run's: give a folder that is new or empty");
  if (!is_new && !overwrite)
    throw Error(path_.string() +
                ": holds a run already: --continue goes on with it, --overwrite replaces it");
  clear(path_);
  // The manifest is written first: a scene.toml without one could be anybody's.
  manifest.write(this->manifest());
  write_whole_file(scene(), scene_text);
}

fs::path RunFolder::state_at(long step) const { return states() / printed("step_%08ld.bin", step); }

Checkpoint RunFolder::read_state(const fs::path& file) const {
  Checkpoint found = read_checkpoint(file);
  if (found.key != Manifest::read(manifest()).key())
    throw Error(file.string() + ": belongs to another run");
  return found;
}

std::vector<fs::path> RunFolder::state_files() const {
  std::vector<fs::path> files;
  if (!is_folder(states())) return files;
  for (const auto& entry : fs::directory_iterator(states()))
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

MechanicalSystem system_of_run(const fs::path& path, MotionState& state) {
  const RunFolder folder(path);
  if (!folder.has_run()) throw Error(path.string() + ": no run here: scene.toml is missing");
  const Scene scene = read_scene(folder.scene());
  MechanicalSystem system = scene.grains ? MechanicalSystem{} : make_system(scene, state);
  if (path_exists(folder.checkpoint()))
    state = folder.read_state(folder.checkpoint()).state;
  else if (scene.grains)
    throw Error(folder.checkpoint().string() + ": missing: the run has no state yet");
  if (scene.grains) {
    // the lid stands where the packing has put it; it does not move in a drive
    const Rain rain = make_rain(scene);
    system = box_system(scene, rain, BoxStage::drive,
                        state.pose[rain.grains.size() + wall_lid].position.z());
  }
  require_same_bodies(path, system);
  return system;
}

MechanicalSystem recorded_system(const fs::path& path, MotionState& state) {
  const RunFolder folder(path);
  const fs::path record = path / "record.h5";
  if (!folder.has_run() || !path_exists(record)) return system_of_run(path, state);
  MechanicalSystem system = read_record_system(record);
  system.friction = scene_friction(folder.scene());
  if (path_exists(folder.checkpoint())) state = folder.read_state(folder.checkpoint()).state;
  return system;
}

}  // namespace ballast
