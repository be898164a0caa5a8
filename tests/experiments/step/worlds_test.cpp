// The worlds of problems/scenes: the known answer in each scene's comment, measured with the
// scene's own step. Those that take minutes have the tag [.worlds]; docs/theory/known_answers.md
// has their results.

#include <functional>
#include <iostream>
#include <numbers>

#include "experiments/step/time_step.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

constexpr double gravity = 9.81;

/// A scene in the course of its run.
struct World {
  Scene scene;
  MechanicalSystem system;
  MotionState state;
  StepMemory memory;
  std::unique_ptr<TimeStepper> stepper;
  StepRecord last;

  explicit World(const char* name, const std::vector<std::string>& overrides = {})
      : scene(read_scene(find_scene(name), overrides)) {
    system = make_system(scene, state);
    stepper = std::make_unique<TimeStepper>(system, scene, -1);
  }

  /// Calls `watch` after each step up to that time.
  void run_to(
      double time, const std::function<void()>& watch = [] {}) {
    for (const long steps = std::lround(time / scene.step); state.step < steps; watch())
      last = stepper->step(state, memory);
  }

  int body(const std::string& name) const {
    for (size_t b = 0; b < system.bodies.size(); ++b)
      if (system.bodies[b].name == name) return static_cast<int>(b);
    FAIL("no body " << name);
    return -1;
  }
  const Vec3& place(const std::string& name) const { return state.pose[body(name)].position; }
  const Vec3& velocity(const std::string& name) const { return state.velocity[body(name)]; }
  bool is_free(size_t b) const { return system.bodies[b].freedom.count() > 0; }

  /// The force of the contacts on that body in the last step [N].
  Vec3 force_on(const std::string& name) const {
    const int k = body(name);
    Vec3 sum = Vec3::Zero();
    for (size_t c = 0; c < memory.contacts.size(); ++c) {
      if (memory.contacts[c].body_b == k) sum += memory.impulses[c];
      if (memory.contacts[c].body_a == k) sum -= memory.impulses[c];
    }
    return sum / scene.step;
  }
  double free_mass() const {
    double mass = 0.0;
    for (size_t b = 0; b < system.bodies.size(); ++b)
      mass += is_free(b) ? system.bodies[b].mass : 0;
    return mass;
  }
  Vec3 centre_of_mass() const {
    Vec3 sum = Vec3::Zero();
    for (size_t b = 0; b < system.bodies.size(); ++b)
      if (is_free(b)) sum += system.bodies[b].mass * state.pose[b].position;
    return sum / free_mass();
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (size_t b = 0; b < system.bodies.size(); ++b)
      if (is_free(b)) sum += system.bodies[b].mass * state.velocity[b];
    return sum;
  }
  /// The largest distance of a body that can move from its place in `before`.
  double largest_move(const std::vector<Pose>& before) const {
    double most = 0.0;
    for (size_t b = 0; b < before.size(); ++b)
      if (is_free(b)) most = std::max(most, (state.pose[b].position - before[b].position).norm());
    return most;
  }
};

std::string force(int body, const Vec3& f) {
  return printed("body.%d.force.constant=[%.17g, %.17g, %.17g]", body, f.x(), f.y(), f.z());
}

std::string leaning(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  return printed("gravity.direction=[%.17g, 0, %.17g]", std::sin(angle), -std::cos(angle));
}

/// body.0.points for an arch of 17 voussoirs with the mean radius 1 m.
std::string voussoir(double thickness) {
  const double half = std::numbers::pi / 34.0;
  std::string points;
  for (const double r : {1.0 - 0.5 * thickness, 1.0 + 0.5 * thickness})
    for (const double y : {-0.15, 0.15})
      for (const double side : {-1.0, 1.0})
        add_to_list(points, printed("[%.17g, %.17g, %.17g]", side * r * std::sin(half), y,
                                    r * std::cos(half)));
  return "body.0.points=[" + points + "]";
}

}  // namespace

