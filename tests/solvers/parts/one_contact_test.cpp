#include "solvers/parts/one_contact.hpp"

#include "platform/random.hpp"
#include "problems/algebra/contact_error.hpp"
#include "tests/catch.hpp"

using namespace ballast;
using Eigen::Matrix3d, Eigen::Vector3d;

namespace {

/// Symmetric positive definite with random axes. Its eigenvalues are `scale`, scale / condition,
/// and one between them.
Matrix3d random_w(double condition, double scale, Random& random) {
  Matrix3d a;
  for (double& x : a.reshaped()) x = random.uniform(-1, 1);
  Matrix3d axes;
  axes.col(0) = a.col(0).normalized();
  axes.col(1) = axes.col(0).cross(a.col(1)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  const Vector3d values(1.0, random.log_uniform(1.0 / condition, 1.0), 1.0 / condition);
  const Matrix3d w = scale * axes * values.asDiagonal() * axes.transpose();
  return 0.5 * (w + w.transpose());
}

/// Mostly approaching, sometimes almost purely tangential or almost purely normal.
Vector3d random_q(double scale, Random& random) {
  Vector3d q(random.uniform(-1, 0.3), random.uniform(-1, 1), random.uniform(-1, 1));
  const double kind = random.uniform();
  if (kind < 0.15) q[0] *= random.log_uniform(1e-12, 1.0);
  if (kind > 0.85) q.tail<2>() *= random.log_uniform(1e-12, 1.0);
  return scale * q;
}

double random_mu(Random& random) {
  const double kind = random.uniform();
  if (kind < 0.1) return 0.0;
  if (kind < 0.3) return random.log_uniform(1e-6, 1.0);
  return kind < 0.7 ? random.uniform() : random.uniform(0.0, 10.0);
}

/// The scaled natural map over the size of the rounding errors of u = W r + q: |q| + lambda_max
/// |r|.
double relative_error(const Matrix3d& w, const Vector3d& q, double mu, const Vector3d& r) {
  const double lambda_max = largest_eigenvalue(w);
  return ContactJudge::scaled_natural_map(r, w * r + q, mu, lambda_max) /
         (q.norm() + lambda_max * r.norm());
}

}  // namespace

TEST_CASE("a million contacts: well and badly conditioned, light and heavy, slippery and rough") {
  Random random(41);
  int count[3] = {0, 0, 0};
  double worst = 0.0;
  for (int k = 0; k < 1000000; ++k) {
    const double condition = random.log_uniform(1.0, 1e14);
    const Matrix3d w = random_w(condition, random.log_uniform(1e-20, 1e20), random);
    const Vector3d q = random_q(random.log_uniform(1e-20, 1e20), random);
    const double mu = random_mu(random);
    Vector3d r;
    double lambda = 0.0;
    ++count[static_cast<int>(solve_one_contact(w, q, mu, r, lambda))];
    const double error = relative_error(w, q, mu, r);
    REQUIRE(error <= 1e-12);
    worst = std::max(worst, error);
  }
  CAPTURE(worst);
  CHECK(count[0] > 100000);
  CHECK(count[1] > 100000);
  CHECK(count[2] > 100000);
}

TEST_CASE("the three cases are what the header says") {
  Random random(42);
  for (int k = 0; k < 100000; ++k) {
    const Matrix3d w = random_w(100.0, 1.0, random);
    const Vector3d q = random_q(1.0, random);
    const double mu = random.uniform(0.01, 2.0);
    Vector3d r;
    double lambda = 0.0;
    const ContactStatus status = solve_one_contact(w, q, mu, r, lambda);
    const Vector3d u = w * r + q;
    const double small = 1e-12 * (q.norm() + r.norm());
    if (q[0] >= 0.0) REQUIRE(status == ContactStatus::open);
    if (status == ContactStatus::open) {
      REQUIRE(r == Vector3d::Zero());
    } else if (status == ContactStatus::stick) {
      REQUIRE(u.norm() <= small);
      REQUIRE(r.tail<2>().norm() <= mu * r[0] + small);
    } else {
      REQUIRE(lambda > 0.0);
      REQUIRE(std::abs(u[0]) <= small);
      REQUIRE((u.tail<2>() + lambda * r.tail<2>()).norm() <= small);
      REQUIRE(std::abs(r.tail<2>().norm() - mu * r[0]) <= small);
    }
  }
}

TEST_CASE("a guess, good or bad, does not change a unique solution") {
  Random random(43);
  for (int k = 0; k < 50000; ++k) {
    const Matrix3d w = random_w(10.0, 1.0, random);
    const Vector3d q = random_q(1.0, random);
    const double mu = random.uniform(0.0, 0.3);  // small mu and condition of W: one solution
    Vector3d cold, warm;
    double lambda = 0.0;
    const ContactStatus status = solve_one_contact(w, q, mu, cold, lambda);
    for (double guess : {lambda, 0.5 * lambda, 1e-9, 1e9}) {
      REQUIRE(solve_one_contact(w, q, mu, warm, guess) == status);
      REQUIRE((warm - cold).norm() <= 1e-12 * (cold.norm() + q.norm()));
      REQUIRE(std::abs(guess - lambda) <= 1e-8 * (lambda + 1.0));
    }
  }
}

TEST_CASE("singular W") {
  Random random(44);
  for (int k = 0; k < 100000; ++k) {
    // Rank 1 or 2 with q in the range of W: a contact whose bodies have few unknowns.
    Eigen::Matrix<double, 3, 2> half;
    for (double& x : half.reshaped()) x = random.uniform(-1, 1);
    if (k % 2 == 0) half.col(1) *= k % 4 == 0 ? 0.0 : 1e-9;
    const Matrix3d w = half * half.transpose();
    const Vector3d q = half * Eigen::Vector2d(random.uniform(-1, 1), random.uniform(-1, 1));
    const double mu = random_mu(random);
    Vector3d r;
    double lambda = 0.0;
    solve_one_contact(w, q, mu, r, lambda);
    REQUIRE(r.allFinite());
    REQUIRE(relative_error(w, q, mu, r) <= 1e-12);
  }
}

TEST_CASE("what nothing can move is left alone") {
  Vector3d r;
  double lambda = 0.0;
  CHECK(solve_one_contact(Matrix3d::Zero(), {-1, 2, 3}, 0.5, r, lambda) == ContactStatus::open);
  CHECK(r == Vector3d::Zero());
  // Nothing moves along the normal: only the zero impulse obeys the law, whatever the tangents do.
  CHECK(solve_one_contact(Vector3d(0, 1, 2).asDiagonal(), {0, 1, 1}, 0.5, r, lambda) ==
        ContactStatus::open);
  CHECK(r == Vector3d::Zero());
}

TEST_CASE("without friction only the normal acts") {
  Vector3d r;
  double lambda = 0.0;
  const Matrix3d w = Matrix3d::Constant(0.5) + Matrix3d::Identity();
  solve_one_contact(w, {-3, 1, 1}, 0.0, r, lambda);
  CHECK(r[0] == Approx(2.0));
  CHECK(r.tail<2>() == Eigen::Vector2d::Zero());
  CHECK(lambda == 0.0);
}

TEST_CASE("next to no approach gives next to no impulse") {
  Vector3d r;
  double lambda = 0.0;
  for (const double approach : {1e-300, 1e-310, 5e-324}) {
    solve_one_contact(Matrix3d::Identity(), {-approach, 1, 1}, 0.5, r, lambda);
    CHECK(r.allFinite());
    CHECK(r.norm() <= 2e-300);
  }
}

TEST_CASE("the principal coordinates make W diagonal") {
  Random random(45);
  for (int k = 0; k < 10000; ++k) {
    const Matrix3d w = random_w(1e3, 1.0, random);
    PrincipalContact contact;
    TangentTurn turn;
    make_principal(w, 0.5, contact, turn);
    Matrix3d rotation;
    rotation << 1, 0, 0, 0, turn.cosine, turn.sine, 0, -turn.sine, turn.cosine;
    Matrix3d elimination = Matrix3d::Identity();
    elimination(1, 0) = -contact.c1;
    elimination(2, 0) = -contact.c2;
    const Matrix3d a = elimination * rotation;
    const Matrix3d expected =
        Vector3d(1.0 / contact.inverse_normal, contact.s1, contact.s2).asDiagonal();
    REQUIRE((a * w * a.transpose() - expected).norm() <= 1e-13 * (1.0 + contact.coupling_square()));
    REQUIRE(contact.s1 <= contact.s2);
    double t1 = 0.3, t2 = -0.7;
    turn.to_principal(t1, t2);
    turn.from_principal(t1, t2);
    REQUIRE(std::abs(t1 - 0.3) + std::abs(t2 + 0.7) < 1e-14);
  }
}
