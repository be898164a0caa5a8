#include "solvers/parts/cone_step.hpp"

#include <algorithm>

#include "platform/random.hpp"
#include "problems/algebra/friction_cone.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;
using lorentz::Vector;

namespace {

/// A problem with its operator, s = 0, and a point well inside all cones.
struct Trial {
  FrictionProblem problem;
  ContactOperator w;
  SlipShift shift;
  ConePoint point;
  Eigen::VectorXd u;

  explicit Trial(FrictionProblem given) : problem(std::move(given)) {
    w.prepare(problem);
    shift.reset(w);
    point.r.setZero(problem.row_count());
    point.g.setZero(problem.row_count());
    for (int c = 0; c < w.contact_count(); ++c) {
      const double mu = w.friction(c);
      w.put(point.g, c, {1.0 + mu, 0.1 * mu, 0.0});
      if (w.rho()[c] > 0.0) w.put(point.r, c, {w.rho()[c] * (mu > 0.0 ? 1.0 / mu : 1.0), 0.0, 0.0});
    }
    w.velocity(point.r, u);
  }

  /// Least distance from the sides of the cones, over the contacts that move.
  double depth() const {
    double least = 1e300;
    for (int c = 0; c < w.contact_count(); ++c) {
      if (!(w.rho()[c] > 0.0)) continue;
      const double mu = w.friction(c);
      const Eigen::Vector3d r = w.at(point.r, c), g = w.at(point.g, c);
      least = std::min(least, mu * r[0] - tangential_norm(r) + (mu > 0.0 ? 0.0 : r[0]));
      least = std::min(least, g[0] - mu * tangential_norm(g));
    }
    return least;
  }
  /// sum r . g over contacts, which is that of x . z [J].
  double product() const {
    double sum = 0.0;
    for (int c = 0; c < w.contact_count(); ++c)
      if (w.rho()[c] > 0.0) sum += w.at(point.r, c).dot(w.at(point.g, c));
    return sum;
  }
};

/// Inside the cone, at a relative distance `depth` from its side.
Vector inside(Random& random, double depth) {
  const double angle = random.uniform(0.0, 6.28), size = random.log_uniform(1e-3, 1e3);
  return size * Vector(1.0 + depth, std::cos(angle), std::sin(angle));
}

}  // namespace

TEST_CASE("the barrier is the mean of r . g over the contacts that move", "[factors]") {
  Trial trial(oracle::mixed_problem());  // 7 contacts, of which one does not move
  ConeStep step;
  step.prepare(trial.w);
  REQUIRE(step.factor(trial.point));
  CHECK(step.moving_contacts() == 6);
  CHECK(step.barrier() == Approx(trial.product() / 6.0));
}

TEST_CASE("steps stay inside the cones and come to the convex problem's solution", "[factors]") {
  for (const FrictionProblem& problem :
       {oracle::mixed_problem(), make_known_solution({.bodies = 20, .contacts = 50}).problem}) {
    Trial trial(problem);
    ConeStep step({.to_boundary = 0.99});
    step.prepare(trial.w);
    const double begin = trial.product();
    const double begin_error = trial.shift.convex_error(trial.w, trial.point.r, trial.u);
    int steps = 0;
    while (trial.product() > 1e-6 * begin && steps < 60) {
      REQUIRE(step.factor(trial.point));
      REQUIRE(step.advance(trial.shift, trial.u, trial.point));
      trial.w.velocity(trial.point.r, trial.u);
      CHECK(trial.depth() > 0.0);
      ++steps;
    }
    CHECK(steps < 40);
    CHECK(trial.shift.convex_error(trial.w, trial.point.r, trial.u) < 1e-2 * begin_error);
  }
}

TEST_CASE("a point on a cone's side is refused", "[factors]") {
  Trial trial(make_known_solution({.bodies = 6, .contacts = 3}).problem);
  ConeStep step;
  step.prepare(trial.w);
  int c = 0;
  while (!(trial.w.friction(c) > 0.0)) ++c;
  trial.w.put(trial.point.r, c, {1.0, trial.w.friction(c), 0.0});
  CHECK_FALSE(step.factor(trial.point));
}

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
