// Stress, vorticity, coordination and the wall's model against answers that can be written down.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/paper/grain_fields.hpp"
#include "experiments/paper/wall_model.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Grains as mass points at these places; fields look at nothing else of them.
MechanicalSystem points_at(const std::vector<Vec3>& places, MotionState& state) {
  MechanicalSystem system;
  system.grain_count = static_cast<int>(places.size());
  system.friction = 0.5;
  for (const Vec3& place : places) {
    RigidBody body;
    body.mass = 2.0;
    body.wall_friction = 0.5;  // without a shape it counts as a wall
    system.bodies.push_back(body);
    Pose pose;
    pose.position = place;
    state.pose.push_back(pose);
    state.velocity.push_back(Vec3::Zero());
    state.spin.push_back(Vec3::Zero());
  }
  return system;
}

/// Walls of a box of these sides, in the order of BoxWall.
void add_box(MechanicalSystem& system, MotionState& state, const Vec3& size) {
  const std::vector<Vec3> places{Vec3::Zero(),         Vec3(0, 0, size.z()), Vec3::Zero(),
                                 Vec3(size.x(), 0, 0), Vec3::Zero(),         Vec3(0, size.y(), 0)};
  for (const Vec3& place : places) {
    RigidBody wall;
    wall.wall_friction = 0.5;
    system.bodies.push_back(wall);
    Pose pose;
    pose.position = place;
    state.pose.push_back(pose);
  }
}

ContactPoint contact(int a, int b, std::uint64_t feature, const Vec3& normal,
                     const Vec3& position) {
  return {a, b, feature, normal, position, 0.0};
}

/// A wall that a load of 5 Hz lets out and presses in again.
WallModel loose_packing() {
  WallModel model;
  model.active.amplitude = 100.0;
  model.active.rate = 20.0;
  model.passive.offset = 300.0;
  model.passive.slope = -1e4;
  model.wall_mass = 50.0;
  model.load = {0.0, 1000.0, 5.0};
  return model;
}

}  // namespace

TEST_CASE("points of one pair are one contact with the sum of their forces") {
  const Vec3 n = Vec3::UnitX();
  const std::vector<ContactPoint> contacts{
      contact(0, 1, 1, n, Vec3(0, 0, 0)), contact(0, 1, 2, n, Vec3(0, 0, 1)),
      contact(0, 2, 1, n, Vec3::Zero()), contact(1, 2, 7, n, Vec3::Zero())};
  const std::vector<Vec3> impulses{Vec3(1, 0.5, 0), Vec3(3, 0, 0), Vec3::Zero(), Vec3(2, 0, 0)};
  const auto pairs = pair_forces(contacts, impulses, 0.5);
  REQUIRE(pairs.size() == 2);  // the open one is left out
  CHECK(pairs[0].force.isApprox(Vec3(8, 1, 0)));
  CHECK(pairs[0].normal_force() == Approx(8.0));
  CHECK(pairs[0].position.isApprox(Vec3(0, 0, 0.75)));
  CHECK(pairs[1].body_a == 1);
  CHECK_THROWS_AS(pair_forces(contacts, std::vector<Vec3>(1), 0.5), std::invalid_argument);
}

TEST_CASE("stress of a two-grain chain between two walls") {
  MotionState state;
  MechanicalSystem system = points_at({Vec3(1, 1, 1), Vec3(3, 1, 1)}, state);
  add_box(system, state, Vec3(4, 2, 2));
  const int left = 2 + wall_x_min, right = 2 + wall_x_max;
  const double force = 10.0, h = 0.1;
  const std::vector<ContactPoint> contacts{contact(0, 1, 1, Vec3::UnitX(), Vec3(2, 1, 1)),
                                           contact(left, 0, 1, Vec3::UnitX(), Vec3(0, 1, 1)),
                                           contact(right, 1, 1, -Vec3::UnitX(), Vec3(4, 1, 1))};
  const std::vector<Vec3> impulses{Vec3(force * h, 0, 0), Vec3(force * h, 0, 0),
                                   Vec3(-force * h, 0, 0)};
  const Mat3 stress =
      stress_tensor(system, state, pair_forces(contacts, impulses, h), box_volume(system, state));
  // a force of 10 N through the section of 4 m^2 everywhere
  CHECK(stress(0, 0) == Approx(2.5));
  CHECK((stress - 2.5 * Vec3::UnitX() * Vec3::UnitX().transpose()).norm() < 1e-12);
  CHECK(major_inclination(stress) == Approx(0.0).margin(1e-9));
}