TEST_CASE("press: the joint of the least friction gives way, above mu N") {
  const double held = 0.15 * (200.0 + 9.5 * gravity), a = (60.0 - held) / 9.5;
  World world("press");
  world.run_to(0.1, [&] {
    for (const char* plate : {"steel_2", "rubber_2", "platen"})
      REQUIRE(world.velocity(plate).x() == Approx(a * world.state.time).epsilon(1e-6));
    for (const char* plate : {"rubber_1", "steel_1"})
      REQUIRE(std::abs(world.velocity(plate).x()) < 1e-7);
  });
  for (const auto& still :
       {force(3, Vec3(40, 0, 0)), std::string("contact.pair=[{materials = "
                                              "[\"steel\", \"steel\"], friction = 0.3}, {materials "
                                              "= [\"steel\", \"rubber\"], friction = 0.8}]")}) {
    World other("press", {still});
    const auto before = other.state.pose;
    other.run_to(0.05);
    CHECK(other.largest_move(before) < 1e-7);
  }
}

TEST_CASE("gripper: lifts where 2 mu F >= m (g + a)") {
  for (const auto& [f, jaws, box] :
       {std::tuple(25.0, 1.0, 1.0), std::tuple(20.0, 2.62, 0.19), std::tuple(15.0, 7.62, 0.0)}) {
    World world("gripper", {force(0, Vec3(f, 0, 16.215)), force(1, Vec3(-f, 0, 16.215))});
    world.run_to(0.1, [&, jaw = jaws, lifted = box] {
      REQUIRE(world.velocity("left").z() == Approx(jaw * world.state.time).margin(1e-6));
      REQUIRE(world.velocity("box").z() == Approx(lifted * world.state.time).margin(1e-6));
    });
  }
}

TEST_CASE("pile driving: the blow of a body 1e4 times as heavy as a bead keeps the momentum") {
  const double v = std::sqrt(gravity), before = 90.0 * v / 100.0;  // after a fall of 0.5 m
  const double blow = std::sqrt(1.0 / gravity);
  World world("pile_driving", {"crowd.0.count=40"});
  world.run_to(0.335, [&] {
    const double both = 90.0 * world.velocity("hammer").z() + 10.0 * world.velocity("pile").z();
    REQUIRE(both == Approx(-90.0 * gravity * world.state.time).margin(1e-5));
    if (world.state.time < blow - world.scene.step) REQUIRE(world.velocity("pile").norm() < 1e-6);
    // In the first step of the blow the bodies close the remaining gap.
    if (world.state.time > blow + 2.0 * world.scene.step)
      REQUIRE(-world.velocity("pile").z() == Approx(0.9 * gravity * world.state.time));
  });
  World rebounding("pile_driving", {"crowd.0.count=40", "contact.restitution=0.5"});
  rebounding.run_to(0.335);
  const double gone = gravity * (0.335 - blow);
  CHECK(-rebounding.velocity("pile").z() == Approx(1.5 * before).epsilon(3e-3));
  CHECK(-rebounding.velocity("hammer").z() == Approx(v * 85.0 / 100.0 + gone).epsilon(3e-3));
}

TEST_CASE("chain: a catenary whose ends carry seven links") {
  World world("chain");
  world.run_to(world.scene.duration);
  const double weight = 7.0 * world.free_mass() / 7.0 * gravity;
  const Vec3 left = world.force_on("left"), right = world.force_on("right");
  CHECK(-left.z() - right.z() == Approx(weight).epsilon(5e-3));
  CHECK(left.z() == Approx(right.z()).epsilon(0.03));
  CHECK(left.x() == Approx(-right.x()).epsilon(0.03));
  const double sag = -world.centre_of_mass().z();
  CHECK(sag > 0.05);
  // No link has left its neighbour: their centres are at most the inner length of a link apart,
  // 0.08 m, plus the room of a bar to either side, 0.01 m.
  const double most = std::hypot(0.08, 0.01) + 1e-4;
  const std::vector<std::string> links{"left",   "flat_0",    "upright_0", "flat_1", "upright_1",
                                       "flat_2", "upright_2", "flat_3",    "right"};
  for (size_t k = 1; k < links.size(); ++k)
    CHECK((world.place(links[k]) - world.place(links[k - 1])).norm() < most);
  World swinging("chain", {"body.1.locked=[]"});
  swinging.run_to(0.5);
  CHECK((swinging.place("right") - swinging.place("flat_3")).norm() < most);
  CHECK(swinging.place("right").z() < -0.2);
}

