// run.sh, interrupted and started again.

#include "platform/atomic_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Makes a tree with all that run.sh needs and nothing to build. Its vibrated_box has few grains.
void make_tree(const fs::path& root) {
  for (const char* folder : {"scripts", "build/default/bin", "scenes"})
    create_folder(root / folder);
  fs::copy_file(BALLAST_SOURCE_FOLDER "/run.sh", root / "run.sh");
  write_whole_file(root / "scripts" / "setup.sh", "ballast_setup() { cd \"$root\"; }\n");
  fs::create_symlink(BALLAST_PROGRAM, root / "build/default/bin/ballast");
  fs::copy_file(BALLAST_SOURCE_FOLDER "/problems/scenes/vibrated_box_small.toml",
                root / "scenes" / "vibrated_box.toml");
}

/// Runs run.sh there with these arguments. A signal stops it as soon as `file` exists.
ProgramResult run_sh(const fs::path& root, const std::vector<std::string>& arguments,
                     const std::string& file = "") {
  std::string words =
      "cd '" + root.string() + "'; export BALLAST_SCENES='" + (root / "scenes").string() + "'; ";
  // The child of a shell in the background ignores SIGINT. SIGTERM has the same effect.
  words += file.empty() ? "exec \"$@\""
                        : "\"$@\" & until ls " + file +
                              " >/dev/null 2>&1; do sleep 0.01; done; kill -TERM $!; wait $!";
  std::vector<std::string> all{"-c", words, "sh", (root / "run.sh").string(), "--no-install"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return run_program("/bin/sh", all, 300.0);
}

}  // namespace

TEST_CASE("run.sh goes on after an interrupt, in the deposit too") {
  const TemporaryFolder folder;
  const fs::path& root = folder.path();
  make_tree(root);
  const std::vector<std::string> arguments{
      "vibrated_box",   "--set", "grains.count=12",    "--set", "box.length=0.12", "--set",
      "box.width=0.12", "--set", "scene.duration=0.05"};
  // Stops it in the deposit, before the run has any checkpoint.
  const ProgramResult stopped = run_sh(root, arguments, "results/packings/*.lock");
  INFO(stopped.output << stopped.errors);
  CHECK(stopped.status == 1);
  CHECK(fs::exists(root / "results/vibrated_box/scene.toml"));
  CHECK_FALSE(fs::exists(root / "results/vibrated_box/checkpoint.bin"));
  const ProgramResult finished = run_sh(root, arguments);
  INFO(finished.output << finished.errors);
  CHECK(finished.status == 0);
  CHECK(fs::exists(root / "results/vibrated_box/report.html"));
  const ProgramResult again = run_sh(root, arguments);
  CHECK(again.status == 0);
  CHECK_THAT(again.output, Catch::Contains("finished already"));
}
