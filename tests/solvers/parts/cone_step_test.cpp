#include "solvers/parts/cone_step.hpp"

#include <algorithm>

#include "problems/algebra/friction_cone.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

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
