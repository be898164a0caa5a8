#include "experiments/run/run_folder.hpp"

#include <nlohmann/json.hpp>

#include "problems/scene/scene_file.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("a manifest says what a run was made by and from, and is read back") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "manifest.json";
  Manifest manifest("vibrated_box", {"solver.name=\"pgs\"", "friction=0.5"}, "0123456789abcdef");
  manifest.summary("ms_per_step", 41.25);
  manifest.summary("packing", "cache/packing.bin");
  manifest.summary("nothing", std::nan(""));
  manifest.resumed(120);
  manifest.summary("ms_per_step", 40.5);
  manifest.write(file);
  CHECK(file_bytes(file) == manifest.text());

  const auto json = nlohmann::json::parse(file_bytes(file));
  const auto& build = json["ballast"];
  const std::string version = build["version"], commit = build["commit"], flags = build["flags"];
  CHECK(std::count(version.begin(), version.end(), '.') == 2);
  CHECK((commit == "unknown" ||
         (commit.size() == 40 && commit.find_first_not_of("0123456789abcdef") == commit.npos)));
  CHECK_THAT(flags, Contains("-ffp-contract=off"));
  CHECK(build["libraries"].size() >= 5);
  for (const std::string number : build["libraries"])
    CHECK((!number.empty() && number.find_first_not_of("0123456789.") == number.npos));
  CHECK_THAT(build_line(), Contains(version) && Contains(commit.substr(0, 12)));
  CHECK(json["machine"]["cores"] >= 1);
  CHECK(json["scene"] == "vibrated_box");
  CHECK(json["overrides"][0] == "solver.name=\"pgs\"");
  CHECK(json["resumed"][0]["step"] == 120);
  CHECK(json["started"].get<std::string>().size() == 20);
  CHECK(json["summary"]["ms_per_step"] == 40.5);
  CHECK(json["summary"]["nothing"].is_null());

  const Manifest read = Manifest::read(file);
  CHECK(read.text() == manifest.text());
  CHECK(read.key() == "0123456789abcdef");
  CHECK(read.summary_number("ms_per_step") == 40.5);
  CHECK(std::isnan(read.summary_number("packing")));
  CHECK(std::isnan(read.summary_number("no such name")));
  // Text that is not UTF-8 does not break it.
  CHECK_NOTHROW(nlohmann::json::parse(Manifest("s\xff", {}, "k").text()));
}

TEST_CASE("a manifest that is none is refused with its name") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "manifest.json";
  const auto refusal = [&](const std::string& text) {
    put_bytes(file, text);
    return run_error([&] { Manifest::read(file); });
  };
  CHECK_THAT(run_error([&] { Manifest::read(file); }),
             Contains(file.string()) && Contains("cannot open"));
  CHECK_THAT(refusal("{\"scene\": "), Contains(file.string()) && Contains("is no JSON"));
  CHECK_THAT(refusal("[1, 2]"), Contains("is no manifest"));
  auto json = nlohmann::json::parse(Manifest("s", {}, "k").text());
  json["key"] = 5;
  CHECK_THAT(refusal(json.dump()), Contains("is no manifest") && Contains("'key'"));
  json["key"] = "k";
  json["ballast"]["commit"] = 5;
  CHECK_THAT(refusal(json.dump()), Contains("is no manifest") && Contains("'commit'"));
}

namespace {

void begin(const RunFolder& folder, const std::string& scene, bool overwrite = false) {
  folder.begin(scene, Manifest("scene", {}, "key"), overwrite);
}

}  // namespace

