#include "problems/algebra/friction_cone.hpp"

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;
using Eigen::Vector3d;

namespace {

double random_mu(Random& random) {
  const double kind = random.uniform();
  if (kind < 0.1) return 0.0;
  return kind < 0.5 ? random.uniform() : random.uniform(0.0, 10.0);
}

Vector3d random_point(Random& random) {
  const double scale = random.log_uniform(1e-12, 1e12);
  return scale * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

/// The amount by which x is outside K_mu, by the definition of the cone.
double outside(const Vector3d& x, double mu) { return std::hypot(x[1], x[2]) - mu * x[0]; }

}  // namespace

TEST_CASE("the projection satisfies the conditions that define it") {
  Random random(11);
  for (int k = 0; k < 100000; ++k) {
    const double mu = random_mu(random);
    const Vector3d x = random_point(random), p = project_cone(x, mu), residual = x - p;
    const double size = x.norm();
    REQUIRE(p[0] >= 0.0);
    REQUIRE(outside(p, mu) <= 1e-15 * (1 + mu) * size);
    REQUIRE(std::abs(p.dot(residual)) <= 4e-15 * (1 + mu) * size * size);
    // The residual is in the polar cone {y : y . k <= 0 for all k in K}: y_N <= -mu |y_T|.
    REQUIRE(residual[0] + mu * std::hypot(residual[1], residual[2]) <= 4e-15 * (1 + mu) * size);
  }
}

TEST_CASE("Moreau: a point is its projection on the cone minus that of its opposite on the dual") {
  Random random(13);
  for (int k = 0; k < 100000; ++k) {
    const double mu = random_mu(random);
    const Vector3d x = random_point(random);
    REQUIRE((x - (project_cone(x, mu) - project_dual_cone(-x, mu))).norm() <=
            1e-14 * (1 + mu) * x.norm());
    const Vector3d d = project_dual_cone(x, mu);
    REQUIRE(d[0] >= mu * std::hypot(d[1], d[2]) * (1 - 1e-14));
  }
}

TEST_CASE("the Jacobian is the derivative wherever there is one") {
  Random random(14);
  int compared = 0;
  for (int k = 0; k < 2000; ++k) {
    const double mu = random.uniform(0.0, 3.0), h = 1e-6;
    const Vector3d x(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double t = std::hypot(x[1], x[2]);
    if (std::abs(t - mu * x[0]) < 1e-2 || std::abs(mu * t + x[0]) < 1e-2 || t < 1e-2)
      continue;  // near a kink
    const Eigen::Matrix3d jacobian = project_cone_jacobian(x, mu);
    for (int j = 0; j < 3; ++j) {
      const Vector3d step = h * Vector3d::Unit(j);
      const Vector3d difference =
          (project_cone(x + step, mu) - project_cone(x - step, mu)) / (2 * h);
      REQUIRE((jacobian.col(j) - difference).norm() < 1e-8);
    }
    REQUIRE((jacobian - jacobian.transpose()).norm() < 1e-14);
    ++compared;
  }
  REQUIRE(compared > 1500);
}

TEST_CASE("the natural map vanishes exactly on the law, for every rho") {
  const double mu = 0.5;
  for (const double rho : {1e-3, 1.0, 1e3}) {
    CHECK(natural_map({0, 0, 0}, {0.3, 2, 1}, mu, rho).norm() == 0.0);    // open
    CHECK(natural_map({2, 0.6, 0.7}, {0, 0, 0}, mu, rho).norm() == 0.0);  // sticks
    CHECK(natural_map({2, 0.6, 0.8}, {0, -3, -4}, mu, rho).norm() <=
          1e-15 * 4 * rho + 1e-15);                                         // slips
    CHECK(natural_map({2, 0.6, 0.8}, {0, 3, 4}, mu, rho).norm() > 1e-4);    // friction along slip
    CHECK(natural_map({2, 0.1, 0.1}, {0, -3, -4}, mu, rho).norm() > 1e-4);  // slips inside the cone
    CHECK(natural_map({2, 0, 0}, {0.1, 0, 0}, mu, rho).norm() > 1e-5);      // impulse while opening
    CHECK(natural_map({0, 0, 0}, {-0.1, 0, 0}, mu, rho).norm() > 1e-5);     // sinks in
    CHECK(natural_map({2, 1.2, 1.6}, {0, -3, -4}, mu, rho).norm() > 1e-4);  // outside the cone
  }
  CHECK(modified_velocity({1, 3, 4}, 0.5) == Vector3d(3.5, 3, 4));
}

TEST_CASE("A root mean square is of single values, squares and parts alike, of nothing zero") {
  RootMeanSquare whole, part, other;
  CHECK(whole.value() == 0.0);
  for (const double value : {1.0, -2.0, 4.0}) whole.add(value);
  part.add_square(1.0);
  other.add(2.0);
  other.add_square(16.0);
  part.add(other);
  CHECK(part.value() == whole.value());
  CHECK(whole.value() == Approx(std::sqrt(7.0)));
}
