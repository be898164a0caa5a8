// Records of contacts against what their definitions say, written out in plain loops and dense
// matrices.

#include "solvers/gauss_seidel/sweep_record.hpp"

#include "problems/algebra/contact_error.hpp"
#include "tests/catch.hpp"
#include "tests/solvers/gauss_seidel/record_samples.hpp"

using namespace ballast;

TEST_CASE("a record's rows and bias give the velocity of its principal coordinates") {
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const samples::Given given(random);
    FrictionRecord record = given.record();
    TangentTurn turn;
    double lambda_max = 0.0;
    make_principal(record, given.mu, turn, lambda_max);

    const Eigen::Matrix3d w = given.h * given.h.transpose();
    CHECK(lambda_max == Approx(largest_eigenvalue(w)));
    CHECK(record.local.inverse_normal == Approx(1.0 / w(0, 0)));
    const samples::Twelve v = samples::Twelve::Random();
    const Eigen::Vector3d u = given.h * v + given.bias;
    double t1 = u[1], t2 = u[2];
    turn.to_principal(t1, t2);
    const Eigen::Vector3d expected(u[0], t1 - record.local.c1 * u[0], t2 - record.local.c2 * u[0]);
    CHECK((samples::velocity(record, v) - expected).norm() <= 1e-12 * (1.0 + expected.norm()));
    // In these coordinates W is diagonal.
    const Eigen::Matrix<double, 3, 12> rows = samples::rows(record);
    const Eigen::Matrix3d diagonal = rows * rows.transpose();
    const Eigen::Vector3d known(1.0 / record.local.inverse_normal, record.local.s1,
                                record.local.s2);
    CHECK((diagonal - Eigen::Matrix3d(known.asDiagonal())).norm() <= 1e-12 * w.norm());
  }
}

TEST_CASE("an impulse goes into a record and the bodies, and comes out again") {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const samples::Given given(random);
    FrictionRecord record = given.record();
    TangentTurn turn;
    double lambda_max = 0.0;
    make_principal(record, given.mu, turn, lambda_max);
    const Eigen::Vector3d r = Eigen::Vector3d::Random();
    FrictionImpulse impulse{};
    BodyVelocity bodies[2] = {};
    load_impulse(record, turn, r.data(), impulse, bodies);
    CHECK((samples::both(bodies) - given.h.transpose() * r).norm() <= 1e-12 * given.h.norm());
    Eigen::Vector3d back;
    store_impulse(record, turn, impulse, back.data());
    CHECK((back - r).norm() <= 1e-14);
    const Eigen::Vector3d u = given.h * samples::both(bodies) + given.bias;
    CHECK(natural_map(record, impulse, lambda_max, bodies) ==
          Approx(ContactJudge::scaled_natural_map(r, u, given.mu, lambda_max)).margin(1e-12));
  }
}

TEST_CASE("a record of one row: its scale, its impulse, its error") {
  OneRowRecord record{};
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < row_width; ++i) record.rows[s][i] = s == 0 ? 1.0 : -2.0;
  record.bias = -0.5;
  record.body[1] = 1;
  double lambda_max = 0.0;
  make_principal(record, lambda_max);
  CHECK(lambda_max == 6 * (1.0 + 4.0));
  CHECK(record.inverse_normal == 1.0 / 30.0);
  const double r = 0.1;
  double impulse = 0.0;
  BodyVelocity bodies[2] = {};
  load_impulse(record, &r, impulse, bodies);
  CHECK(impulse == r);
  CHECK(bodies[0].w[5] == Approx(0.1));
  CHECK(bodies[1].w[0] == Approx(-0.2));
  CHECK(bodies[1].w[6] == 0.0);
  // u = 30 * 0.1 - 0.5 = 2.5 > 0: the natural map is r lambda, as far as u allows.
  CHECK(natural_map(record, impulse, lambda_max, bodies) == Approx(2.5));
}

TEST_CASE("an impulse on what nothing moves is dropped") {
  const samples::Nothing nothing;
  TangentTurn turn;
  double lambda_max = 1.0;
  FrictionRecord record = nothing.friction;
  make_principal(record, 0.5, turn, lambda_max);
  CHECK(lambda_max == 0.0);
  const double r[3] = {1.0, 0.2, 0.3};
  FrictionImpulse impulse{};
  BodyVelocity bodies[2] = {};
  load_impulse(record, turn, r, impulse, bodies);
  for (const double y : impulse.y) CHECK(y == 0.0);
  OneRowRecord one{};
  make_principal(one, lambda_max);
  CHECK(one.inverse_normal == 0.0);
}
