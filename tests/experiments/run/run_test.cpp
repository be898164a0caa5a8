// Whole runs give the same bits twice, after a stop and after kill -9; a folder loses no run.

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "experiments/run/run.hpp"
#include "platform/clock.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

RunOptions small_run(const fs::path& output, const fs::path& packings) {
  RunOptions options;
  options.scene = "vibrated_box_small";
  options.overrides = {"scene.duration=0.04", "record.checkpoint_seconds=0.05",
                       "solver.max_iterations=2000"};
  options.output = output;
  options.packing_cache = packings;
  options.style = Progress::Style::quiet;
  return options;
}

/// Runs in a child process and kills it after `milliseconds`. True if it was still running.
bool killed_after(const RunOptions& options, int milliseconds) {
  const pid_t child = fork();
  if (child == 0) {
    fclose(stderr);
    run(options);
    _exit(0);
  }
  usleep(1000 * milliseconds);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

}  // namespace

TEST_CASE(
    "the same input gives the same bits: deposit, drive, and whatever stopped it in between") {
  const TemporaryFolder place;
  const fs::path once = place.path() / "once", again = place.path() / "again",
                 stopped = place.path() / "stopped";
  // The others stop after parts of this run's time, which is early enough on any machine.
  const Stopwatch whole;
  REQUIRE(run(small_run(once, place.path() / "p1")).code == ExitCode::ok);
  const double seconds = whole.seconds();
  const std::string physics = physics_of(once), state = state_of(once);
  REQUIRE(read_steps(once).size() == 200);

  SECTION("a second run with a deposit of its own") {
    REQUIRE(run(small_run(again, place.path() / "p2")).code == ExitCode::ok);
    CHECK(physics_of(again) == physics);
    CHECK(state_of(again) == state);
  }
  SECTION("stopped by the time limit again and again, in the deposit and in the drive") {
    RunOptions options = small_run(stopped, place.path() / "p3");
    options.max_seconds = seconds / 6.0;
    int stops = 0;
    options.resume = true;
    while (run(options).code == ExitCode::time_limit) {
      options.max_seconds *= 1.05;  // so that it ends under sanitizers and beside other work too
      REQUIRE(++stops < 100);
    }
    CHECK(stops >= 2);
    CHECK(physics_of(stopped) == physics);
    CHECK(state_of(stopped) == state);
  }
  SECTION("killed with kill -9 again and again") {
    RunOptions options = small_run(stopped, place.path() / "p4");
    options.resume = true;
    const auto milliseconds = [&](int k) {
      return static_cast<int>(1e3 * seconds * (0.15 + 0.061 * k));
    };
    int kills = 0;
    while (kills < 6 && killed_after(options, milliseconds(kills))) {
      ++kills;
    }
    CHECK(kills >= 2);
    REQUIRE(run(options).code == ExitCode::ok);
    CHECK(physics_of(stopped) == physics);
    CHECK(state_of(stopped) == state);
  }
}

TEST_CASE("what a run shows: no grain escapes, overlap stays small, the energy account closes") {
  const TemporaryFolder place;
  REQUIRE(run(small_run(place.path() / "run", place.path() / "p")).code == ExitCode::ok);
  double work = 0.0, residual = 0.0;
  for (const StepRecord& row : read_steps(place.path() / "run")) {
    CHECK(row.penetration_max < 0.25e-3);
    CHECK(row.penetration_mean < 5e-6);
    CHECK(row.error_rms < 1e-2 * 9.81 * 2e-4);
    work += std::abs(row.work_load);
    residual += row.energy_residual;
  }
  CHECK(std::abs(residual) < 1e-4 * work);
  MotionState state;
  const MechanicalSystem system = system_of_run(place.path() / "run", state);
  CHECK(system.grain_count == 60);
  for (int b = 0; b < system.grain_count; ++b)
    for (size_t w = system.grain_count; w < system.bodies.size(); ++w) {
      const Vec3& normal = system.bodies[w].wall.normal;
      CHECK(normal.dot(state.pose[b].position - state.pose[w].position) > 0.0);
    }
  // The manifest has the facts of the box that a reader wants to know.
  const Manifest manifest = Manifest::read(place.path() / "run" / "manifest.json");
  const double top = manifest.summary_number("packing_top_m");
  CHECK(manifest.summary_number("grain_mass_kg") == system.mass_of_grains());
  CHECK((top > 0.0 && top < state.pose[60 + wall_lid].position.z()));
}

