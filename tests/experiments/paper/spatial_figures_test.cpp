// Stress and forces against closed-form answers.

#include "experiments/paper/spatial_figures.hpp"

#include <cmath>
#include <numbers>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Grains as mass points at these places; the fields use no other property of them.
MechanicalSystem points_at(const std::vector<Vec3>& places, MotionState& state) {
  MechanicalSystem system;
  system.grain_count = static_cast<int>(places.size());
  system.friction = 0.5;
  for (const Vec3& place : places) {
    RigidBody body;
    body.mass = 2.0;
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
    system.bodies.emplace_back();  // a body without a shape counts as a wall
    Pose pose;
    pose.position = place;
    state.pose.push_back(pose);
  }
}

StoredState state_of(const MechanicalSystem& system, const MotionState& state,
                     const std::vector<ContactPoint>& contacts, const std::vector<Vec3>& impulses,
                     double h) {
  StoredState stored{system, {}, h};
  stored.at.state = state;
  stored.at.memory.contacts = contacts;
  stored.at.memory.impulses = impulses;
  return stored;
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
  const MechanicalSystem none;
  const auto pairs = state_of(none, {}, contacts, impulses, 0.5).pairs();
  REQUIRE(pairs.size() == 2);  // the contact without force is left out
  CHECK(pairs[0].force.isApprox(Vec3(8, 1, 0)));
  CHECK(pairs[0].normal_force() == Approx(8.0));
  CHECK(pairs[0].position.isApprox(Vec3(0, 0, 0.75)));
  CHECK(pairs[1].body_a == 1);
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
  const Mat3 stress = state_of(system, state, contacts, impulses, h).stress();
  // A force of 10 N acts through every section of 4 m^2.
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
  }
}
