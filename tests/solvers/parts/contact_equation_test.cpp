#include "solvers/parts/contact_equation.hpp"

#include <cmath>

#include "platform/random.hpp"
#include "problems/algebra/friction_cone.hpp"
#include "tests/catch.hpp"

using namespace ballast;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

const ContactEquation equations[] = {ContactEquation::alart_curnier,
                                     ContactEquation::fischer_burmeister};

Vector3d random_vector(Random& random, double size) {
  return Vector3d(random.uniform(-size, size), random.uniform(-size, size),
                  random.uniform(-size, size));
}

/// A pair r, u that obeys the law: open, sticking or slipping for `kind` 0, 1, 2.
void lawful(Random& random, double mu, int kind, Vector3d& r, Vector3d& u) {
  r = u = Vector3d::Zero();
  const double angle = random.uniform(0.0, 6.283), n = random.uniform(0.1, 2.0);
  const Vector3d side(0.0, std::cos(angle), std::sin(angle));
  if (kind == 0) u = Vector3d(n, random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
  if (kind == 1) r = Vector3d(n, 0.0, 0.0) + 0.9 * mu * n * random.uniform() * side;
  if (kind == 2) {
    r = Vector3d(n, 0.0, 0.0) + mu * n * side;
    u = -random.uniform(0.1, 1.0) * side;
  }
}

}  // namespace

TEST_CASE("every contact equation vanishes exactly where the law holds") {
  Random random(5);
  for (const ContactEquation equation : equations)
    for (int i = 0; i < 3000; ++i) {
      const double mu = i % 5 == 0 ? 0.0 : random.uniform(0.05, 2.0),
                   rho = random.uniform(0.1, 10.0);
      Vector3d r, u;
      lawful(random, mu, i % 3, r, u);
      CHECK(linearise(equation, r, u, mu, rho).f.norm() < 1e-7);  // FB: root of rounding errors
      r += random_vector(random, 0.5);
      u += random_vector(random, 0.5);
      const double natural = natural_map(r, u, mu, 1.0).norm();
      const double value = linearise(equation, r, u, mu, rho).f.norm();
      // Both are small or large together, within a factor that rho and 1/mu^2 may reach.
      CHECK(value < 1e4 * (natural + 1e-7));
      CHECK(natural < 1e4 * (value + 1e-7));
    }
}

TEST_CASE("derivatives of the contact equations, by differences") {
  Random random(11);
  const double step = 1e-6;
  for (const ContactEquation equation : equations) {
    int rough = 0;  // kinks within the difference
    for (int i = 0; i < 3000; ++i) {
      const double mu = i % 7 == 0 ? 0.0 : random.uniform(0.1, 1.5), rho = random.uniform(0.2, 5.0);
      const Vector3d r = random_vector(random, 1.0), u = random_vector(random, 1.0);
      const ContactLinearisation l = linearise(equation, r, u, mu, rho);
      Matrix3d df_dr, df_du;
      for (int k = 0; k < 3; ++k) {
        const Vector3d e = step * Vector3d::Unit(k);
        df_dr.col(k) =
            (linearise(equation, r + e, u, mu, rho).f - linearise(equation, r - e, u, mu, rho).f) /
            (2.0 * step);
        df_du.col(k) =
            (linearise(equation, r, u + e, mu, rho).f - linearise(equation, r, u - e, mu, rho).f) /
            (2.0 * step);
      }
      rough += (df_dr - l.df_dr).norm() > 1e-4 * (1.0 + df_dr.norm()) ||
               (df_du - l.df_du).norm() > 1e-4 * (1.0 + df_du.norm());
    }
    CHECK(rough <= 5);
  }
}

