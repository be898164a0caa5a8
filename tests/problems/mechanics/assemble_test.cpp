// Assembly against its definition: H v is the velocity of b's material point relative to a's, in
// the contact frame.

#include "problems/mechanics/assemble.hpp"

#include "geometry/shape/pose.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Two free cubes, one that only slides along x and z, a driven wall and a fixed one, all at
/// unusual poses and velocities.
struct Fixture {
  MechanicalSystem system;
  MotionState state;
  std::vector<ContactPoint> contacts;

  Fixture() {
    Random random(7);
    for (int b = 0; b < 3; ++b) {
      BodySpec body;
      body.name = "body " + std::to_string(b);
      body.shape = std::make_shared<const Polyhedron>(make_box(Vec3(0.1, 0.2, 0.3)));
      body.mass = 1.0 + b;
      body.inertia = Vec3(0.1, 0.2, 0.25) * (1.0 + b);
      body.pose = {Vec3(random.normal(), random.normal(), random.normal()),
                   random_rotation(random)};
      body.velocity = Vec3(random.normal(), random.normal(), random.normal());
      body.spin = Vec3(random.normal(), random.normal(), random.normal());
      if (b == 2) {
        body.free[1] = false;
        body.free_rotation = false;
        body.velocity.y() = 0.0;
        body.spin.setZero();
      }
      add_body(system, state, body, 1.0);
    }
    WallSpec driven;
    driven.name = "driven";
    driven.normal = Vec3(-1, 2, 0.5).normalized();
    driven.motion = WallMotion::driven;
    driven.mass = 5.0;
    add_wall(system, state, driven);
    WallSpec fixed;
    fixed.name = "fixed";
    fixed.friction = 0.3;
    add_wall(system, state, fixed);
    system.friction = 0.4;
    state.velocity[3] = -0.7 * driven.normal;
    for (auto [a, b] : {std::pair{0, 1}, {1, 2}, {3, 0}, {4, 1}, {3, 2}})
      contacts.push_back({a, b, 0, random_direction(random),
                          Vec3(random.normal(), random.normal(), random.normal()), 0.0});
  }

  /// The problem of a step of 1 ms whose free velocities are those of the state.
  FrictionProblem assembled(ProblemAssembler& assembler) const {
    Eigen::VectorXd v;
    assembler.pack(state, v);
    return assembler.assemble({state, contacts, v, 1e-3, 0.0});
  }

  Vec3 material_velocity(int b, const Vec3& point) const {
    const Vec3 spin_W = state.pose[b].rotation * state.spin[b];
    return state.velocity[b] + spin_W.cross(point - state.pose[b].position);
  }
};

}  // namespace

TEST_CASE("H v is the relative velocity in the contact frame") {
  const Fixture f;
  ProblemAssembler assembler(f.system);
  const FrictionProblem problem = f.assembled(assembler);
  problem.validate();
  REQUIRE(problem.contact_count() == 5);
  REQUIRE(problem.dynamics.dof_count() == 6 + 6 + 2 + 1);
  CHECK(problem.contact_rows(2) == 1);  // a frictionless wall has one row
  CHECK(problem.contact_rows(3) == 3);
  CHECK((problem.friction[1] == 0.4 && problem.friction[3] == 0.3));  // a wall has its own friction
  Eigen::VectorXd u;
  free_contact_velocity(problem, u);
  for (int c = 0; c < problem.contact_count(); ++c) {
    const ContactPoint& contact = f.contacts[c];
    const Vec3 expected =
        contact_frame(contact.normal) * (f.material_velocity(contact.body_b, contact.position) -
                                         f.material_velocity(contact.body_a, contact.position));
    for (int row = 0; row < problem.contact_rows(c); ++row)
      CHECK(u[problem.row_begin[c] + row] == Approx(expected[row]).margin(1e-14));
  }
}

TEST_CASE("packing and unpacking velocities are inverse to each other") {
  const Fixture f;
  const ProblemAssembler assembler(f.system);
  Eigen::VectorXd v, again;
  assembler.pack(f.state, v);
  MotionState copy = f.state;
  for (Vec3& velocity : copy.velocity) velocity.setConstant(9.0);
  assembler.unpack(v, copy);
  assembler.pack(copy, again);
  CHECK((v - again).norm() < 1e-15);
  CHECK((copy.velocity[3] - f.state.velocity[3]).norm() < 1e-15);
}

