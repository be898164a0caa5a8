// Problems captured from a run are complete and unchanged, and do not change the run.

#include "experiments/run/capture.hpp"
#include "experiments/run/run.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/files/problem_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

std::vector<long> taken(const char* text, long last) {
  const CaptureSettings settings = CaptureSettings::parse(text);
  std::vector<long> steps;
  for (long step = 1; step <= last; ++step)
    if (settings.takes(step)) steps.push_back(step);
  return steps;
}

}  // namespace

TEST_CASE("Which steps are captured") {
  CHECK(taken("", 160).empty());
  CHECK(taken("every=50", 160) == std::vector<long>{50, 51, 100, 101, 150, 151});
  CHECK(taken("every=50,steps=3,from=90", 160) == std::vector<long>{100, 101, 102, 150, 151, 152});
  CHECK(taken("every=1,to=3", 160) == std::vector<long>{1, 2, 3});
  CHECK(taken("from=7,to=9", 160) == std::vector<long>{7, 8, 9});
  CHECK(taken("every=50,steps=1,also=7", 160) == std::vector<long>{7, 50, 100, 150});
  CHECK_THROWS_WITH(CaptureSettings::parse("every=0"),
                    Contains("every=0: expected a whole number"));
  for (const char* wrong : {"every=5x", "often", "steps=2", "every=2,steps=3", "from=9,to=7"})
    CHECK_THROWS_AS(CaptureSettings::parse(wrong), std::invalid_argument);
}

TEST_CASE("A captured step comes back as the solver saw it") {
  const TemporaryFolder folder;
  const Scene scene = read_scene(find_scene("sliding_cube"));
  MotionState state;
  StepMemory memory;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, -1);
  StepCapture capture(CaptureSettings::parse("from=20,to=21"), folder.path(), scene.step,
                      scene.gravity.norm());
  StepRecord record;
  for (int k = 0; k < 21; ++k) {
    record = stepper.step(state, memory);
    capture.observe(stepper, state, memory, record);
  }
  const fs::path file = folder.path() / "step_0000021.hdf5";
  const CapturedProblem back = read_captured(file);
  const FrictionProblem& problem = stepper.problem();
  REQUIRE(problem.contact_count() > 0);
  CHECK(back.problem.row_begin == problem.row_begin);
  CHECK(back.problem.friction == problem.friction);
  CHECK(back.problem.dynamics.mass == problem.dynamics.mass);
  CHECK(back.problem.dynamics.h == problem.dynamics.h);
  CHECK(back.problem.dynamics.bias == problem.dynamics.bias);
  CHECK(back.problem.dynamics.v_free == problem.dynamics.v_free);
  CHECK(back.solution == stepper.impulses());
  CHECK(back.step == 21);
  CHECK(back.velocity_scale() == velocity_scale(scene));
  CHECK(back.phase == "none");
  REQUIRE(back.key.size() == memory.contacts.size());
  for (size_t c = 0; c < back.key.size(); ++c) {
    const ContactPoint& contact = memory.contacts[c];
    CHECK((back.key[c] == contact.feature && back.gap[c] == contact.gap));
    CHECK((back.id_a[c] == contact.body_a && back.id_b[c] == contact.body_b));
    CHECK(Vec3(back.frame.data() + 9 * c) == contact.normal);
    CHECK(Vec3(back.position.data() + 3 * c) == contact.position);
  }
  // The general reader takes the file too, and the error is that of the run's own step.
  CHECK(contact_error(read_problem(file), back.solution).natural_map_rms == record.error_rms);
  // The two steps are consecutive: the warm start is the solution before, where contacts stayed.
  const CapturedProblem before = read_captured(folder.path() / "step_0000020.hdf5");
  REQUIRE(before.key == back.key);
  CHECK((before.solution - back.start).norm() <= 1e-12 * before.solution.norm());
}

TEST_CASE(
    "a phase is told beside the fastest wall of the whole run, however often it was stopped") {
  const TemporaryFolder folder;
  RunOptions options;
  // The wall falls onto the box and rests from step 8 on.
  options.scene = folder.write("press.toml",
                               "[scene]\nstep = 2e-3\nduration = 0.02\n"
                               "[[wall]]\nnormal = [0, 0, 1]\n"
                               "[[wall]]\nnormal = [0, 0, -1]\noffset = -1.01\nmass = 1.0\n"
                               "motion = \"driven\"\n"
                               "load = { f_min = 100.0, f_max = 100.0, frequency = 5.0 }\n"
                               "[[body]]\nshape = \"box\"\nsize = [1, 1, 1]\nmass = 1.0\n"
                               "position = [0, 0, 0.5]\n");
  options.output = folder.path() / "run";
  options.capture = CaptureSettings::parse("from=9,to=10");
  options.style = Progress::Style::quiet;
  options.resume = true;
  options.max_seconds = 0.0;  // one step at each call
  while (run(options).code == ExitCode::time_limit) continue;
  for (const char* name : {"step_0000009.hdf5", "step_0000010.hdf5"})
    CHECK(read_captured(options.output / "capture" / name).phase == "jammed");
}

TEST_CASE("A run that is captured has the same bits") {
  const TemporaryFolder folder;
  RunOptions options;
  options.scene = "shaken_plate";
  options.overrides = {"scene.duration=0.05"};
  options.style = Progress::Style::quiet;
  const auto checkpoint_of = [&](const char* name) {
    options.output = folder.path() / name;
    REQUIRE(run(options).code == ExitCode::ok);
    return file_bytes(options.output / "checkpoint.bin");
  };
  const std::string plain = checkpoint_of("plain");
  options.capture = CaptureSettings::parse("every=20");
  CHECK((checkpoint_of("captured") == plain));
  const fs::path captured = folder.path() / "captured" / "capture";
  for (const char* name : {"step_0000020.hdf5", "step_0000021.hdf5"})
    CHECK(is_captured(captured / name));
  CHECK_FALSE(fs::exists(captured / "step_0000022.hdf5"));
}