TEST_CASE("arch: stands where t/R is above Couplet's 0.1075, falls below") {
  World thick("arch"), thin("arch", {voussoir(0.09)});
  const auto before = thick.state.pose, thin_before = thin.state.pose;
  thick.run_to(0.5);
  CHECK(thick.largest_move(before) < 1e-5);
  CHECK(-thick.force_on("abutment_0").z() - thick.force_on("abutment_1").z() ==
        Approx(thick.free_mass() * gravity).epsilon(1e-5));
  thin.run_to(1.0);
  CHECK(thin.largest_move(thin_before) > 0.05);
}

TEST_CASE("tower of planks: stands, and the floor carries it") {
  World world("kapla");
  const auto before = world.state.pose;
  world.run_to(0.05, [&] {
    const Vec3 weight(0, 0, -world.free_mass() * gravity);
    REQUIRE((world.force_on("floor") - weight).norm() < 1e-4 * weight.norm());
  });
  CHECK(world.largest_move(before) < 1e-6);
  World sliding("kapla", {"gravity.direction=[0.45, 0, -1]"});
  sliding.run_to(0.05);
  CHECK(sliding.momentum().x() / sliding.free_mass() ==
        Approx(0.05 * gravity * 0.05 / std::sqrt(1 + 0.45 * 0.45)).epsilon(1e-3));
}

TEST_CASE("tower of cards: stands by friction, not by less than its equilibrium asks") {
  World world("card_tower"),
      slippery("card_tower", {"contact.friction=0.15", "wall.0.friction=0.15"});
  const auto before = world.state.pose;
  world.run_to(0.2);
  slippery.run_to(0.2);
  CHECK(world.largest_move(before) < 1e-5);
  CHECK(slippery.largest_move(before) > 1e-2);
}

TEST_CASE("leaning wall: stands where tan(angle) <= min(mu, thickness/height)") {
  const std::string held = "body.0.motion.turn.amplitude_degrees=0";
  const double limit = std::atan(0.1 / 0.48) * 180.0 / std::numbers::pi;
  World standing("wall_tilted", {held, leaning(limit - 0.4)});
  World falling("wall_tilted", {held, leaning(limit + 1.2)});
  World sliding("wall_tilted", {held, leaning(10.0), "contact.friction=0.15"});
  const auto before = standing.state.pose;
  for (World* world : {&standing, &falling, &sliding}) world->run_to(0.3);
  CHECK(standing.largest_move(before) < 1e-5);
  CHECK(falling.largest_move(before) > 1e-3);
  const double angle = 10.0 * std::numbers::pi / 180.0;
  CHECK(sliding.momentum().x() / sliding.free_mass() ==
        Approx(0.3 * gravity * (std::sin(angle) - 0.15 * std::cos(angle))).epsilon(1e-3));
}