TEST_CASE("begin or resume: begins, goes on, and leaves a finished run as it is") {
  const TemporaryFolder place;
  const fs::path folder = place.path() / "run";
  RunOptions options = small_run(folder, place.path() / "p");
  options.deposit_only = true;
  REQUIRE(run(options).code == ExitCode::ok);
  CHECK_FALSE(fs::exists(folder));
  CHECK(std::distance(fs::directory_iterator(place.path() / "p"), fs::directory_iterator()) ==
        1);  // no lock and no unfinished deposit are left
  options.deposit_only = false;
  options.resume = true;
  options.max_seconds = 0.01;
  int stops = 0;
  for (; run(options).code == ExitCode::time_limit; ++stops) {
    REQUIRE(stops < 100);
    options.max_seconds *= 1.1;  // so that it ends under sanitizers and beside other work too
  }
  CHECK(stops >= 1);
  const auto written = fs::last_write_time(RunFolder(folder).manifest());
  CHECK(run(options).code == ExitCode::ok);
  CHECK(fs::last_write_time(RunFolder(folder).manifest()) == written);
  CHECK_FALSE(fs::exists(folder / "run.lock"));
  // A finished run needs no lock, as in a folder that may only be read.
  fs::create_directory(folder / "run.lock");
  CHECK(run(options).was_finished);
}

TEST_CASE("a folder refuses what would lose a run") {
  const TemporaryFolder place;
  RunOptions options = small_run(place.path() / "run", place.path() / "p");
  options.scene = "incline";
  options.overrides = {"scene.duration=0.01"};
  REQUIRE(run(options).code == ExitCode::ok);
  CHECK_THROWS_WITH(run(options), Contains("holds a run already"));
  options.resume = true;
  CHECK(run(options).was_finished);
  options.overrides = {"scene.duration=0.02"};
  CHECK_THROWS_WITH(run(options), Contains("other settings"));
  options.resume = false;
  options.overwrite = true;
  CHECK(run(options).code == ExitCode::ok);
  CHECK(read_steps(options.output).size() == 20);
  options.output = "/proc/nowhere/run";
  CHECK_THROWS_WITH(run(options), Contains("/proc/nowhere"));
}

TEST_CASE("a folder that is a link has its packings beside the link") {
  const TemporaryFolder place;
  fs::create_directories(place.path() / "far" / "away");
  fs::create_directory_symlink(place.path() / "far" / "away", place.path() / "link");
  RunOptions options = small_run(place.path() / "link", {});
  for (const char* few : {"grains.count=5", "deposit.lid_time=0.02", "deposit.settle_time=0.01"})
    options.overrides.push_back(few);
  options.deposit_only = true;
  CHECK(run(options).code == ExitCode::ok);
  CHECK(std::distance(fs::directory_iterator(place.path() / "packings"), {}) == 1);
}

TEST_CASE("what a run knows of its packing is written before it drives") {
  const TemporaryFolder place;
  RunOptions options = small_run(place.path() / "run", {});
  for (const char* set : {"grains.count=5", "deposit.lid_time=0.02", "deposit.settle_time=0.01",
                          "drive.f_max_over_weight=1e12"})
    options.overrides.push_back(set);
  CHECK_THROWS_WITH(run(options), Contains("too fast"));
  CHECK(Manifest::read(options.output / "manifest.json").summary_number("grain_mass_kg") > 0.0);
}

TEST_CASE("a run does not go on with another mesh, also where it has no state yet") {
  const TemporaryFolder place;
  const fs::path mesh = place.path() / "grain.obj";
  write_mesh(mesh, make_box(Vec3(1, 1, 1)));
  RunOptions options = small_run(place.path() / "run", {});
  options.scene = place.write("scene.toml",
                              "[scene]\nstep = 1e-3\nduration = 0.05\n"
                              "[[wall]]\nnormal = [0, 0, 1]\n"
                              "[[body]]\nshape = \"mesh\"\nfile = \"grain.obj\"\nmass = 1\n"
                              "position = [0, 0, 0.5]\n");
  options.overrides.clear();
  options.max_seconds = 0.0;
  options.resume = true;
  REQUIRE(run(options).code == ExitCode::time_limit);
  fs::remove(options.output / "checkpoint.bin");
  write_mesh(mesh, make_box(Vec3(1, 2, 1)));
  CHECK_THROWS_WITH(run(options), Contains("other settings"));
}

TEST_CASE("a rate that no step of the run reaches stores nothing but the start") {
  const TemporaryFolder place;
  RunOptions options = small_run(place.path() / "run", {});
  options.scene = "incline";
  options.overrides = {"scene.duration=0.01", "record.pose_rate=1e-20"};
  REQUIRE(run(options).code == ExitCode::ok);
  CHECK(read_poses(options.output).size() == 1);
}

TEST_CASE("what names no file is said of the scene") {
  const TemporaryFolder place;
  RunOptions options = small_run(place.path() / "run", {});
  options.scene = "incline";
  options.overrides = {"body.0.mass=1e31"};
  CHECK_THROWS_WITH(run(options), Catch::StartsWith("incline: dynamics.mass[0]"));
}
