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

TEST_CASE("a fresh run refuses a folder with a run; overwriting clears what a run writes alone") {
  const TemporaryFolder place;
  const RunFolder folder(place.path() / "new" / "run");
  CHECK_FALSE(folder.has_run());
  folder.begin("scene 1", false);
  CHECK(folder.has_run());
  CHECK(read_whole_file(folder.scene()) == "scene 1");
  CHECK_THAT(run_error([&] { folder.begin("scene 2", false); }),
             Contains("holds a run already: --resume continues it, --overwrite replaces it"));
  fs::create_directories(folder.path() / "log");
  put_bytes(folder.checkpoint(), "old");
  put_bytes(folder.path() / "notes.txt", "the user's own");
  folder.begin("scene 2", true);
  CHECK(read_whole_file(folder.scene()) == "scene 2");
  CHECK_FALSE(fs::exists(folder.checkpoint()));
  CHECK_FALSE(fs::exists(folder.path() / "log"));
  CHECK(file_bytes(folder.path() / "notes.txt") == "the user's own");
}

TEST_CASE("a run is gone on with where there is one of the same settings") {
  const TemporaryFolder place;
  const RunFolder folder(place.path());
  CHECK_THAT(run_error([&] { folder.reopen("scene"); }), Contains("no run to resume"));
  folder.begin("scene", false);
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
