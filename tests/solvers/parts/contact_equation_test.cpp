#include "solvers/parts/contact_equation.hpp"

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
