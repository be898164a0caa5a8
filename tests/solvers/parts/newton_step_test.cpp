#include "solvers/parts/newton_step.hpp"

#include "platform/random.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/pile_problems.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

KnownSolution regular() { return make_known_solution({.bodies = 40, .contacts = 30}); }

/// Blocks without a pattern, regular together with alpha; nothing presses this share of the
/// contacts.
std::vector<ContactLinearisation> some_blocks(const FrictionProblem& problem, double idle = 0.0) {
  std::vector<ContactLinearisation> linear(problem.contact_count());
  double next = 0.41;  // logistic map
  const auto number = [&next] { return (next = 3.99 * next * (1.0 - next)) - 0.5; };
  for (int c = 0; c < problem.contact_count(); ++c) {
    ContactLinearisation& l = linear[c];
    for (double& x : l.f) x = number();
    for (double& x : l.by_r.reshaped()) x = 0.3 * number();
    for (double& x : l.by_u.reshaped()) x = 0.3 * number();
    l.by_r.diagonal().array() += 1.0;
    l.by_u.diagonal().array() += 1.0;
    if (number() + 0.5 < idle) l.by_u.setZero();
    if (problem.contact_rows(c) == 3) continue;
    l.f.tail<2>().setZero();  // one row: padded
    l.by_r = Eigen::Vector3d(l.by_r(0, 0), 1.0, 1.0).asDiagonal();
    l.by_u = Eigen::Vector3d(l.by_u(0, 0), 0.0, 0.0).asDiagonal();
  }
  return linear;
}

/// (by_r + by_u (W + alpha)) dr + f, in dense matrices.
double residual(const FrictionProblem& problem, const Eigen::MatrixXd& w,
                const std::vector<ContactLinearisation>& linear, const std::vector<double>& alpha,
                const Impulses& dr) {
  const Eigen::VectorXd du = w * dr;
  double sum = 0.0;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int begin = problem.row_begin[c], rows = problem.contact_rows(c);
    const Eigen::VectorXd r = dr.segment(begin, rows), u = du.segment(begin, rows);
    const Eigen::VectorXd left = linear[c].by_r.topLeftCorner(rows, rows) * r +
                                 linear[c].by_u.topLeftCorner(rows, rows) * (u + alpha[c] * r) +
                                 linear[c].f.head(rows);
    sum += left.squaredNorm();
  }
  return std::sqrt(sum);
}

/// One set of blocks after another: the pattern stays. `w`: of the whole problem.
void check_solves(const FrictionProblem& problem, const Eigen::MatrixXd& w,
                  const std::vector<ContactLinearisation>& linear) {
  ContactOperator op;
  op.prepare(problem);
  NewtonSystem system;
  system.prepare(op);
  for (const double weight : {1e-2, 1.0}) {
    const std::vector<double> alpha(problem.contact_count(), weight);
    Impulses dr;
    REQUIRE(system.solve(op, linear, alpha, dr));
    CHECK(residual(problem, w, linear, alpha, dr) <= 1e-10 * (1.0 + dr.norm()));
    CHECK(dr.norm() > 0.0);
  }
}

FrictionProblem stored_pile(int contacts, double redundancy) {
  return make_pile({.contacts = contacts, .redundancy = redundancy, .is_stored = true});
}

}  // namespace

TEST_CASE("the residual is zero at the solution, and the iterate stays there", "[factors]") {
  const KnownSolution known = regular();
  NewtonStep step;
  step.prepare(known.problem);
  step.begin(ContactEquation::alart_curnier, 1.0, known.r);
  step.set_proximal(1e-3);
  CHECK(step.residual() <= 1e-12);
  CHECK(step.error() <= 1e-12);
  step.newton(8);
  CHECK((step.impulses() - known.r).norm() <= 1e-8 * known.r.norm());
}

TEST_CASE("Newton steps near the solution are quadratic, and the error is the judge's",
          "[factors]") {
  const KnownSolution known = regular();
  NewtonStep step;
  step.prepare(known.problem);
  step.begin(ContactEquation::alart_curnier, 1.0, 1.001 * known.r);
  step.set_proximal(1e-5);
  CHECK(step.error() == Approx(contact_error(known.problem, 1.001 * known.r).natural_map_rms));
  const double begin = step.residual();
  for (int k = 0; k < 2; ++k) {  // 4e-3, 4e-7, then rounding / alpha
    CHECK(step.newton(8));
    step.centre();
  }
  CHECK(step.residual() <= 1e-7 * begin);
  CHECK(step.error() <= 1e-9);
}

