#include "solvers/parts/newton_system.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/made_problems.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

/// Blocks without a pattern, regular with and without a proximal term. The share `idle` of the
/// contacts has df_du = 0.
std::vector<ContactLinearisation> some_blocks(const FrictionProblem& problem, double idle = 0.0) {
  std::vector<ContactLinearisation> linear(problem.contact_count());
  double next = 0.41;  // logistic map
  const auto number = [&next] { return (next = 3.99 * next * (1.0 - next)) - 0.5; };
  for (int c = 0; c < problem.contact_count(); ++c) {
    ContactLinearisation& l = linear[c];
    for (double& x : l.f) x = number();
    for (double& x : l.df_dr.reshaped()) x = 0.3 * number();
    for (double& x : l.df_du.reshaped()) x = 0.3 * number();
    l.df_dr.diagonal().array() += 1.0;
    l.df_du.diagonal().array() += 1.0;
    if (number() + 0.5 < idle) l.df_du.setZero();
    if (problem.contact_rows(c) == 3) continue;
    l.f.tail<2>().setZero();  // one row: padded
    l.df_dr = Eigen::Vector3d(l.df_dr(0, 0), 1.0, 1.0).asDiagonal();
    l.df_du = Eigen::Vector3d(l.df_du(0, 0), 0.0, 0.0).asDiagonal();
  }
  return linear;
}

/// The norm of (df_dr + df_du W) dr + f, by dense matrices.
double residual(const FrictionProblem& problem, const Eigen::MatrixXd& w,
                const std::vector<ContactLinearisation>& linear, const Impulses& dr) {
  const Eigen::VectorXd du = w * dr;
  double sum = 0.0;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int begin = problem.row_begin[c], rows = problem.contact_rows(c);
    const Eigen::VectorXd r = dr.segment(begin, rows), u = du.segment(begin, rows);
    const Eigen::VectorXd left = linear[c].df_dr.topLeftCorner(rows, rows) * r +
                                 linear[c].df_du.topLeftCorner(rows, rows) * u +
                                 linear[c].f.head(rows);
    sum += left.squaredNorm();
  }
  return std::sqrt(sum);
}

/// Solves with several sets of blocks in one pattern. `w`: the W of the whole problem.
void check_solves(const FrictionProblem& problem, const Eigen::MatrixXd& w,
                  std::vector<ContactLinearisation> linear) {
  ContactOperator op;
  op.prepare(problem);
  NewtonSystem system;
  system.prepare(op);
  for (const double more_alpha : {1e-2, 0.99}) {
    for (ContactLinearisation& l : linear) l.df_dr += more_alpha * l.df_du;
    Impulses dr;
    REQUIRE(system.solve(linear, dr));
    CHECK(residual(problem, w, linear, dr) <= 1e-10 * (1.0 + dr.norm()));
    CHECK(dr.norm() > 0.0);
  }
}

FrictionProblem stored_pile(int contacts, double redundancy) {
  return make_pile({.contacts = contacts, .redundancy = redundancy, .is_stored = true});
}

}  // namespace

TEST_CASE("a Newton system is solved in both forms, for one set of blocks after another",
          "[factors]") {
  for (const FrictionProblem& dynamics :
       {make_known_solution({.contacts = 80}).problem, oracle::mixed_problem()}) {
    const Eigen::MatrixXd w = oracle::dense_delassus(dynamics);
    for (const FrictionProblem& problem : {dynamics, only_delassus(dynamics)})
      check_solves(problem, w, some_blocks(dynamics));
  }
}

TEST_CASE("contacts like springs: dr = source - gain du with du = W dr", "[factors]") {
  for (const FrictionProblem& problem :
       {make_known_solution({.contacts = 80}).problem, oracle::mixed_problem()}) {
    const std::vector<ContactLinearisation> blocks = some_blocks(problem, 0.4);
    ContactOperator op;
    op.prepare(problem);
    NewtonSystem system;
    system.prepare(op);
    std::vector<Eigen::Matrix3d> gain;
    for (const ContactLinearisation& block : blocks) gain.push_back(block.df_du);
    const Impulses source = Impulses::LinSpaced(problem.row_count(), -1.0, 3.0);
    for (const double enough : {0.0, 1e-10}) {
      Impulses dr = source;
      Eigen::VectorXd du;
      REQUIRE(system.solve_springs(gain, dr, du, enough));
      CHECK((oracle::dense_delassus(problem) * dr - du).norm() <= 1e-9 * du.norm());
      for (int c = 0; c < problem.contact_count(); ++c) {
        const Eigen::Vector3d left = op.at(source, c) - gain[c] * op.at(du, c) - op.at(dr, c);
        CHECK(left.head(problem.contact_rows(c)).norm() <= 1e-12 * source.norm());
      }
    }
  }
}

TEST_CASE("Newton's system of a stored W: few rows, nearly full, sparse, one row, unsymmetric",
          "[factors]") {
  FrictionProblem unsymmetric =
      only_delassus(make_known_solution({.frictionless_fraction = 0.4}).problem);
  for (int i = 0; i < unsymmetric.delassus.w.nonZeros(); i += 3)
    unsymmetric.delassus.w.valuePtr()[i] *= 1.05;
  // Solved dense because of few rows, dense because W is nearly full, and sparse.
  for (const FrictionProblem& problem :
       {stored_pile(30, 0.5), stored_pile(150, 0.8), stored_pile(200, 0.0), unsymmetric})
    for (const double idle : {0.0, 0.4, 1.0}) {
      INFO("share of idle contacts " << idle);
      check_solves(problem, Eigen::MatrixXd(problem.delassus.w), some_blocks(problem, idle));
    }
}

TEST_CASE("a singular system is said to be so, a stored W does without alpha", "[factors]") {
  const FrictionProblem dynamics = make_known_solution({.bodies = 6, .contacts = 3}).problem;
  const Eigen::Matrix3d zero = Eigen::Matrix3d::Zero(), one = Eigen::Matrix3d::Identity();
  for (const FrictionProblem& problem : {dynamics, only_delassus(dynamics)}) {
    ContactOperator op;
    op.prepare(problem);
    NewtonSystem system;
    system.prepare(op);
    Impulses dr;
    const auto solves = [&](const Eigen::Matrix3d& df_du, double alpha) {
      const ContactLinearisation stuck{Eigen::Vector3d::Ones(), alpha * df_du, df_du};
      return system.solve(std::vector<ContactLinearisation>(3, stuck), dr);
    };
    // Sticking contacts: df_dr = alpha df_du is singular for alpha = 0.
    CHECK(solves(one, 0.0) == problem.has_delassus);
    CHECK_FALSE(solves(zero, 0.1));
  }
}