TEST_CASE("the major direction is found at every angle, and has no sign") {
  for (const double degrees : {0.0, 10.0, 45.0, 80.0, 90.0, -30.0, 150.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const Vec3 e(std::cos(angle), 0, std::sin(angle));
    const Mat3 tensor = Mat3::Identity() + 3.0 * e * e.transpose();
    const double acute = std::abs(degrees) > 90.0 ? 180.0 - std::abs(degrees) : std::abs(degrees);
    CHECK(major_inclination(tensor) == Approx(acute).margin(1e-9));
    const Principal principal = principal_of(tensor);
    CHECK(principal.value.isApprox(Vec3(4, 1, 1)));
    CHECK(std::abs(principal.direction.col(0).dot(e)) == Approx(1.0));
  }
}

TEST_CASE(
    "vorticity of a rigid rotation is twice its angular velocity, of a drift and a shear what they "
    "are") {
  Random random(11);
  std::vector<Vec3> places;
  for (int k = 0; k < 50; ++k)
    places.emplace_back(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
  MotionState state;
  const MechanicalSystem system = points_at(places, state);
  const Vec3 spin(0.3, 1.5, -0.7), drift(1, 2, 3);
  for (size_t k = 0; k < places.size(); ++k) state.velocity[k] = drift + spin.cross(places[k]);
  CHECK(vorticity_xz(velocity_gradient(system, state)) == Approx(2.0 * spin.y()));
  // positive is clockwise with x to the right and z up: the top goes to the right
  for (size_t k = 0; k < places.size(); ++k) state.velocity[k] = Vec3(0.8 * places[k].z(), 0, 0);
  CHECK(vorticity_xz(velocity_gradient(system, state)) == Approx(0.8));
}

TEST_CASE("coordination, rattlers, sliding and anisotropy of a small chain") {
  // three grains in a row between the walls carry the force, a fourth hangs on one contact
  MotionState state;
  MechanicalSystem system =
      points_at({Vec3(1, 1, 1), Vec3(2, 1, 1), Vec3(3, 1, 1), Vec3(2, 1, 1.5)}, state);
  add_box(system, state, Vec3(4, 2, 2));
  const int left = 4 + wall_x_min, right = 4 + wall_x_max;
  const Vec3 x = Vec3::UnitX();
  std::vector<ContactPoint> contacts{
      contact(0, 1, 1, x, Vec3(1.5, 1, 1)),  contact(0, 1, 2, x, Vec3(1.5, 1, 1.1)),
      contact(1, 2, 1, x, Vec3(2.5, 1, 1)),  contact(1, 3, 1, Vec3::UnitZ(), Vec3(2, 1, 1.2)),
      contact(left, 0, 1, x, Vec3(0, 1, 1)), contact(right, 2, 1, -x, Vec3(4, 1, 1))};
  const std::vector<Vec3> impulses{Vec3(1, 0, 0),    Vec3(1, 0, 0), Vec3(2, 0, 1),
                                   Vec3(0, 0, 0.02), Vec3(2, 0, 0), Vec3(-2, 0, 0)};
  const PackingStatistics found = packing_statistics(system, state, contacts, impulses, 1.0);
  CHECK(found.coordination == Approx((2.0 * 3 + 2) / 4.0));
  CHECK(found.rattlers == Approx(0.25));
  CHECK(found.coordination_backbone == Approx((2.0 * 2 + 2) / 3.0));
  CHECK(found.points_per_contact == Approx(4.0 / 3.0));
  CHECK(found.sliding_share == Approx(1.0 / 3.0));  // |f_t| = 1 = 0.5 * 2
  CHECK(found.mean_force == Approx(4.02 / 3.0));
  CHECK(found.weak_share == Approx(1.0 / 3.0));
  CHECK(found.fabric > 0.0);  // two of three contacts along the major stress
  CHECK(found.normal > 0.0);  // and they carry nearly all of it
  CHECK(found.shear_ratio > 0.5);
}

TEST_CASE("Eq. 2 with a constant force of the packing has the motion that can be written down") {
  WallModel model;
  model.active.amplitude = 100.0;
  model.active.rate = 0.0;
  model.passive.offset = 100.0;
  model.passive.slope = 0.0;
  model.wall_mass = 50.0;
  model.load = {0.0, 1000.0, 5.0};
  const ModelMotion motion = integrate(model);
  // m x'' = F - A + A sin wt from rest at t0 (A sin wt0 = A - F): v = ((F - A)(t - t0) - A (cos wt
  // - cos wt0)/w)/m
  const double force = 100.0, half = 500.0, w = 10.0 * std::numbers::pi,
               t0 = std::asin((half - force) / half) / w;
  double worst = 0.0;
  int compared = 0;
  for (size_t k = 0; k < motion.time.size() && !(motion.x[k] < 0.0); ++k) {
    const double t = motion.time[k];
    if (t < t0 || (compared > 10 && motion.x[k] <= 0.0)) continue;
    const double dt = t - t0, cosine = std::cos(w * t0);
    const double v =
        ((force - half) * dt - half / w * (std::cos(w * t) - cosine)) / model.wall_mass;
    const double x = ((force - half) * 0.5 * dt * dt -
                      half / w * ((std::sin(w * t) - std::sin(w * t0)) / w - cosine * dt)) /
                     model.wall_mass;
    worst = std::max({worst, std::abs(motion.x[k] - x) / motion.rise,
                      std::abs(motion.v[k] - v) / motion.speed_in});
    ++compared;
  }
  CHECK(compared > 1000);
  CHECK(worst < 1e-3);
  CHECK(motion.jams);
  CHECK(motion.x.back() == 0.0);
  CHECK(motion.force.back() == Approx(model.load.at(motion.time.back())));
}

TEST_CASE("a motion taken up on its way goes on as the whole one does") {
  const WallModel model = loose_packing();
  const ModelMotion whole = integrate(model);
  const auto k = static_cast<size_t>(
      std::find_if(whole.v.begin(), whole.v.end(), [&](double v) { return v > 0.01; }) -
      whole.v.begin());
  REQUIRE(k < whole.v.size());
  const ModelMotion part = integrate(model, ModelStart{whole.time[k], whole.x[k], whole.v[k]});
  CHECK(part.time.front() == Approx(whole.time[k]));
  CHECK(part.rise == Approx(whole.rise));
  CHECK(part.speed_in == Approx(whole.speed_in));
}

TEST_CASE("a wall under a load that never falls below the packing's force stays jammed") {
  WallModel model;
  model.active.amplitude = 10.0;
  model.active.rate = 50.0;
  model.passive.offset = 30.0;
  model.passive.slope = -1e4;
  model.wall_mass = 5.0;
  model.load = {20.0, 100.0, 10.0};
  const ModelMotion motion = integrate(model, {}, 2000);
  CHECK(motion.rise == 0.0);
  CHECK(motion.speed_in == 0.0);
  CHECK_FALSE(motion.jams);
}

TEST_CASE("the model comes back further in when the packing contracts") {
  WallModel model = loose_packing();
  model.contraction = 1e-3;
  const ModelMotion motion = integrate(model);
  CHECK(motion.jams);
  CHECK(motion.x.back() == Approx(-1e-3));
  CHECK(motion.rise > 0.0);
}
