#include "experiments/run/run_folder.hpp"

#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("a run's folder is the one that was asked for, else results/<scene>") {
  CHECK(RunFolder::of("there", "box").path() == "there");
  CHECK(RunFolder::of("", "box").path() == fs::path("results/box"));
  const RunFolder folder("f");
  CHECK(folder.checkpoint() == fs::path("f/checkpoint.bin"));
  CHECK(folder.state_at(1234) == fs::path("f/states/step_00001234.bin"));
  CHECK(folder.steps_log() == fs::path("f/log/steps.bin"));
}

namespace {

void begin(const RunFolder& folder, const std::string& scene, bool overwrite = false) {
  folder.begin(scene, Manifest("scene", {}, "key"), overwrite);
}

}  // namespace

TEST_CASE("a fresh run refuses a folder with a run; overwriting clears what a run writes alone") {
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
  const std::vector<fs::path> users{"notes.txt", "log/mine.bin", "figures/mine.svg",
                                    "figures/mine.gnuplot", "states/picked.bin"};
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
  CHECK_FALSE(fs::exists(folder.path() / "capture"));  // it had nothing else in it
}

TEST_CASE("a folder with somebody's files is neither emptied nor mixed into") {
  const TemporaryFolder place;
  const RunFolder folder(place.path());
  // a scene.toml, a manifest.json and figures can be anybody's
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
  // what a run that was killed at once leaves is in nobody's way
  put_bytes(folder.path() / "run.lock", "process 1 on host");
  Manifest("scene", {}, "key").write(folder.manifest());
  begin(folder, "scene");
  CHECK(folder.has_run());
}

TEST_CASE("a run is gone on with where there is one of the same settings") {
  const TemporaryFolder place;
  const RunFolder folder(place.path());
  CHECK_THAT(run_error([&] { folder.reopen("scene"); }), Contains("no run to resume"));
  begin(folder, "scene");
  folder.reopen("scene");
  CHECK_THAT(run_error([&] { folder.reopen("another scene"); }),
             Contains("holds a run of other settings"));
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
  Manifest("scene", {}, "key").write(folder.manifest());  // says nothing of steps
  CHECK_FALSE(folder.is_finished("key"));
}
