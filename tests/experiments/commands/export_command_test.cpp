// Exports of runs are made from the record, whatever happened to the scene's files.

#include "experiments/record/checkpoint.hpp"
#include "geometry/shape/polyhedron.hpp"
#include "platform/atomic_file.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/problem_folder.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

const std::string mesh_scene =
    "[scene]\nstep = 1e-3\nduration = 0.05\n[record]\npose_rate = 100\n[[wall]]\nnormal = [0, 0, "
    "1]\n"
    "[[body]]\nshape = \"mesh\"\nfile = \"grain.obj\"\nmass = 1\nposition = [0, 0, 0.5]\n";

ProgramResult exported(const fs::path& run, const fs::path& output,
                       std::vector<std::string> more = {}) {
  std::vector<std::string> words{"export", run.string(), "--output", output.string()};
  words.insert(words.end(), more.begin(), more.end());
  return ballast_program(words);
}

}  // namespace

TEST_CASE("an export has the shapes of the run, also when the mesh is another one by now") {
  const TemporaryFolder folder;
  const fs::path mesh = folder.path() / "grain.obj", before = folder.path() / "before.obj",
                 after = folder.path() / "after.obj", run = folder.path() / "run";
  write_mesh(mesh, make_box(Vec3(1, 1, 1)));
  const std::string scene = folder.write("scene.toml", mesh_scene).string();
  REQUIRE(ballast_program({"run", scene, "--output", run.string(), "--no-report"}).status == 0);
  REQUIRE(exported(run, before).status == 0);
  write_mesh(mesh, make_box(Vec3(1, 2, 1)));
  CHECK(exported(run, after).status == 0);
  CHECK(read_whole_file(after) == read_whole_file(before));
  fs::remove(mesh);
  CHECK(exported(run, after).status == 0);
  CHECK(read_whole_file(after) == read_whole_file(before));

  // Without the record the export would use the new mesh, and is refused.
  write_mesh(mesh, make_box(Vec3(1, 2, 1)));
  fs::remove(run / "record.h5");
  check_failure(exported(run, after), ExitCode::failure, {"another system of bodies"});
}

TEST_CASE("export takes its format from the suffix, one time, or all") {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run";
  REQUIRE(ballast_program({"run", "incline", "--set", "record.forces=true", "--set",
                           "record.state_rate=10", "--output", run.string(), "--no-report"})
              .status == 0);
  CHECK_THAT(read_whole_file(run / "scene.toml"), Catch::Contains("forces = true"));
  CHECK(exported(run, folder.path() / "a.vtp").status == 0);
  CHECK_THAT(read_whole_file(folder.path() / "a.vtp"), Catch::Contains("<VTKFile"));
  check_failure(exported(run, folder.path() / "a.xyz"), ExitCode::failure, {"a.xyz", "no format"});
  for (const char* time : {"nan", "inf", "soon", "1e400"})
    check_failure(exported(run, folder.path() / "a.obj", {"--time", time}), ExitCode::usage,
                  {"--time", time});
  const ProgramResult at = exported(run, folder.path() / "a.obj", {"--time", "0.2"}),
                      kept =
                          exported(run / "states" / "step_00000200.bin", folder.path() / "a.obj");
  for (const ProgramResult& said : {at, kept})
    CHECK_THAT(said.output, Catch::Contains("state at 0.2 s, step 200"));
  // A run's folder may have the name of that of states.
  const fs::path named = folder.path() / "states";
  fs::copy(run, named, fs::copy_options::recursive);
  CHECK(exported(named / "checkpoint.bin", folder.path() / "b.obj").status == 0);
  const fs::path stray = run / "states" / "step_00000100.bin";
  Checkpoint other = read_checkpoint(stray);
  other.key = "other";
  write_checkpoint(stray, other);
  check_failure(exported(stray, folder.path() / "a.obj"), ExitCode::failure,
                {"step_00000100.bin: belongs to another run"});
  const fs::path series = folder.path() / "all" / "block.vtp";
  const ProgramResult all = exported(run, series, {"--all"});
  CHECK(all.status == 0);
  for (const char* name : {"block_00000000.vtp", "block_00000500.vtp", "block.pvd",
                           "block_contacts_00000500.vtp", "block_contacts.pvd"})
    CHECK(fs::exists(folder.path() / "all" / name));
  CHECK(exported(run, folder.path() / "b.vtp", {"--time", "0.5"}).status == 0);
  CHECK(read_whole_file(folder.path() / "all" / "block_00000500.vtp") ==
        read_whole_file(folder.path() / "b.vtp"));
  CHECK(exported(run, folder.path() / "all" / "state.obj", {"--all"}).status == 0);
  CHECK(fs::exists(folder.path() / "all" / "state_00000500.obj"));
  CHECK_FALSE(fs::exists(folder.path() / "all" / "state.pvd"));
}

