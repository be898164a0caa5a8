// Stress, vorticity and coordination against answers that can be written down.

#include "experiments/paper/grain_fields.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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