TEST_CASE("an open gap becomes a bias, an overlap none") {
  Fixture f;
  f.contacts[0].gap = 2e-4;
  f.contacts[1].gap = -2e-4;
  ProblemAssembler assembler(f.system);
  const FrictionProblem problem = f.assembled(assembler);
  CHECK(problem.dynamics.bias[problem.row_begin[0]] == Approx(0.2));
  CHECK(problem.dynamics.bias[problem.row_begin[1]] == 0.0);
}

TEST_CASE("restitution leaves open points out and turns the approach round") {
  Fixture f;
  f.system.restitution = 0.5;
  f.contacts[0].gap = 2e-4;
  ProblemAssembler assembler(f.system);
  FrictionProblem problem = f.assembled(assembler);
  REQUIRE(problem.contact_count() == 4);
  CHECK(assembler.detected()[0] == 1);
  Eigen::VectorXd bias = problem.dynamics.bias;
  problem.dynamics.bias.setZero();
  Eigen::VectorXd u;
  free_contact_velocity(problem, u);  // H v before the step
  for (int c = 0; c < 4; ++c)
    CHECK(bias[problem.row_begin[c]] ==
          Approx(0.5 * std::min(0.0, u[problem.row_begin[c]])).margin(1e-14));
}

TEST_CASE("in a world that repeats itself a turning body moves alike wherever it is met") {
  MechanicalSystem system;
  MotionState state;
  system.period.vector = Vec3(1, 0, 0);
  system.friction = 0.4;
  ImposedMotion turning;
  turning.turn.rate = 2.0;
  BodySpec plate, cube;
  plate.shape = cube.shape = std::make_shared<const Polyhedron>(make_box(Vec3(0.1, 0.1, 0.1)));
  cube.inertia = Vec3(1, 1, 1);
  plate.imposed = turning;
  add_body(system, state, plate, 1.0);
  add_body(system, state, cube, 1.0);
  Eigen::VectorXd v;
  ProblemAssembler assembler(system);
  assembler.pack(state, v);
  for (const double period : {-2.0, -1.0, 0.0, 1.0}) {
    const std::vector<ContactPoint> contacts = {
        {0, 1, 0, Vec3::UnitZ(), Vec3(0.04 + period, 0.03, 0.05), 0.0}};
    const FrictionProblem& problem = assembler.assemble({state, contacts, v, 1e-3, 0.0});
    CHECK(problem.dynamics.bias.norm() == Approx(2.0 * 0.05).epsilon(1e-12));
  }
}

TEST_CASE("world impulses and rows are inverse to each other in the frame") {
  const Fixture f;
  ProblemAssembler assembler(f.system);
  const FrictionProblem problem = f.assembled(assembler);
  Impulses r = Impulses::LinSpaced(problem.row_count(), 1.0, 2.0), again;
  std::vector<Vec3> world;
  assembler.to_world(r, f.contacts, world);
  assembler.to_rows(world, f.contacts, again);
  CHECK((r - again).norm() < 1e-14);
}

TEST_CASE("contact frames are right-handed and orthonormal for every normal") {
  Random random(3);
  for (int k = 0; k < 1000; ++k) {
    const Mat3 frame = contact_frame(random_direction(random));
    CHECK((frame * frame.transpose() - Mat3::Identity()).norm() < 1e-14);
    CHECK(frame.determinant() == Approx(1.0));
  }
  for (int axis = 0; axis < 3; ++axis)
    CHECK(contact_frame(Vec3::Unit(axis)).determinant() == Approx(1.0));
}

TEST_CASE("a team assembles with the bits of one thread") {
  Fixture f;
  Random random(8);
  const std::vector<ContactPoint> few = f.contacts;
  for (int k = 0; k < 500; ++k) {  // enough for several parts
    f.contacts.push_back(few[k % few.size()]);
    f.contacts.back().normal = random_direction(random);
    f.contacts.back().position = Vec3(random.normal(), random.normal(), random.normal());
  }
  WorkerTeam team;
  team.resize(3);
  ProblemAssembler alone(f.system), shared(f.system);
  shared.use_team(&team);
  Eigen::VectorXd v;
  alone.pack(f.state, v);
  for (const size_t count :
       {f.contacts.size(), few.size(), f.contacts.size()}) {  // into the same buffers
    const std::span<const ContactPoint> contacts(f.contacts.data(), count);
    const FrictionProblem& expected = alone.assemble({f.state, contacts, v, 1e-3, 1e-3});
    const FrictionProblem& problem = shared.assemble({f.state, contacts, v, 1e-3, 1e-3});
    problem.validate();
    CHECK(problem.dynamics.h == expected.dynamics.h);
    CHECK(problem.dynamics.h_begin == expected.dynamics.h_begin);
    CHECK(problem.row_begin == expected.row_begin);
  }
}
