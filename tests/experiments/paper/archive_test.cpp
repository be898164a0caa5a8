// The campaign as a dataset: its content, its checksums, and that a reader can draw its curve.

#include "experiments/paper/sections.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// The archive of the published rows, in the folder `output`.
fs::path archive_in(const fs::path& output) {
  PaperData data(read_campaign({}), output / "no_runs",
                 read_runs_csv(BALLAST_SOURCE_FOLDER "/docs/measured/campaign_runs.csv"));
  return write_archive(data, {.packings = output / "packings", .output = output});
}

}  // namespace

TEST_CASE("the archive unpacks to files that agree with their checksums, twice the same bytes") {
  const TemporaryFolder one, other, unpacked;
  const fs::path packed = archive_in(one.path());
  CHECK(read_whole_file(packed) == read_whole_file(archive_in(other.path())));
  REQUIRE(run_program("tar", {"-xzf", packed.string(), "-C", unpacked.path().string()}, 60.0)
              .succeeded());
  const fs::path folder = unpacked.path() / "ballast-paper";
  for (const char* name :
       {"README.md", "CITATION.cff", "LICENSE", "campaign.toml", "columns.csv", "packings.csv",
        "curve.py", "scenes/vibrated_box.toml", "scenes/vibrated_box_paper.toml"})
    CHECK_FALSE(read_whole_file(folder / name).empty());
  const std::string check = "cd '" + folder.string() + "' && sha256sum --strict -c SHA256SUMS";
  CHECK(run_program("/bin/sh", {"-c", check}, 60.0).succeeded());
  write_whole_file(folder / "curve.py", "another");
  CHECK_FALSE(run_program("/bin/sh", {"-c", check}, 60.0).succeeded());
  // A report can read its rows.
  CHECK(read_runs_csv(folder / "runs.csv").size() >= 251);
}

TEST_CASE("a packing that is there has its checksum in the archive") {
  const TemporaryFolder folder;
  PaperData data(read_campaign({.only = "motion-*"}), folder.path() / "no_runs");
  const std::string key = data.campaign().front().packing;
  fs::create_directories(folder.path() / "packings");
  write_whole_file(folder.path() / "packings" / ("packing-" + key + ".bin"), "abc");
  write_archive(data, {.packings = folder.path() / "packings", .output = folder.path()});
  const std::string table = read_whole_file(folder.path() / "ballast-paper" / "packings.csv");
  // The checksum is from FIPS 180-2, appendix B.1.
  CHECK_THAT(table,
             Catch::Contains("vibrated_box,1,1,ba7816bf8f01cfea414140de5dae2223b00361a396177a"
                             "9cb410ff61f20015ad"));
  CHECK_THAT(table, Catch::Contains("vibrated_box,2,1,\n"));
}

TEST_CASE("an archive that cannot be packed is one error that names it") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "ballast-paper.tar.gz.tmp");
  CHECK_THROWS_WITH(archive_in(folder.path()),
                    Catch::StartsWith((folder.path() / "ballast-paper.tar.gz: tar: ").string()));
}

TEST_CASE("the archive's reader draws the main figure") {
  const TemporaryFolder folder;
  archive_in(folder.path());
  const fs::path picture = folder.path() / "curve.png";
  if (!run_program("/usr/bin/python3", {"-c", "import matplotlib"}, 60.0).succeeded()) {
    WARN("skipped: python3-matplotlib is not there");
    return;
  }
  const ProgramResult drawn = run_program(
      "/usr/bin/python3",
      {(folder.path() / "ballast-paper" / "curve.py").string(), picture.string()}, 120.0);
  INFO(drawn.errors);
  REQUIRE(drawn.succeeded());
  CHECK(read_whole_file(picture).starts_with("\x89PNG"));
}

TEST_CASE("a folder that is somebody's own is not written into") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "ballast-paper");
  write_whole_file(folder.path() / "ballast-paper" / "letter.txt", "mine");
  CHECK_THROWS_AS(archive_in(folder.path()), Error);
  CHECK(read_whole_file(folder.path() / "ballast-paper" / "letter.txt") == "mine");
}

TEST_CASE("a plan whose scene is a file is run again from its archive, in a folder of any name") {
  const TemporaryFolder folder;
  const fs::path output = folder.path() / "a:b\\c", plan = folder.path() / "plan" / "mine.toml";
  fs::create_directories(plan.parent_path() / "boxes");
  const auto key_of_archived = [&](const std::string& scene) {
    fs::copy_file(find_scene("vibrated_box_small"), plan.parent_path() / scene);
    write_whole_file(plan, "scene = \"" + scene + "\"\n[[run]]\nname = \"one\"\n");
    PaperData data(read_campaign({.plan = plan}), folder.path() / "no_runs");
    write_archive(data, {.plan = plan, .packings = folder.path(), .output = output});
    return data.campaign().front().key;
  };
  const std::string key = key_of_archived("boxes/small.toml");
  const fs::path made = output / "ballast-paper";
  CHECK(read_campaign({.plan = made / "campaign.toml"}).front().key == key);
  CHECK(read_whole_file(made / "SHA256SUMS").find('\\') == std::string::npos);
  for (const char* scene : {"../small.toml", "campaign.toml"})
    CHECK_THROWS_WITH(key_of_archived(scene), Catch::Contains("below the plan's folder"));
}