TEST_CASE("a proximal term pulls towards the centre", "[factors]") {
  const KnownSolution known = regular();
  NewtonStep step;
  step.prepare(known.problem);
  const auto moved = [&](double weight) {
    step.begin(ContactEquation::alart_curnier, 1.0, 1.001 * known.r);
    step.set_proximal(weight);
    for (int k = 0; k < 10; ++k) step.newton(8);
    return (step.impulses() - 1.001 * known.r).norm();
  };
  const double free = moved(1e-7), held = moved(1e3);
  CHECK(free == Approx((0.001 * known.r).norm()).epsilon(0.5));
  CHECK(held < 0.1 * free);
  CHECK(held > 0.0);
}

TEST_CASE("restart goes where it is told; what nothing moves loses its impulse", "[factors]") {
  const FrictionProblem problem = oracle::mixed_problem();  // contact 4: nothing moves
  NewtonStep step;
  step.prepare(problem);
  const Impulses r = Impulses::Constant(problem.row_count(), 0.3);
  step.begin(ContactEquation::alart_curnier, 1.0, r);
  Impulses expected = r;
  expected.segment(problem.row_begin[4], 3).setZero();
  CHECK(step.impulses() == expected);
  const double begin = step.residual();
  step.restart(2.0 * expected);
  CHECK(step.impulses() == 2.0 * expected);
  CHECK(step.residual() != begin);
  step.restart(expected);
  CHECK(step.residual() == begin);
}

TEST_CASE("a Newton system is solved in both forms, for one set of blocks after another",
          "[factors]") {
  for (const FrictionProblem& dynamics :
       {make_known_solution({.contacts = 80}).problem, oracle::mixed_problem()}) {
    const Eigen::MatrixXd w = oracle::dense_delassus(dynamics);
    std::vector<ContactLinearisation> linear = some_blocks(dynamics);
    for (const bool has_dynamics : {true, false}) {
      const FrictionProblem problem = has_dynamics ? dynamics : only_delassus(dynamics);
      CAPTURE(has_dynamics);
      check_solves(problem, w, linear);
    }
  }
}

TEST_CASE("without alpha the stored form takes blocks that the dynamics form cannot", "[factors]") {
  // A sticking contact: by_r = 0, and B = alpha by_u is singular for alpha = 0.
  const FrictionProblem dynamics = make_known_solution({.bodies = 6, .contacts = 3}).problem;
  const std::vector<ContactLinearisation> stick(
      3, {Eigen::Vector3d::Ones(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity()});
  const std::vector<double> none(3, 0.0);
  Impulses dr;
  for (const bool has_dynamics : {true, false}) {
    const FrictionProblem problem = has_dynamics ? dynamics : only_delassus(dynamics);
    ContactOperator op;
    op.prepare(problem);
    NewtonSystem system;
    system.prepare(op);
    CHECK(system.solve(op, stick, none, dr) == !has_dynamics);
  }
}

TEST_CASE("Newton's system of a stored W: few rows, nearly full, sparse, one row, unsymmetric",
          "[factors]") {
  KnownSolutionSettings settings;
  settings.frictionless_fraction = 0.4;
  FrictionProblem unsymmetric = only_delassus(make_known_solution(settings).problem);
  for (int i = 0; i < unsymmetric.delassus.w.nonZeros(); i += 3)
    unsymmetric.delassus.w.valuePtr()[i] *= 1.05;
  // Dense: few rows; dense: W is nearly full; sparse.
  for (const FrictionProblem& problem :
       {stored_pile(30, 0.5), stored_pile(150, 0.8), stored_pile(200, 0.0), unsymmetric})
    for (const double idle : {0.0, 0.4, 1.0}) {
      INFO("share of idle contacts " << idle);
      check_solves(problem, Eigen::MatrixXd(problem.delassus.w), some_blocks(problem, idle));
    }
}

TEST_CASE("A singular system of a stored W is said to be so", "[factors]") {
  const FrictionProblem problem = stored_pile(5, 0.0);
  std::vector<ContactLinearisation> linear = some_blocks(problem);
  for (ContactLinearisation& l : linear) l.by_r = l.by_u = Eigen::Matrix3d::Zero();
  ContactOperator op;
  op.prepare(problem);
  NewtonSystem system;
  system.prepare(op);
  Impulses dr;
  CHECK_FALSE(system.solve(op, linear, std::vector<double>(problem.contact_count(), 0.1), dr));
}