TEST_CASE("drum: what the wall gives the stones is their change of angular momentum") {
  World world("drum", {"scene.step=5e-4"});
  // The impulses' moment about the axis; gravity's own follows from the centre of mass.
  const auto spin = [&] {
    double sum = 0.0;
    for (size_t b = 1; b < 251; ++b) {
      const Pose& pose = world.state.pose[b];
      sum += (world.system.bodies[b].mass * pose.position.cross(world.state.velocity[b]) +
              pose.rotation * world.system.bodies[b].inertia.cwiseProduct(world.state.spin[b]))
                 .y();
    }
    return sum;
  };
  world.run_to(0.15);
  for (int k = 0; k < 20; ++k) {
    const double before = spin(), weight = world.free_mass() * gravity;
    const double arm = world.centre_of_mass().x();
    world.run_to(world.state.time + world.scene.step);
    double moment = 0.0;
    for (size_t c = 0; c < world.memory.contacts.size(); ++c) {
      const ContactPoint& contact = world.memory.contacts[c];
      if (contact.body_a != 0 && contact.body_b != 0) continue;
      const double sign = contact.body_a == 0 ? 1.0 : -1.0;
      moment += sign * contact.position.cross(world.memory.impulses[c]).y();
    }
    const double pulled = weight * 0.5 * (arm + world.centre_of_mass().x()) * world.scene.step;
    CHECK(spin() - before == Approx(moment + pulled).margin(1e-5));
  }
}

TEST_CASE("chute: along the period only the base and gravity push") {
  World world("chute");
  for (int k = 0; k < 200; ++k) {
    const Vec3 before = world.momentum();
    world.run_to(world.state.time + world.scene.step);
    Vec3 walls = Vec3::Zero();
    for (size_t b = 0; b < world.system.bodies.size(); ++b)
      if (!world.is_free(b)) walls += world.force_on(world.system.bodies[b].name);
    const Vec3 balance = world.momentum() - before -
                         world.scene.step * (world.free_mass() * world.scene.gravity - walls);
    REQUIRE(balance.norm() < 1e-9);
  }
  for (const Pose& pose : world.state.pose)
    if (std::abs(pose.position.y()) < 0.039)
      CHECK(pose.position.x() == Approx(0.08).margin(0.0801));
}

// Tests of a minute or more, to be run by hand: step_test "[.worlds]". Their output is the table of
// docs/theory/known_answers.md.

namespace {

/// The mean of a quantity that is observed after each step.
struct Mean {
  double sum = 0.0;
  long count = 0;
  void take(double x) { sum += x, ++count; }
  double value() const { return sum / static_cast<double>(count); }
};

void tell(const std::string& line) { std::cout << line << std::endl; }

}  // namespace

TEST_CASE("drum: power and slope in the steady state", "[.worlds]") {
  std::vector<double> slopes;
  for (const char* friction : {"0.1", "0.5"}) {
    World world("drum", {std::string("contact.friction=") + friction});
    world.run_to(2.0);
    const double before = world.last.kinetic_energy;
    double given = 0.0, dissipated = 0.0, gravity_work = 0.0, corrected = 0.0;
    Mean arm, angle;
    world.run_to(world.scene.duration, [&] {
      const Vec3 centre = world.centre_of_mass();
      arm.take(std::abs(centre.x()));
      angle.take(std::atan2(-centre.x(), -centre.z()));
      given += world.last.work_prescribed;
      dissipated += world.last.dissipated;
      gravity_work += world.last.work_gravity;
      corrected += world.last.work_correction;
    });
    const double weight = world.free_mass() * gravity;
    const double power = given / 3.0, known = 0.6 * weight * arm.value();
    slopes.push_back(angle.value() * 180.0 / std::numbers::pi);
    tell(
        printed("drum, mu = %s: power of the drum %.4f W, omega m g |x_cm| = %.4f W, dissipated "
                "%.4f W, slope %.1f degrees",
                friction, power, known, dissipated / 3.0, slopes.back()));
    CHECK(power == Approx(known).epsilon(0.05));
    CHECK(given + gravity_work - dissipated ==
          Approx(world.last.kinetic_energy - before).margin(1e-3 * given));
  }
  CHECK(slopes[1] > slopes[0] + 5.0);
}

