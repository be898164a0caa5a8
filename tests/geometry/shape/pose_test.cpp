#include "geometry/shape/pose.hpp"

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("directions and rotations are uniform") {
  Random random(5);
  const int n = 200000;
  Vec3 direction = Vec3::Zero();
  Mat3 second = Mat3::Zero(), turned = Mat3::Zero();
  for (int i = 0; i < n; ++i) {
    const Vec3 d = random_direction(random);
    REQUIRE(std::abs(d.norm() - 1.0) < 1e-15);
    direction += d / n;
    second += d * d.transpose() / n;
    const Quat q = random_rotation(random);
    REQUIRE(std::abs(q.norm() - 1.0) < 1e-15);
    turned += q.toRotationMatrix() / n;
  }
  // Five standard errors of each mean.
  const double error = 5.0 / std::sqrt(static_cast<double>(n));
  CHECK(direction.cwiseAbs().maxCoeff() < error * 0.58);
  CHECK((second - Mat3::Identity() / 3.0).cwiseAbs().maxCoeff() < error * 0.3);
  CHECK(turned.cwiseAbs().maxCoeff() < error * 0.58);  // the mean of uniform rotations is zero
}
