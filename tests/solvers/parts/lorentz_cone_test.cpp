#include "solvers/parts/lorentz_cone.hpp"

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;
using lorentz::Vector;

namespace {

/// A vector inside the cone, at a relative distance `depth` from its side.
Vector inside(Random& random, double depth) {
  const double angle = random.uniform(0.0, 6.28), size = random.log_uniform(1e-3, 1e3);
  return size * Vector(1.0 + depth, std::cos(angle), std::sin(angle));
}

}  // namespace

TEST_CASE("the scaling sends both points to the same one, near the cone's side too") {
  Random random(5);
  for (const double depth : {1.0, 1e-3, 1e-7})
    for (int k = 0; k < 50; ++k) {
      const Vector x = inside(random, depth), z = inside(random, depth);
      lorentz::Scaling s;
      REQUIRE(lorentz::scale(x, z, false, s));
      const double accuracy = 1e-13 / depth;
      CHECK((s.f * x - s.f_inverse * z).norm() <= accuracy * s.lambda.norm());
      CHECK(s.lambda.squaredNorm() == Approx(x.dot(z)).epsilon(accuracy));
      CHECK((s.f * s.f_inverse - lorentz::Matrix::Identity()).norm() <= accuracy);
      const lorentz::Matrix square = s.of_square([](double e) { return e; });
      CHECK((s.f * s.f - square).norm() <= accuracy * square.norm());
      const lorentz::Matrix inverse = s.of_square([](double e) { return 1.0 / e; });
      CHECK((s.f_inverse * s.f_inverse - inverse).norm() <= accuracy * inverse.norm());
    }
  lorentz::Scaling s;
  REQUIRE(lorentz::scale({4.0, 0.0, 0.0}, {9.0, 0.0, 0.0}, true, s));
  CHECK(s.lambda[0] == Approx(6.0));
  CHECK(s.f(0, 0) == Approx(1.5));
  CHECK_FALSE(lorentz::scale({1.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, false, s));
}

TEST_CASE("the Jordan product and its division undo each other") {
  Random random(6);
  for (int k = 0; k < 50; ++k) {
    const Vector x = inside(random, 0.5), y = inside(random, -0.5);
    CHECK((lorentz::divide(x, lorentz::product(x, y)) - y).norm() <= 1e-12 * y.norm());
  }
}

TEST_CASE("the longest step ends on the cone's side, or at its limit") {
  Random random(7);
  int ended = 0;
  for (int k = 0; k < 200; ++k) {
    const Vector x = inside(random, 0.3);
    const Vector d =
        x.norm() * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double t = lorentz::longest_step(x, d, 2.0);
    CHECK(t > 0.0);
    for (const double part : {0.25, 0.5, 0.999}) CHECK(lorentz::depth(x + part * t * d) > 0.0);
    if (t == 2.0) continue;
    ++ended;
    CHECK(std::abs(lorentz::depth(x + t * d)) <= 1e-7 * x.norm());
  }
  CHECK(ended > 50);
  CHECK(lorentz::longest_step({2.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 5.0) == Approx(2.0));
  CHECK(lorentz::longest_step({2.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5.0) == 5.0);
}
