// The known answers of the mechanics (with the numbers of docs/theory/known_answers.md), each in a
// scene of problems/scenes run by the stepper. A formula that is exact for the scheme is checked at
// every step; elsewhere the error must fall with h.

#include <functional>
#include <numbers>

#include "experiments/step/time_step.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

using Observer = std::function<void(const MotionState&, const StepRecord&)>;

struct Outcome {
  MechanicalSystem system;
  MotionState state;
};

Outcome run(const char* scene_name, std::vector<std::string> overrides,
            const Observer& observe = nullptr) {
  const Scene scene = read_scene(find_scene(scene_name), overrides);
  Outcome outcome;
  outcome.system = make_system(scene, outcome.state);
  TimeStepper stepper(outcome.system, scene, outcome.system.first_driven_wall());
  StepMemory memory;
  while (outcome.state.step < scene.step_count()) {
    const StepRecord record = stepper.step(outcome.state, memory);
    if (observe) observe(outcome.state, record);
  }
  return outcome;
}

std::string number(double value) { return printed("%.17g", value); }

std::string gravity_towards(double x, double y, double z) {
  return "gravity.direction=[" + number(x) + ", " + number(y) + ", " + number(z) + "]";
}

constexpr double g = 9.81;

}  // namespace

TEST_CASE("1 incline: slides at g (sin - mu cos) at every step, at every heading") {
  const double theta = std::numbers::pi / 6;
  for (const double phi : {0.0, std::numbers::pi / 4, 1.0, std::numbers::pi / 2}) {
    const Vec3 heading(std::cos(phi), std::sin(phi), 0.0);
    const double a = g * (std::sin(theta) - 0.4 * std::cos(theta));
    run("incline",
        {gravity_towards(std::sin(theta) * heading.x(), std::sin(theta) * heading.y(),
                         -std::cos(theta))},
        [&](const MotionState& state, const StepRecord&) {
          REQUIRE((state.velocity[0] - a * state.time * heading).norm() < 1e-9);
          REQUIRE(std::abs(state.pose[0].position.dot(heading) -
                           0.5 * a * state.time * state.time) < 1e-9);
          REQUIRE(state.spin[0].norm() < 1e-9);
        });
  }
}

TEST_CASE("1 incline: sticks up to tan(theta) = mu and no further") {
  for (const double phi : {0.0, std::numbers::pi / 4}) {
    const auto speed = [&](double slope) {
      const Outcome out =
          // The errors of five hundred steps may add up; their sum is below the bounds that follow.
          run("incline", {gravity_towards(slope * std::cos(phi), slope * std::sin(phi), -1.0),
                          "solver.tolerance=1e-10"});
      return out.state.velocity[0].norm();
    };
    CHECK(speed(0.4 * (1 - 1e-6)) < 1e-9);
    const double over = 0.4 * (1 + 1e-3), cosine = 1.0 / std::sqrt(1 + over * over);
    CHECK(speed(over) == Approx(0.5 * g * cosine * (over - 0.4)).epsilon(1e-6));
  }
}

TEST_CASE(
    "2 stick-slip: the scheme's own sum at every step, stop time and displacement at first order "
    "in h") {
  struct Stop {
    double time = 0.0, displacement = 0.0;
  };
  const auto stop_of = [](double h) {
    Stop stop;
    double expected = 0.0;  // v_k = sum of h (8 cos t_mid - 7.848) while it slips
    bool slips = true;
    run("stick_slip", {"scene.step=" + number(h)},
        [&](const MotionState& state, const StepRecord&) {
          const double v = state.velocity[0].x();
          if (slips) expected += h * (8.0 * std::cos(state.time - 0.5 * h) - 0.8 * g);
          if (expected <= 0.0) slips = false;
          REQUIRE(v == Approx(slips ? expected : 0.0).margin(1e-9));
          if (v > 1e-9) stop = {state.time, state.pose[0].position.x()};
        });
    return stop;
  };
  const double exact_time = 0.3386082, exact_displacement = 4.348570e-3;
  const Stop coarse = stop_of(2e-4), fine = stop_of(1e-4);
  CHECK(std::abs(coarse.time - exact_time) <= 2e-4);
  CHECK(std::abs(fine.time - exact_time) <= 1e-4);
  CHECK(std::abs(coarse.displacement - exact_displacement) < 2e-7);
  CHECK(std::abs(fine.displacement - exact_displacement) < 1e-7);
}