TEST_CASE("a picture of a frame, and a page that shows a thing") {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run", picture = folder.path() / "box.png";
  REQUIRE(ballast_program({"run", "incline", "--set", "scene.duration=0.02", "--output",
                           run.string(), "--no-report"})
              .status == 0);
  CHECK(exported(run, picture, {"--frames", "1", "--view", "x", "--width", "64"}).status == 0);
  CHECK(read_whole_file(picture).starts_with("\x89PNG"));
  CHECK(exported(run, picture, {"--frames", "0:2", "--width", "64"}).status == 0);
  CHECK_THAT(read_whole_file(picture), Catch::Contains("acTL"));
  check_failure(exported(run, picture, {"--frames", "2:99"}), ExitCode::failure, {"--frames 2:99"});
  check_failure(exported(run, picture, {"--frames", "2:1"}), ExitCode::usage, {"FIRST:LAST"});
  // Each option is obeyed or refused.
  const fs::path mesh = folder.path() / "box.obj";
  CHECK_THAT(exported(run, mesh, {"--frames", "1"}).output, Catch::Contains("at 0.01 s, step 10"));
  check_failure(exported(run, mesh, {"--frames", "1:2"}), ExitCode::usage,
                {"box.obj: --frames FIRST:LAST"});
  check_failure(exported(run, mesh, {"--frames", "99"}), ExitCode::failure, {"--frames 99"});
  for (const char* word : {"--view=x", "--chains", "--width=64"})
    check_failure(exported(run, mesh, {word}), ExitCode::usage, {"box.obj: --view, --chains"});
  for (const char* other : {"--time=0.01", "--all"})
    check_failure(exported(run, picture, {"--frames", "1", other}), ExitCode::usage, {"--frames"});
  CHECK(exported(run, folder.path() / "all" / "box.png", {"--all", "--width", "64"}).status == 0);
  CHECK(fs::exists(folder.path() / "all" / "box_00000010.png"));
  check_failure(exported(run / "checkpoint.bin", picture), ExitCode::failure, {"one state"});
  check_failure(exported(run, picture, {"--view", "up"}), ExitCode::usage, {"--view", "up"});
  check_failure(exported(run, picture, {"--chains"}), ExitCode::failure, {"record.forces"});
  const ProgramResult view = ballast_program({"view", run.string()});
  CHECK(view.output == (run / "view.html").string() + "\n");
  CHECK_THAT(read_whole_file(run / "view.html"), Catch::Contains("id=\"replay-head\""));
  const fs::path scene = folder.path() / "scene.html";
  CHECK(ballast_program({"view", "cradle", "--output", scene.string()}).status == 0);
  CHECK(fs::exists(scene));
  check_failure(ballast_program({"view", "nothing_of_that_name"}), ExitCode::failure,
                {"nothing_of_that_name"});
}

TEST_CASE("a view refuses options of another kind of thing") {
  const ProblemFolder c;
  const std::string problem = c.in / "a.hdf5";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--solver", "pgs"}, {"--iterations", "10"}, {"--warm"}}) {
    std::vector<std::string> all = {"view", "cradle"};
    all.insert(all.end(), words.begin(), words.end());
    check_failure(ballast_program(all), ExitCode::usage,
                  {"cradle: --solver, --iterations and --warm go with a captured problem alone"});
  }
  check_failure(ballast_program({"view", problem, "--set", "scene.step=1"}), ExitCode::usage,
                {"a.hdf5: --set goes with a scene alone"});
}

TEST_CASE("a view is not written over what it shows, and says what is no problem") {
  const ProblemFolder c;
  const fs::path problem = c.in / "a.hdf5", mesh = c.folder.path() / "box.obj",
                 scene = c.folder.write("mine.toml", mesh_scene);
  write_mesh(mesh, make_box(Vec3(1, 1, 1)));
  for (const fs::path& thing : {problem, mesh, scene}) {
    const std::string before = read_whole_file(thing);
    check_failure(ballast_program({"view", thing.string(), "--output", thing.string()}),
                  ExitCode::failure,
                  {thing.string() + ": is no page (.html): it would be written over"});
    CHECK(read_whole_file(thing) == before);
  }
  check_failure(ballast_program({"view", problem.string()}), ExitCode::failure,
                {"does not say where its contacts are"});
  fs::resize_file(problem, fs::file_size(problem) / 2);
  check_failure(ballast_program({"view", problem.string()}), ExitCode::failure,
                {"a.hdf5: damaged or truncated"});
}
