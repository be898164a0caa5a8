#include "problems/algebra/answer_distance.hpp"

#include "platform/random.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

/// A wall of 2 kg that would move at 1 m/s into a stop. An impulse of 2 N s holds it.
FrictionProblem pressed_wall() {
  FrictionProblem problem;
  problem.has_dynamics = true;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  const int wall = problem.dynamics.add_body(2.0 * one);
  problem.add_contact(-1, wall, 0.0, {}, one);
  problem.dynamics.v_free = Eigen::VectorXd::Constant(1, -1.0);
  problem.dynamics.bias = Eigen::VectorXd::Zero(1);
  return problem;
}

}  // namespace

TEST_CASE("The distance of a wall's answer is what one computes by hand") {
  const FrictionProblem p = pressed_wall();
  CHECK(driven_wall(p) == 0);
  const Impulses solution = Impulses::Constant(1, 2.0), half = Impulses::Constant(1, 1.0);
  const AnswerDistance d = answer_distance(p, half, solution);
  CHECK(d.velocity == Approx(0.5));
  CHECK(d.contact_velocity == Approx(0.5));
  CHECK(d.body_impulse == Approx(0.5));
  CHECK(d.wall_force == Approx(0.5));
  CHECK(d.statuses == 0);
  CHECK(answer_distance(p, half, solution, 10.0).velocity == Approx(0.05));
  CHECK(answer_distance(p, half, solution, 10.0).body_impulse == Approx(0.5));
  CHECK(answer_distance(p, solution, solution).wall_force == 0.0);
}

TEST_CASE("Distances are those of dense matrices, with bodies and with W alone") {
  const KnownSolution known = make_known_solution({.mass_ratio = 100.0, .seed = 4});
  const FrictionProblem& p = known.problem;
  Random random(9);
  Impulses r = known.r;
  for (double& x : r) x += 0.1 * random.uniform(-1, 1);
  const Eigen::MatrixXd w = oracle::dense_delassus(p), m = oracle::dense_mass(p),
                        h = oracle::dense_h(p);
  const Eigen::VectorXd dr = r - known.r, dv = oracle::dense_solution(m, h.transpose() * dr);
  double mass = 0.0;
  for (int b = 0; b < p.dynamics.body_count(); ++b)
    mass += m(p.dynamics.dof_begin[b], p.dynamics.dof_begin[b]);
  const AnswerDistance d = answer_distance(p, r, known.r);
  CHECK(d.velocity == Approx(std::sqrt(dv.dot(m * dv) / mass)));
  CHECK(d.contact_velocity == Approx((w * dr).norm() / std::sqrt(p.contact_count())));
  CHECK(d.body_impulse == Approx(std::sqrt(dr.dot(w * dr) / known.r.dot(w * known.r))));
  CHECK(std::isnan(d.wall_force));
  CHECK(d.statuses > 0);
  const AnswerDistance stored = answer_distance(only_delassus(p), r, known.r);
  CHECK(std::isnan(stored.velocity));
  CHECK(stored.body_impulse == Approx(d.body_impulse));
  CHECK(stored.contact_velocity == Approx(d.contact_velocity));
  CHECK(stored.statuses == d.statuses);
}

TEST_CASE("Impulses that no body feels are no distance") {
  KnownSolution known = make_known_solution({.frictionless_fraction = 0.0, .seed = 5});
  FrictionProblem p = known.problem;
  repeat_contacts(p, 2);
  Impulses even(p.row_count()), uneven(p.row_count());
  for (int c = 0; c < known.problem.contact_count(); ++c) {
    const Eigen::Vector3d r = known.r.segment<3>(3 * c);
    even.segment<3>(6 * c) = even.segment<3>(6 * c + 3) = 0.5 * r;
    uneven.segment<3>(6 * c) = 0.6 * r;
    uneven.segment<3>(6 * c + 3) = 0.4 * r;
  }
  REQUIRE((even - uneven).norm() > 0.01);
  const AnswerDistance d = answer_distance(p, uneven, even);
  CHECK(d.velocity < 1e-13);
  CHECK(d.body_impulse < 1e-7);  // the square root of a difference of rounded squares
  CHECK(d.statuses == 0);
}

TEST_CASE("Without a solution there is no distance") {
  const AnswerDistance d = answer_distance(pressed_wall(), Impulses::Zero(1), {});
  CHECK(std::isnan(d.velocity));
  CHECK(d.statuses == -1);
  CHECK_THROWS_AS(answer_distance(pressed_wall(), Impulses::Zero(2), Impulses::Zero(1)),
                  InvalidProblem);
}