TEST_CASE("3 shaken plate: moves with the floor up to A omega^2 = mu g and no further") {
  const double limit = 0.5 * g / std::pow(2 * std::numbers::pi * 10.0, 2);
  const auto slip = [&](double amplitude) {
    double most = 0.0;
    run("shaken_plate", {"wall.0.amplitude=[" + number(amplitude) + ", 0, 0]"},
        [&](const MotionState& state, const StepRecord&) {
          most = std::max(most, (state.velocity[0] - state.velocity[1]).norm());
        });
    return most;
  };
  CHECK(slip(0.999 * limit) < 1e-9);
  CHECK(slip(1.02 * limit) > 1e-4);
}

TEST_CASE("4 tipping box: tips iff tan(theta) > w/H and mu > w/H") {
  struct Case {
    double slope, mu;
    bool tips, slides;
  };
  for (const Case& c : {Case{0.49, 0.8, false, false}, Case{0.51, 0.8, true, false},
                        Case{0.51, 0.45, false, true}}) {
    const Outcome out = run(
        "tipping_box",
        {gravity_towards(c.slope, 0, -1), "wall.0.friction=" + number(c.mu), "scene.duration=0.3"});
    INFO("tan(theta) = " << c.slope << ", mu = " << c.mu);
    CHECK((out.state.spin[0].norm() > 1e-3) == c.tips);
    const double lower_edge_speed =  // in x, of the lower corner, about which the box turns
        (out.state.velocity[0] + (out.state.pose[0].rotation * out.state.spin[0])
                                     .cross(out.state.pose[0].rotation * Vec3(0.125, 0, -0.25)))
            .x();
    CHECK((lower_edge_speed > 1e-2) == c.slides);
  }
}

TEST_CASE("7 overhang: stands at 98 % of (w/2)(1 + 1/2 + 1/3 + 1/4), falls at 102 %") {
  const auto fallen = [](double part) {
    std::vector<std::string> overrides;
    const double centres[] = {0.03125, 0.0729166666666666667, 0.1354166666666666667,
                              0.2604166666666666667};
    for (int brick = 0; brick < 4; ++brick)  // bodies 1 .. 4, from the bottom
      overrides.push_back("body." + std::to_string(brick + 1) + ".position=[" +
                          number(part * centres[brick] - 0.125) + ", 0, " +
                          number(0.03125 + 0.0625 * brick) + "]");
    const Outcome out = run("overhang", overrides);
    return 0.21875 - out.state.pose[4].position.z();
  };
  CHECK(std::abs(fallen(0.98)) < 1e-5);
  CHECK(fallen(1.02) > 1e-2);
}

TEST_CASE("11 Zeno's ball: rests at sqrt(2 d/g) (1 + e)/(1 - e), at first order in h") {
  const double rest = std::sqrt(2 * 0.2 / g) * 3.0;
  const auto error = [&](double h) {
    double last = 0.0;
    run("zeno_ball", {"scene.step=" + number(h)}, [&](const MotionState& state, const StepRecord&) {
      if (state.velocity[0].norm() > 2.0 * g * h) last = state.time;
    });
    return std::abs(last - rest);
  };
  const double coarse = error(4e-4), fine = error(1e-4);
  CHECK(coarse < 4e-4 * 60);
  CHECK(fine < 1e-4 * 60);
  CHECK(fine < 0.5 * coarse);
}