TEST_CASE("chute: base shear over pressure, and Bagnold's profile", "[.worlds]") {
  World world("chute");
  world.run_to(3.0);
  Vec3 pushed = Vec3::Zero();
  const Vec3 before = world.momentum();
  std::vector<Mean> layers(12);
  double top = 0.0;
  world.run_to(world.scene.duration, [&] {
    for (size_t b = 0; b < world.system.bodies.size(); ++b) {
      if (!world.is_free(b)) {
        pushed += world.force_on(world.system.bodies[b].name) * world.scene.step;
        continue;
      }
      const double z = world.state.pose[b].position.z();
      top = std::max(top, z);
      const auto layer = static_cast<size_t>(std::max(0.0, z / 0.0125));
      if (layer < layers.size()) layers[layer].take(world.state.velocity[b].x());
    }
  });
  const Vec3 gained = world.momentum() - before;
  tell(
      printed("chute: base shear/pressure %.4f with the flow's change of momentum %.4f, "
              "tan(theta) = 0.6249",
              pushed.x() / -pushed.z(), (pushed.x() + gained.x()) / -(pushed.z() + gained.z())));
  std::string profile;
  for (const Mean& layer : layers)
    if (layer.count > 0) add_to_list(profile, printed("%.3f", layer.value()));
  tell("chute: mean velocity [m/s] of layers of 12.5 mm from the base: " + profile +
       printed("; highest bead at %.3f m", top));
  CHECK((pushed.x() + gained.x()) / -(pushed.z() + gained.z()) == Approx(0.6249).epsilon(2e-3));
}

TEST_CASE("silo: all beads arrive", "[.worlds]") {
  World world("silo");
  const auto left = [&] {
    int count = 0;
    for (const Pose& pose : world.state.pose) count += pose.position.z() > 0.3;
    return count - 1;  // without the silo
  };
  double half = 0.0, most = 0.0;
  world.run_to(world.scene.duration, [&] {
    if (half == 0.0 && left() <= 175) half = world.state.time;
    if (most == 0.0 && left() <= 20) most = world.state.time;
  });
  tell(printed(
      "silo: %d of 350 beads are left above the orifice after %g s; 175 were out at "
      "%.3f s, 330 at %.3f s: %.2f kg/s",
      left(), world.scene.duration, half, most, 155.0 / 350.0 * world.free_mass() / (most - half)));
  CHECK(left() == 0);
}

TEST_CASE("Janssen's bin: walls carry what the bottom does not", "[.worlds]") {
  for (const char* count : {"200", "400"}) {
    World world("janssen", {std::string("crowd.0.count=") + count});
    const double weight = world.free_mass() * gravity;
    Mean rest, sunk;
    world.run_to(world.scene.duration, [&] {
      const double share = -world.force_on("bottom").z() / weight;
      if (world.state.time > 0.8 && world.state.time < 0.9) rest.take(share);
      if (world.state.time > 1.1 && world.state.time < 1.3) sunk.take(share);
    });
    tell(
        printed("janssen, %s beads of %.2f N: the bottom carries %.3f of the weight at rest, %.3f "
                "while it sinks; top at %.3f m",
                count, weight, rest.value(), sunk.value(), 2.0 * world.centre_of_mass().z()));
    CHECK(sunk.value() < 1.0);
  }
}

TEST_CASE("wall on a table that tilts in 5 s", "[.worlds]") {
  for (const auto& [degrees, stands] : {std::pair(5.7, true), std::pair(6.0, false)}) {
    World world("wall_tilted", {printed("body.0.motion.turn.amplitude_degrees=%g", degrees)});
    const double before = world.centre_of_mass().z();
    world.run_to(world.scene.duration);
    const double fallen = before - world.centre_of_mass().z();
    tell(printed("wall_tilted: up to %.1f degrees; the centre of mass is %.4f m lower after %g s",
                 2.0 * degrees, fallen, world.scene.duration));
    CHECK((fallen < 0.02) == stands);
  }
}
