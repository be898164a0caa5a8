// Newton's system of a stored W against the whole of it, solved densely with full pivoting.

#include "solvers/parts/newton_matrix.hpp"

#include "platform/random.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/pile_problems.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

struct System {
  FrictionProblem problem;
  std::vector<ContactLinearisation> linear;
  std::vector<double> alpha;
};

/// Alart and Curnier's function at random impulses; `idle` of the contacts are pulled apart.
System system_of(FrictionProblem problem, double idle, std::uint64_t seed) {
  System s{std::move(problem), {}, {}};
  ProblemRandom random(seed);
  for (int c = 0; c < s.problem.contact_count(); ++c) {
    const bool is_one_row = s.problem.contact_rows(c) == 1;
    const auto tangential = [&] { return is_one_row ? 0.0 : random.uniform(-1.0, 1.0); };
    Eigen::Vector3d r(random.uniform(0.5, 1.0), 0.0, 0.0), u(random.uniform(-0.2, 0.2), 0.0, 0.0);
    r.tail<2>() = 0.3 * Eigen::Vector2d(tangential(), tangential());
    u.tail<2>() = Eigen::Vector2d(tangential(), tangential());
    if (random.uniform() < idle) {
      r.setZero();
      u[0] = 5.0;
    }
    s.linear.push_back(linearise(ContactEquation::alart_curnier, r, u, s.problem.friction[c], 0.7));
    s.alpha.push_back(0.1);
  }
  return s;
}

Eigen::VectorXd slow_twin(const System& s) {
  const int n = s.problem.row_count();
  const Eigen::MatrixXd w(s.problem.delassus.w);
  Eigen::MatrixXd by_r = Eigen::MatrixXd::Zero(n, n), by_u = by_r;
  Eigen::VectorXd f(n);
  for (int c = 0; c < s.problem.contact_count(); ++c) {
    const int first = s.problem.row_begin[c], rows = s.problem.contact_rows(c);
    by_r.block(first, first, rows, rows) = s.linear[c].by_r.topLeftCorner(rows, rows);
    by_u.block(first, first, rows, rows) = s.linear[c].by_u.topLeftCorner(rows, rows);
    f.segment(first, rows) = s.linear[c].f.head(rows);
    by_r.block(first, first, rows, rows) += s.alpha[c] * s.linear[c].by_u.topLeftCorner(rows, rows);
  }
  return (by_r + by_u * w).fullPivLu().solve(-f);
}

void check(const System& s) {
  NewtonMatrix matrix;
  matrix.prepare(s.problem);
  const Eigen::VectorXd slow = slow_twin(s);
  for (int again = 0; again < 2; ++again) {  // the pattern stays
    Impulses dr;
    REQUIRE(matrix.solve(s.linear, s.alpha, dr));
    CHECK((dr - slow).norm() <= 1e-9 * slow.norm());
  }
}

FrictionProblem stored_pile(int contacts, double redundancy) {
  PileSettings settings;
  settings.contacts = contacts;
  settings.redundancy = redundancy;
  settings.is_stored = true;
  return make_pile(settings);
}

}  // namespace

TEST_CASE("Newton's system of a stored W is the whole system's solution", "[factors]") {
  for (const double idle : {0.0, 0.4, 1.0}) {
    INFO("share of idle contacts " << idle);
    check(system_of(stored_pile(30, 0.5), idle, 1));   // dense: few rows
    check(system_of(stored_pile(150, 0.8), idle, 2));  // dense: W is nearly full
    check(system_of(stored_pile(200, 0.0), idle, 3));  // sparse
  }
}

TEST_CASE("One-row contacts and an unsymmetric W are taken as they are", "[factors]") {
  KnownSolutionSettings settings;
  settings.frictionless_fraction = 0.4;
  FrictionProblem problem = only_delassus(make_known_solution(settings).problem);
  for (int i = 0; i < problem.delassus.w.nonZeros(); i += 3)
    problem.delassus.w.valuePtr()[i] *= 1.05;
  check(system_of(problem, 0.3, 4));
}

TEST_CASE("A singular system is said to be so", "[factors]") {
  System s = system_of(stored_pile(5, 0.0), 0.0, 5);
  for (ContactLinearisation& l : s.linear) l.by_r = l.by_u = Eigen::Matrix3d::Zero();
  NewtonMatrix matrix;
  matrix.prepare(s.problem);
  Impulses dr;
  CHECK_FALSE(matrix.solve(s.linear, s.alpha, dr));
}
