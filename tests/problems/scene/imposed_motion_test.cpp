// Imposed motions: velocities are the derivatives of poses, by central differences.

#include <numbers>

#include "problems/scene/scene.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("a course says where and how fast, between and beyond the rows of its table") {
  const TimeFunction<double> course{2.0, 0.5, 3.0, {{1.0, 0.0}, {2.0, 4.0}, {4.0, 3.0}}};
  const auto table = [&](double t) {
    const TimeFunction<double> rest{2.0, 0.5, 3.0};
    return course.at(t) - rest.at(t);
  };
  CHECK(table(0.5) == 0.0);
  CHECK(table(1.5) == Approx(2.0));
  CHECK(table(3.0) == Approx(3.5));
  CHECK(table(9.0) == Approx(3.0));
  for (const double t : {0.3, 1.2, 2.5, 3.9, 7.0})
    CHECK(course.rate_at(t) == Approx((course.at(t + 1e-6) - course.at(t - 1e-6)) / 2e-6));
  CHECK(TimeFunction<double>{0.0, 1.0, 0.5}.at(1.0) == Approx(2.0));  // half a swing
}

TEST_CASE("points of a body that is shifted and turned move as its poses say") {
  ImposedMotion motion;
  motion.shift = {Vec3(1, 2, 0), Vec3(0, 0, 0.3), 2.0, {}};
  motion.axis = Vec3(0.6, 0, 0.8);
  motion.centre = Vec3(0.1, 0.2, 0.3);
  motion.turn = {3.0, 0.4, 1.5, {}};
  const Pose start{Vec3(1, -1, 0.5), Quat(0.5, 0.5, -0.5, 0.5)};
  const Vec3 point(0.2, 0.1, -0.4);  // body frame
  const double t = 0.37, dt = 1e-6;
  const Vec3 place = motion.pose_at(t, start) * point;
  const Vec3 moved =
      (motion.pose_at(t + dt, start) * point - motion.pose_at(t - dt, start) * point) / (2.0 * dt);
  CHECK((motion.velocity_at(t, place) - moved).norm() < 1e-7);
  CHECK((motion.pose_at(0.0, start).position - start.position).norm() < 1e-15);
  // The axis moves with the shift and is otherwise at rest.
  const Vec3 on_axis = motion.centre + motion.shift.at(t) + 0.7 * motion.axis;
  CHECK((motion.velocity_at(t, on_axis) - motion.shift.rate_at(t)).norm() < 1e-12);
}