TEST_CASE("a fresh run refuses a folder with a run, overwriting clears what a run writes alone") {
  const TemporaryFolder place;
  const RunFolder folder(place.path() / "new" / "run");
  CHECK_FALSE(folder.has_run());
  begin(folder, "scene 1");
  CHECK(folder.has_run());
  CHECK(read_whole_file(folder.scene()) == "scene 1");
  CHECK_THAT(run_error([&] { begin(folder, "scene 2"); }),
             Contains("holds a run already: --continue goes on with it, --overwrite replaces it"));
  const std::vector<fs::path> written{"log/steps.bin",
                                      "log/poses.bin",
                                      "checkpoint.bin",
                                      "figures/cost.svg",
                                      "states/step_00000050.bin",
                                      "capture/step_0000050.hdf5"};
  const std::vector<fs::path> users{"notes.txt",         "log/mine.bin",
                                    "figures/mine.svg",  "figures/mine.gnuplot",
                                    "states/picked.bin", "states/step_00000050_mine.bin"};
  for (const auto& files : {written, users})
    for (const fs::path& file : files) {
      fs::create_directories((folder.path() / file).parent_path());
      put_bytes(folder.path() / file, "the user's own");
    }
  put_bytes(folder.path() / "figures/cost.gnuplot", "# cost: gnuplot cost.gnuplot > cost.svg\n");
  begin(folder, "scene 2", true);
  CHECK(read_whole_file(folder.scene()) == "scene 2");
  for (const fs::path& file : written) CHECK_FALSE(fs::exists(folder.path() / file));
  CHECK_FALSE(fs::exists(folder.path() / "figures/cost.gnuplot"));
  for (const fs::path& file : users) CHECK(file_bytes(folder.path() / file) == "the user's own");
  CHECK_FALSE(fs::exists(folder.path() / "capture"));  // it had no other files
}

TEST_CASE("a folder with somebody's files is neither emptied nor mixed into") {
  const TemporaryFolder place;
  const RunFolder folder(place.path());
  // A scene.toml, a manifest.json and figures need not be a run's.
  for (const char* name : {"scene.toml", "manifest.json", "steps.csv", "notes.txt"}) {
    INFO(name);
    put_bytes(folder.path() / name, "the user's own");
    for (const bool overwrite : {false, true})
      CHECK_THAT(run_error([&] { begin(folder, "scene", overwrite); }),
                 Contains("holds files that are no run's"));
    CHECK(file_bytes(folder.path() / name) == "the user's own");
    CHECK(std::distance(fs::directory_iterator(place.path()), fs::directory_iterator()) == 1);
    fs::remove(folder.path() / name);
  }
  // The remains of a run that was killed at once do not matter.
  put_bytes(folder.path() / "run.lock", "process 1 on host");
  Manifest("scene", {}, "key").write(folder.manifest());
  begin(folder, "scene");
  CHECK(folder.has_run());
}

TEST_CASE("finished: all files, this key, and no steps left") {
  const TemporaryFolder place;
  const RunFolder folder(place.path());
  const auto put_manifest = [&](const std::string& key, double left) {
    Manifest manifest("scene", {}, key);
    manifest.summary(steps_left_entry, left);
    manifest.write(folder.manifest());
  };
  put_manifest("key", 0);
  put_bytes(folder.path() / "steps.csv", "");
  CHECK_FALSE(folder.is_finished("key"));
  put_bytes(folder.path() / "record.h5", "");
  CHECK(folder.is_finished("key"));
  CHECK_FALSE(folder.is_finished("other"));
  put_manifest("key", 3);
  CHECK_FALSE(folder.is_finished("key"));
  Manifest("scene", {}, "key").write(folder.manifest());  // does not tell the number of steps
  CHECK_FALSE(folder.is_finished("key"));
}

TEST_CASE("the system of a folder without a run, or without a state, is an error that says so") {
  const TemporaryFolder place;
  MotionState state;
  const auto begun = [&](const char* scene) {
    begin(RunFolder(place.path()), resolve_scene(find_scene(scene)).text, true);
  };
  CHECK_THAT(run_error([&] { system_of_run(place.path(), state); }), Contains("no run here"));
  begun("vibrated_box_small");
  CHECK_THAT(run_error([&] { system_of_run(place.path(), state); }),
             Contains("checkpoint.bin: missing: the run has no state yet"));
  begun("incline");
  CHECK(system_of_run(place.path(), state).grain_count == 1);
  CHECK(state.step == 0);
}

TEST_CASE("a state of another run is refused") {
  const TemporaryFolder place;
  const RunFolder folder(place.path());
  begin(folder, resolve_scene(find_scene("incline")).text);
  MotionState state;
  system_of_run(place.path(), state);
  const auto put_state = [&](const char* key) {
    write_checkpoint(folder.checkpoint(), {key, "drive", state, {}, {}});
  };
  put_state("key");
  CHECK_NOTHROW(system_of_run(place.path(), state));
  put_state("other");
  CHECK_THAT(run_error([&] { system_of_run(place.path(), state); }),
             Contains("checkpoint.bin: belongs to another run"));
}
