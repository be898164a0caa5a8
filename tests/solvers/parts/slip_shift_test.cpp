#include "solvers/parts/slip_shift.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

/// Solves the convex problem with fixed s by projected gradients: slow and simple.
void solve_convex(ContactOperator& w, const SlipShift& shift, Impulses& r, Eigen::VectorXd& u) {
  for (int k = 0; k < 20000; ++k) {
    w.velocity(r, u);
    const Impulses before = r;
    for (int c = 0; c < w.contact_count(); ++c)
      w.put(r, c, w.at(r, c) - 0.3 * w.rho()[c] * shift.shifted(w, u, c));
    w.project(r);
    if ((r - before).norm() <= 1e-15 * r.norm()) break;
  }
  w.velocity(r, u);
}

}  // namespace

TEST_CASE(
    "at a solution of Coulomb's law s is its own image, and the convex problem has the same "
    "solution") {
  const KnownSolution known = make_known_solution({.bodies = 20, .contacts = 15});
  ContactOperator w;
  w.prepare(known.problem);
  SlipShift shift;
  shift.reset(w);
  CHECK(shift.distance(w, known.u) > 1e-3);
  shift.follow(w, known.u);
  CHECK(shift.distance(w, known.u) == 0.0);
  for (int c = 0; c < w.contact_count(); ++c) {
    const Eigen::Vector3d r = w.at(known.r, c), g = shift.shifted(w, known.u, c);
    CHECK((project_cone(r - g, w.friction(c)) - r).norm() <= 1e-12 * (1.0 + r.norm()));
  }
}

TEST_CASE("convex solves with improved s reach Coulomb's law") {
  const KnownSolution known = make_known_solution({.bodies = 20, .contacts = 15});
  ContactOperator w;
  w.prepare(known.problem);
  SlipShift shift;
  shift.reset(w);
  Impulses r = Impulses::Zero(known.problem.row_count());
  Eigen::VectorXd u;
  solve_convex(w, shift, r, u);
  CHECK(contact_error(known.problem, r).natural_map_rms >
        1e-3);  // the convex relaxation is another law
  int outer = 0;
  while (shift.distance(w, u) > 1e-10 && ++outer < 60) {
    shift.improve(w, u);
    solve_convex(w, shift, r, u);
  }
  CHECK(outer < 60);
  CHECK(contact_error(known.problem, r).natural_map_rms < 1e-9);
}

TEST_CASE("a linear fixed point of n unknowns is found in n + 1 combinations") {
  constexpr int n = 5;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    a(i, i) = 0.5 + 0.1 * i;  // plain iterations contract by 0.9
    if (i > 0) a(i, i - 1) = 0.3;
  }
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
  const Eigen::VectorXd exact = oracle::dense_solution(Eigen::MatrixXd::Identity(n, n) - a, b);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  Anderson mixing;
  mixing.reset(n);
  for (int k = 0; k < n + 2; ++k) mixing.step(x, a * x + b);
  CHECK((x - exact).norm() < 1e-4 * exact.norm());
  mixing.forget();
  const Eigen::VectorXd image = a * x + b;
  mixing.step(x, image);
  CHECK(x == image);  // without memory it is the plain step
}
