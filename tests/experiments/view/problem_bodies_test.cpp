#include "experiments/view/problem_bodies.hpp"

#include <cmath>
#include <random>

#include "experiments/view/problem_view.hpp"
#include "tests/catch.hpp"
#include "tests/support/captured_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// A contact between two turned bodies, whose H has the levers a and b [m].
CapturedProblem contact_of(const Mat3& frame, const Vec3& a, const Vec3& b, const Quat& turn_a,
                           const Quat& turn_b) {
  CapturedProblem captured;
  FrictionProblem& problem = captured.problem;
  problem.row_begin = {0, 3};
  problem.friction = {0.5};
  problem.dynamics.dof_begin = {0, 6, 12};
  problem.dynamics.body_a = {0};
  problem.dynamics.body_b = {1};
  const auto add_side = [&](double sign, const Vec3& lever, const Quat& turn) {
    for (int d = 0; d < 3; ++d)
      for (int row = 0; row < 3; ++row) problem.dynamics.h.push_back(sign * frame(row, d));
    for (int d = 0; d < 3; ++d)
      for (int row = 0; row < 3; ++row)
        // what a spin about the body's axis d moves the point by, along the row's direction
        problem.dynamics.h.push_back(sign *
                                     frame.row(row).dot((turn * Vec3::Unit(d)).cross(lever)));
  };
  add_side(-1.0, a, turn_a);
  add_side(1.0, b, turn_b);
  problem.dynamics.h_begin = {0, 36};
  for (int row = 0; row < 3; ++row)
    for (int d = 0; d < 3; ++d) captured.frame.push_back(frame(row, d));
  return captured;
}

TEST_CASE("a lever is read from H, however the bodies are turned") {
  std::mt19937_64 random(14);
  std::normal_distribution<double> normal;
  const auto any_turn = [&] {
    return Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
  };
  for (int k = 0; k < 50; ++k) {
    const Mat3 frame = any_turn().toRotationMatrix();
    Vec3 a(normal(random), normal(random), normal(random)), b = a;
    b = Vec3(normal(random), normal(random), normal(random));
    // both centres lie behind the contact's plane
    const Vec3 n = frame.row(0);
    if (a.dot(n) < 0.0) a = -a;
    if (b.dot(n) > 0.0) b = -b;
    const CapturedProblem captured = contact_of(frame, a, b, any_turn(), any_turn());
    CHECK((lever_of(captured, 0, false) - a).norm() < 1e-12 * (1.0 + a.norm()));
    CHECK((lever_of(captured, 0, true) - b).norm() < 1e-12 * (1.0 + b.norm()));
  }
}

TEST_CASE("a problem alone knows where its bodies are: there where the run has them") {
  const TemporaryFolder folder;
  const fs::path file = captured_run(folder.path() / "run");
  const ErrorQuestion question{.backends = {"pgs"}, .iterations = {10}};
  const ViewData in_run = view_of_problem(file, question);
  fs::copy_file(file, folder.path() / "alone.hdf5");
  const ViewData alone = view_of_problem(folder.path() / "alone.hdf5", question);
  CHECK(in_run.has_shapes);
  CHECK_FALSE(alone.has_shapes);
  CHECK(alone.errors[0].error == in_run.errors[0].error);
  REQUIRE(alone.system.grain_count == in_run.system.grain_count);
  const auto contacts = alone.contacts(0), known_contacts = in_run.contacts(0);
  REQUIRE(contacts.size() == known_contacts.size());
  for (size_t c = 0; c < contacts.size(); ++c) {
    const FrameContact &mine = contacts[c], &known = known_contacts[c];
    for (const auto& [body, other] :
         {std::pair(mine.body_a, known.body_a), std::pair(mine.body_b, known.body_b)}) {
      const auto b = static_cast<size_t>(body), o = static_cast<size_t>(other);
      REQUIRE(alone.system.bodies[b].is_wall() == in_run.system.bodies[o].is_wall());
      if (alone.system.bodies[b].is_wall()) continue;
      CHECK((alone.frames[0].pose[b].position - in_run.frames[0].pose[o].position).norm() < 1e-6);
      CHECK(alone.system.bodies[b].mass == Approx(in_run.system.bodies[o].mass));
      // the contact point is a corner of the hull, or inside
      CHECK(alone.system.bodies[b].shape.polyhedron->circumradius() >
            (mine.position.cast<double>() - alone.frames[0].pose[b].position).norm() - 1e-6);
    }
  }
}

}  // namespace
}  // namespace ballast