TEST_CASE("12 cradle: (-1/3, 2/3, 2/3) v0, energy and momentum conserved") {
  const Outcome out = run("cradle", {}, [](const MotionState& state, const StepRecord& record) {
    REQUIRE(record.kinetic_energy == Approx(0.5).epsilon(1e-9));
    REQUIRE(state.velocity[0].x() + state.velocity[1].x() + state.velocity[2].x() ==
            Approx(1.0).epsilon(1e-9));
  });
  CHECK(out.state.velocity[0].x() == Approx(-1.0 / 3).epsilon(1e-9));
  CHECK(out.state.velocity[1].x() == Approx(2.0 / 3).epsilon(1e-9));
  CHECK(out.state.velocity[2].x() == Approx(2.0 / 3).epsilon(1e-9));
}

TEST_CASE("13 sliding cube: stops after v^2/(2 mu g) at every heading, error falling with h") {
  const double exact = 4.0 / (2 * 0.4 * g);
  for (const double phi : {0.0, 0.3, std::numbers::pi / 4, 2.0}) {
    const auto distance = [&](double h) {
      const Outcome out = run("sliding_cube", {"scene.step=" + number(h),
                                               "body.0.velocity=[" + number(2 * std::cos(phi)) +
                                                   ", " + number(2 * std::sin(phi)) + ", 0]"});
      REQUIRE(out.state.velocity[0].norm() < 1e-9);
      const Vec3 end = out.state.pose[0].position;
      CHECK(std::abs(end.dot(Vec3(-std::sin(phi), std::cos(phi), 0))) < 1e-9);  // straight on
      return end.head<2>().norm();
    };
    CHECK(std::abs(distance(2e-3) - exact) < 2e-3 * 0.01);
    CHECK(std::abs(distance(1e-3) - exact) < 1e-3 * 0.01);
  }
}

TEST_CASE(
    "13 rolling sphere: rolls at 5/7 of its speed in the end, the nearer the finer its faces") {
  const auto loss = [](int subdivisions) {
    const Outcome out =
        run("rolling_sphere", {"body.0.subdivisions=" + std::to_string(subdivisions)});
    const double v = out.state.velocity[0].x();
    const double rim = (out.state.pose[0].rotation * out.state.spin[0]).y() * 0.125;
    CHECK(rim == Approx(v).epsilon(0.05));
    return 5.0 / 7.0 - v;
  };
  const double coarse = loss(2), fine = loss(3);
  CHECK(std::abs(coarse) < 0.05);
  CHECK(std::abs(fine) < 0.02);
  CHECK(std::abs(fine) < std::abs(coarse));
}

TEST_CASE(
    "16 empty driven wall: the scheme's closed sum at every step, Eq. 2's integral at second order "
    "in h") {
  const double omega = 2 * std::numbers::pi * 5.0, scale = 100.0 / (2 * 20.0);
  const auto error = [&](double h) {
    double worst = 0.0;
    run("empty_driven_wall", {"scene.step=" + number(h)},
        [&](const MotionState& state, const StepRecord& record) {
          const double t = state.time;
          // sum over k of h sin(omega (k + 1/2) h) = h (1 - cos omega t) / (2 sin(omega h / 2))
          const double sum = h * (1 - std::cos(omega * t)) / (2 * std::sin(0.5 * omega * h));
          REQUIRE(record.wall_v == Approx(-scale * (t - sum)).margin(1e-9));
          REQUIRE(std::abs(record.energy_residual) < 1e-12);
          worst = std::max(
              worst, std::abs(record.wall_v + scale * (t + (std::cos(omega * t) - 1) / omega)));
        });
    return worst;
  };
  const double coarse = error(4e-4), fine = error(2e-4);
  CHECK(fine < 1e-5);
  CHECK(coarse / fine == Approx(4.0).margin(0.1));
}