namespace {

Vector3d centred_vector(Random& random) {
  return {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
}

constexpr double epsilon = 1e-2, friction = 0.5, rho = 0.5;

}  // namespace

TEST_CASE("where u_N = 0 the step is Newton's on Alart and Curnier's function") {
  // There the two radii of the disc, mu r_N and mu z_N, are equal. dr solves
  //   F + df_dr dr + df_du (du + epsilon_c dr) = 0.
  Random random(7);
  int slips = 0, sticks = 0;
  for (int k = 0; k < 400; ++k) {
    Vector3d r = centred_vector(random), u = 4.0 * centred_vector(random);
    const Vector3d du = centred_vector(random);
    r[0] = std::abs(r[0]) + 0.1;
    u[0] = 0.0;
    const RegularStep step = regular_step(friction, rho, epsilon, r, u);
    const ContactLinearisation l = linearise(ContactEquation::alart_curnier, r, u, friction, rho);
    const Vector3d dr = step.source - step.gain * du;
    const Vector3d left = l.f + l.df_dr * dr + l.df_du * (du + epsilon / rho * dr);
    CHECK(left.norm() < 1e-12);
    slips += step.status == ContactStatus::slip;
    sticks += step.status == ContactStatus::stick;
  }
  CHECK(slips > 50);
  CHECK(sticks > 10);
}

TEST_CASE("a slipping step ends at u_N = 0 and on the edge of the disc, which moves with r_N") {
  Random random(11);
  int slips = 0;
  for (int k = 0; k < 200; ++k) {
    Vector3d r = centred_vector(random);
    r[0] = std::abs(r[0]) + 0.1;
    const Vector3d u = 4.0 * centred_vector(random), du = centred_vector(random);
    const RegularStep step = regular_step(friction, rho, epsilon, r, u);
    if (step.status != ContactStatus::slip) continue;
    ++slips;
    const Vector3d dr = step.source - step.gain * du, after = r + dr;
    const Vector3d z = r - rho * u;
    const double compliance = epsilon / rho;
    CHECK(std::abs(u[0] + du[0] + compliance * dr[0]) < 1e-12);
    const double along = (z[1] * after[1] + z[2] * after[2]) / std::hypot(z[1], z[2]);
    CHECK(along == Approx(friction * after[0]).margin(1e-9));
  }
  CHECK(slips > 50);
}

TEST_CASE("an open contact loses its impulse, whatever the bodies do") {
  const RegularStep step = regular_step(friction, rho, epsilon, {0.1, 0.2, -0.1}, {1.0, 0.3, 0.0});
  CHECK(step.status == ContactStatus::open);
  CHECK(step.source == Vector3d(-0.1, -0.2, 0.1));
  CHECK(step.gain.isZero(0.0));
}

TEST_CASE("a half-line has no tangential impulse, also where all is at rest") {
  const RegularStep step = regular_step(0.0, rho, epsilon, {1.0, 0.25, 0.5}, {-0.5, 0.0, 0.0});
  CHECK(step.source == Vector3d(0.5 * rho / epsilon, -0.25, -0.5));
  CHECK(step.gain.bottomRows<2>().isZero(0.0));
  CHECK(step.gain(0, 0) == rho / epsilon);
}

TEST_CASE("a slipping contact that is pulled keeps a gain that is not negative") {
  // r_N < 0: the disc is empty, and kappa is zero.
  const RegularStep step = regular_step(friction, rho, epsilon, {-0.1, 0.0, 0.1}, {-1.0, 2.0, 0.0});
  CHECK(step.status == ContactStatus::slip);
  const Matrix3d symmetric = 0.5 * (step.gain + step.gain.transpose());
  CHECK(step.gain.block<2, 2>(1, 1).isZero(0.0));
  CHECK(symmetric(0, 0) > 0.0);
  // r_N is large: kappa is limited to one.
  const RegularStep held = regular_step(friction, rho, epsilon, {10.0, 0.0, 0.1}, {19.0, 2.0, 0.0});
  REQUIRE(held.status == ContactStatus::slip);
  CHECK(held.gain(2, 2) <= rho / epsilon * (1.0 + 1e-12));
  CHECK(held.gain(2, 2) >= 0.0);
}
