// Arches of dry stones have more contacts than their bodies' unknowns determine. Newton's endgame
// needs many steps there, and converges.

#include <cmath>
#include <numbers>

#include "experiments/step/time_step.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/support/solved.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// A half circle of radius 1 m between two fixed abutments; `thickness` [m].
struct Arch {
  int stones;
  double thickness, friction;
};

std::string exact_text(double number) { return printed("%.17g", number); }

/// The eight corners of the stone at the crown.
std::string corners(const Arch& arch) {
  const double half = std::numbers::pi / 2.0 / arch.stones;
  std::string points;
  for (const double y : {-0.15, 0.15})
    for (const double r : {1.0 - arch.thickness / 2.0, 1.0 + arch.thickness / 2.0})
      for (const int side : {-1, 1})
        points += "[" + exact_text(side * r * std::sin(half)) + ", " + exact_text(y) + ", " +
                  exact_text(r * std::cos(half)) + "],";
  return points;
}

Scene scene_of(const Arch& arch) {
  const double turn = 180.0 / arch.stones;  // angle of one stone [degrees]
  const TemporaryFolder folder;
  return read_scene(folder.write(
      "arch.toml",
      "[scene]\ntitle = 'arch'\nstep = 1e-3\nduration = 0.01\n[contact]\nfriction = " +
          exact_text(arch.friction) + "\n[[body]]\nshape = 'hull'\npoints = [" + corners(arch) +
          "]\norientation = { axis = [0, 1, 0], angle_degrees = " + exact_text(turn / 2.0 - 90.0) +
          " }\nrepeat = [ { count = " + exact_text(arch.stones) +
          ", axis = [0, 1, 0], angle_degrees = " + exact_text(turn) +
          " } ]\ndensity = 2400.0\n[[body]]\nshape = 'box'\nsize = [0.6, 0.5, 0.1]\n"
          "position = [-1, 0, -0.05]\nlocked = ['x', 'y', 'z', 'rotation']\n"
          "repeat = [ { count = 2, translation = [2, 0, 0] } ]\n"
          "[solver]\ntolerance = 1e-6\nmax_iterations = 20000\n"));
}

}  // namespace

TEST_CASE("newton_burst stays with an arch until it is solved", "[factors]") {
  for (const Arch& arch : {Arch{11, 0.14, 0.5}, {11, 0.2, 0.8}, {23, 0.14, 0.5}, {23, 0.2, 0.8}}) {
    const Scene scene = scene_of(arch);
    MotionState state;
    const MechanicalSystem system = make_system(scene, state);
    TimeStepper stepper(system, scene, -1);
    StepMemory memory;
    for (int step = 0; step < 2; ++step) stepper.step(state, memory);
    const FrictionProblem& problem = stepper.problem();
    REQUIRE(problem.contact_count() == 4 * (arch.stones + 1));
    const Budget budget{.tolerance = 1e-8 * velocity_scale(scene), .max_iterations = 50000};
    const SolverRun run = judged_by(make_newton_burst(), problem, budget);
    CAPTURE(arch.stones, arch.thickness, run.solved.iterations);
    CHECK(run.is_solved());
  }
}
