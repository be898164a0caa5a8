// The judge's blocks against the functions for one contact.

#include "problems/algebra/judge_block.hpp"

#include <memory>

#include "platform/random.hpp"
#include "problems/algebra/contact_error.hpp"
#include "tests/catch.hpp"

using namespace ballast;
using Eigen::Vector3d;

namespace {

/// Between 10^-spread and 10^spread, or 0 now and then.
double some(Random& random, double spread) {
  if (random.below(12) == 0) return 0.0;
  return random.uniform(-1, 1) * std::pow(10.0, random.uniform(-spread, spread));
}

/// A contact with or without friction, open, sticking or slipping; sometimes on the very cone.
void fill(JudgeBlock& b, int k, Random& random) {
  const bool one_row = random.below(4) == 0;
  b.mu[k] = one_row                ? 0.0
            : random.below(5) == 0 ? 1e4 * random.uniform(0, 1)
                                   : random.uniform(0, 2);
  Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr([&] { return some(random, 2.0); });
  if (random.below(5) == 0) root = root.diagonal().asDiagonal();
  if (random.below(20) == 0) root.setZero();
  const Eigen::Matrix3d w = root * root.transpose();
  b.nn[k] = w(0, 0);
  b.tn[k] = one_row ? 0.0 : w(1, 0);
  b.sn[k] = one_row ? 0.0 : w(2, 0);
  b.tt[k] = one_row ? 0.0 : w(1, 1);
  b.st[k] = one_row ? 0.0 : w(2, 1);
  b.ss[k] = one_row ? 0.0 : w(2, 2);
  for (int i = 0; i < 3; ++i) {
    const bool is_row = i == 0 || !one_row;
    b.r[i][k] = is_row ? some(random, 3.0) : 0.0;
    b.u[i][k] = is_row ? some(random, 3.0) : 0.0;
    b.q[i][k] = is_row ? some(random, 3.0) : 0.0;
  }
  if (random.below(3) == 0) b.r[0][k] = std::hypot(b.r[1][k], b.r[2][k]) / std::max(b.mu[k], 0.1);
}

}  // namespace

TEST_CASE("a block of contacts is judged as one contact after another is, bit for bit") {
  Random random(77);
  const auto block = std::make_unique<JudgeBlock>();
  JudgeBlock& b = *block;
  int unmovable = 0, outside = 0, inside = 0;
  for (int round = 0; round < 300; ++round) {
    for (int k = 0; k < JudgeBlock::size; ++k) fill(b, k, random);
    measure(b);
    for (int k = 0; k < JudgeBlock::size; ++k) {
      const double mu = b.mu[k];
      const Vector3d r(b.r[0][k], b.r[1][k], b.r[2][k]), u(b.u[0][k], b.u[1][k], b.u[2][k]),
          q(b.q[0][k], b.q[1][k], b.q[2][k]);
      Eigen::Matrix3d w;
      w << b.nn[k], b.tn[k], b.sn[k], b.tn[k], b.tt[k], b.st[k], b.sn[k], b.st[k], b.ss[k];
      const double lambda = largest_eigenvalue(w);
      const double rho = lambda > 0.0 ? 1.0 / lambda : 0.0;
      const Vector3d modified = modified_velocity(u, mu);
      const double beyond = (r - project_cone(r, mu)).norm(), work = std::abs(r.dot(modified));
      const double against = r.norm() + rho * modified.norm();
      REQUIRE(b.lambda[k] == lambda);
      if (lambda > 0.0)
        REQUIRE(b.scaled_map[k] == ContactJudge::scaled_natural_map(r, u, mu, lambda));
      REQUIRE(b.map_square[k] == natural_map(r, u, mu, 1.0).squaredNorm());
      REQUIRE(b.impulse[k] == r.norm());
      REQUIRE(b.needed[k] == rho * q.norm());
      REQUIRE(b.approach[k] == std::max(0.0, -u[0]));
      REQUIRE(b.outside[k] == beyond);
      REQUIRE(b.work[k] == work);
      REQUIRE(b.unbalanced[k] == (against > 0.0 ? work / against : 0.0));
      unmovable += lambda == 0.0;
      (beyond > 0.0 ? outside : inside) += 1;
    }
  }
  CHECK(unmovable > 50);
  CHECK(outside > 1000);
  CHECK(inside > 1000);
}
