// Problems captured from a run: whole, as they were, and without a trace in the run.

#include "experiments/run/capture.hpp"

#include <fstream>
#include <iostream>
#include <sstream>

#include "experiments/run/run.hpp"
#include "experiments/run/run_folder.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/files/problem_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Steps a scene as run() does.
struct Stepping {
  explicit Stepping(const char* name)
      : scene(read_scene(find_scene(name))),
        system(make_system(scene, state)),
        settings(step_settings(scene)),
        stepper(system, settings, -1) {}
  StepRecord step() { return stepper.step(state, memory); }

  Scene scene;
  MotionState state;
  StepMemory memory;
  MechanicalSystem system;
  StepSettings settings;
  TimeStepper stepper;
};

std::vector<long> taken(const char* text, long last) {
  const CaptureSettings settings = CaptureSettings::parse(text);
  std::vector<long> steps;
  for (long step = 1; step <= last; ++step)
    if (settings.takes(step)) steps.push_back(step);
  return steps;
}

std::string refusal(const char* text) {
  try {
    CaptureSettings::parse(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Which steps are captured") {
  CHECK(taken("every=50", 160) == std::vector<long>{50, 51, 100, 101, 150, 151});
  CHECK(taken("every=50,steps=3,from=90", 160) == std::vector<long>{100, 101, 102, 150, 151, 152});
  CHECK(taken("from=7,to=9", 160) == std::vector<long>{7, 8, 9});
  CHECK(taken("every=50,steps=1,also=7", 160) == std::vector<long>{7, 50, 100, 150});
  CHECK(refusal("every=0").find("every=0: expected a whole number") != std::string::npos);
  CHECK(refusal("every=5x") != "");
  CHECK(refusal("often") != "");
  CHECK(refusal("steps=2") != "");
  CHECK(refusal("every=2,steps=3") != "");
  CHECK(refusal("from=9,to=7") != "");
}

TEST_CASE("A captured step comes back as the solver saw it") {
  const TemporaryFolder folder;
  Stepping run("sliding_cube");
  StepCapture capture(CaptureSettings::parse("from=20,to=21"), folder.path(), run.settings.h,
                      run.scene.gravity.norm());
  Impulses solution_before;
  for (int k = 0; k < 21; ++k) {
    const StepRecord record = run.step();
    capture.observe(run.stepper, run.state, record);
  }
  const fs::path file = folder.path() / "step_0000021.hdf5";
  REQUIRE(fs::exists(folder.path() / "step_0000020.hdf5"));
  REQUIRE(is_captured(file));
  const CapturedProblem back = read_captured(file);
  const FrictionProblem& problem = run.stepper.problem();
  REQUIRE(problem.contact_count() > 0);
  CHECK(back.problem.row_begin == problem.row_begin);
  CHECK(back.problem.friction == problem.friction);
  CHECK(back.problem.dynamics.dof_begin == problem.dynamics.dof_begin);
  CHECK(back.problem.dynamics.body_a == problem.dynamics.body_a);
  CHECK(back.problem.dynamics.body_b == problem.dynamics.body_b);
  CHECK(back.problem.dynamics.mass == problem.dynamics.mass);
  CHECK(back.problem.dynamics.h == problem.dynamics.h);
  CHECK(back.problem.dynamics.bias == problem.dynamics.bias);
  CHECK(back.problem.dynamics.v_free == problem.dynamics.v_free);
  CHECK(back.solution == run.stepper.impulses());
  CHECK(back.step == 21);
  CHECK(back.h == run.settings.h);
  CHECK(back.velocity_scale() == run.settings.velocity_scale());
  CHECK(back.phase == "none");
  REQUIRE(back.key.size() == run.stepper.contacts().size());
  for (size_t c = 0; c < back.key.size(); ++c) {
    const ContactPoint& contact = run.stepper.contacts()[c];
    CHECK(back.key[c] == contact.feature);
    CHECK(back.id_a[c] == contact.body_a);
    CHECK(back.id_b[c] == contact.body_b);
    CHECK(back.gap[c] == contact.gap);
    CHECK(Vec3(back.frame[9 * c], back.frame[9 * c + 1], back.frame[9 * c + 2]) == contact.normal);
    CHECK(Vec3(back.position[3 * c], back.position[3 * c + 1], back.position[3 * c + 2]) ==
          contact.position);
  }
  // through the general door too, and the run's own error with it
  CHECK(contact_error(read_problem(file), back.solution).natural_map_rms ==
        run.stepper.error().natural_map_rms);
  // the pair is consecutive: the warm start is the solution before, where contacts stayed
  const CapturedProblem before = read_captured(folder.path() / "step_0000020.hdf5");
  REQUIRE(before.key == back.key);
  CHECK((before.solution - back.start).norm() <= 1e-12 * before.solution.norm());
}

TEST_CASE("A broken side group is refused with its name") {
  const TemporaryFolder folder;
  Stepping run("sliding_cube");
  StepCapture capture(CaptureSettings::parse("from=2,to=2"), folder.path(), run.settings.h, 9.81);
  for (int k = 0; k < 2; ++k) {
    const StepRecord record = run.step();
    capture.observe(run.stepper, run.state, record);
  }
  const fs::path good = folder.path() / "step_0000002.hdf5", bad = folder.path() / "bad.hdf5";
  CapturedProblem captured = read_captured(good);
  captured.gap.pop_back();
  write_captured(bad, captured);
  CHECK_THROWS_WITH(read_captured(bad),
                    Catch::Contains("bad.hdf5") && Catch::Contains("/ballast/gap has"));
  std::ofstream(bad) << "no HDF5";
  CHECK_FALSE(is_captured(bad));
  CHECK_FALSE(is_captured(folder.path() / "missing.hdf5"));
}

TEST_CASE("A run that is captured has the same bits") {
  const TemporaryFolder folder;
  std::ostringstream silence;
  std::streambuf* old = std::cout.rdbuf(silence.rdbuf());
  RunOptions options;
  options.scene = "shaken_plate";
  options.overrides = {"scene.duration=0.05"};
  options.output = folder.path() / "plain";
  const ExitCode plain = run(options).code;
  options.output = folder.path() / "captured";
  options.capture = "every=20";
  const ExitCode captured = run(options).code;
  std::cout.rdbuf(old);
  REQUIRE(plain == ExitCode::ok);
  REQUIRE(captured == ExitCode::ok);
  const auto bytes = [&](const char* name) {
    std::ifstream file(RunFolder(folder.path() / name).checkpoint(), std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  };
  CHECK(bytes("plain").size() > 100);
  CHECK(bytes("plain") == bytes("captured"));
  CHECK(is_captured(folder.path() / "captured" / "capture" / "step_0000020.hdf5"));
  CHECK(is_captured(folder.path() / "captured" / "capture" / "step_0000021.hdf5"));
  CHECK_FALSE(fs::exists(folder.path() / "captured" / "capture" / "step_0000022.hdf5"));
}
