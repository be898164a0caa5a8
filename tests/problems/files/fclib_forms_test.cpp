// From a file's matrices to bodies and contacts, and back.

#include "problems/files/fclib_file.hpp"

#include "platform/random.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

FrictionProblem sample(double frictionless) {
  return make_known_solution({.bodies = 5,
                              .contacts = 9,
                              .friction_min = 0.1,
                              .frictionless_fraction = frictionless})
      .problem;
}

/// Unit masses, and contacts that touch the unknowns given.
GlobalProblem unit_masses(int unknowns, const std::vector<std::vector<int>>& touched) {
  GlobalProblem global;
  global.m.resize(unknowns, unknowns);
  global.m.setIdentity();
  global.h.resize(unknowns, static_cast<int>(3 * touched.size()));
  for (size_t c = 0; c < touched.size(); ++c)
    for (const int row : touched[c])
      for (int k = 0; k < 3; ++k)
        global.h.insert(row, static_cast<int>(3 * c) + k) = 1.0 + row + 0.1 * k;
  global.f = Eigen::VectorXd::LinSpaced(unknowns, -1.0, 2.0);
  global.w = Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(3 * touched.size()), 0.1, 0.7);
  global.mu.assign(touched.size(), 0.5);
  return global;
}

/// u of impulses r by the file's own equations.
Eigen::VectorXd velocity_of(const GlobalProblem& global, const Eigen::VectorXd& r) {
  const Eigen::MatrixXd m = global.m, h = global.h;
  return h.transpose() * m.lu().solve(h * r + global.f) + global.w;
}

void check_same_law(const GlobalProblem& global, const FrictionProblem& problem) {
  Random random(2);
  Eigen::VectorXd r(problem.row_count()), u;
  REQUIRE(r.size() == global.h.cols());
  for (double& value : r) value = random.normal();
  contact_velocity(problem, r, u);
  CHECK((u - velocity_of(global, r)).norm() < 1e-12 * (1.0 + u.norm()));
}

}  // namespace

TEST_CASE("bodies survive the way through a global problem") {
  const FrictionProblem problem = sample(0.0);
  const GlobalProblem global = to_global_problem(problem);
  const FrictionProblem back = to_friction_problem(global);
  REQUIRE(back.has_dynamics);
  CHECK(back.dynamics.dof_begin == problem.dynamics.dof_begin);
  CHECK(back.dynamics.mass == problem.dynamics.mass);
  CHECK(back.friction == problem.friction);
  back.validate();
  check_same_law(global, back);
  check_same_law(global, problem);
}

TEST_CASE("one-row contacts get tangents without effect") {
  FrictionProblem problem = sample(0.6);
  REQUIRE(problem.row_count() < 3 * problem.contact_count());
  const GlobalProblem global = to_global_problem(problem);
  add_delassus_form(problem);
  const FrictionProblem local = condensed(problem);
  REQUIRE(local.row_count() == 3 * problem.contact_count());
  local.validate();
  for (int c = 0; c < problem.contact_count(); ++c) {
    if (problem.contact_rows(c) == 3) continue;
    CHECK(problem.friction[c] == 0.0);
    for (const int row : {3 * c + 1, 3 * c + 2}) {
      CHECK(Eigen::VectorXd(local.delassus.w.row(row).transpose()).norm() == 0.0);
      CHECK(local.delassus.q[row] == 0.0);
      CHECK(Eigen::VectorXd(global.h.col(row)).norm() == 0.0);
    }
  }
}

TEST_CASE("unknowns are grouped by six, or else by three") {
  const FrictionProblem rigid = to_friction_problem(unit_masses(12, {{0, 7}, {5}}));
  REQUIRE(rigid.has_dynamics);
  CHECK(rigid.dynamics.dof_begin == std::vector<int>{0, 6, 12});
  CHECK(rigid.dynamics.body_b == std::vector<int>{0, 0});
  CHECK(rigid.dynamics.body_a == std::vector<int>{1, -1});
  const GlobalProblem points = unit_masses(9, {{0, 4}, {4, 8}, {2}});
  const FrictionProblem grouped = to_friction_problem(points);
  REQUIRE(grouped.has_dynamics);
  CHECK(grouped.dynamics.dof_begin == std::vector<int>{0, 3, 6, 9});
  check_same_law(points, grouped);
}

TEST_CASE("one unknown behind the bodies is a body of its own, as a run's driven wall") {
  GlobalProblem global = unit_masses(13, {{0, 7}, {8, 12}, {12}});
  global.m.coeffRef(12, 12) = 4.0;
  const FrictionProblem problem = to_friction_problem(global);
  REQUIRE(problem.has_dynamics);
  problem.validate();
  CHECK(problem.dynamics.dof_begin == std::vector<int>{0, 6, 12, 13});
  CHECK(problem.dynamics.body_b == std::vector<int>{0, 1, 2});
  CHECK(problem.dynamics.body_a == std::vector<int>{1, 2, -1});
  check_same_law(global, problem);
  // A wall that is coupled to a grain by its mass is none.
  global.m.coeffRef(12, 3) = global.m.coeffRef(3, 12) = 0.25;
  CHECK_FALSE(to_friction_problem(global).has_dynamics);
}

TEST_CASE("what is no group of bodies is condensed to W") {
  const GlobalProblem three_touched = unit_masses(18, {{0, 6, 12}});
  GlobalProblem coupled = unit_masses(12, {{0, 7}});
  coupled.m.coeffRef(2, 8) = coupled.m.coeffRef(8, 2) = 0.25;
  for (const GlobalProblem& global : {three_touched, coupled, unit_masses(8, {{0}, {7}})}) {
    const FrictionProblem problem = to_friction_problem(global);
    CHECK(problem.has_delassus);
    CHECK_FALSE(problem.has_dynamics);
    check_same_law(global, problem);
  }
}

TEST_CASE("stored zeros touch no body and couple none") {
  GlobalProblem global = unit_masses(18, {{0, 6}});
  global.h.coeffRef(12, 0) = 0.0;
  global.m.coeffRef(0, 12) = 0.0;
  CHECK(to_friction_problem(global).has_dynamics);
}

TEST_CASE("a mass that is none is refused") {
  GlobalProblem global = unit_masses(6, {{0}});
  global.m.coeffRef(0, 0) = -1.0;
  CHECK_THROWS_WITH(to_friction_problem(global), Catch::Contains("M(0, 0) = -1"));
  GlobalProblem singular = unit_masses(8, {{0}});
  singular.m.coeffRef(3, 3) = 0.0;
  CHECK_THROWS_WITH(to_friction_problem(singular), Catch::Contains("M is singular"));
}

TEST_CASE("a mass that is not symmetric or not definite is refused with bodies and without") {
  // A body's block: the lower triangle alone would be taken for the whole.
  GlobalProblem asymmetric = unit_masses(6, {{0}});
  asymmetric.m.coeffRef(0, 1) = 0.5;
  CHECK_THROWS_WITH(to_friction_problem(asymmetric).validate(),
                    Catch::Contains("dynamics.mass[1] = ") || Catch::Contains("dynamics.mass[6]"));
  GlobalProblem indefinite = unit_masses(6, {{0}});
  indefinite.m.coeffRef(0, 1) = indefinite.m.coeffRef(1, 0) = 2.0;  // eigenvalues -1 and 3
  CHECK_THROWS_WITH(to_friction_problem(indefinite), Catch::Contains("not positive definite"));
  // Eight unknowns are no bodies: W shows it.
  GlobalProblem condensed = unit_masses(8, {{3}});
  condensed.m.coeffRef(3, 3) = -1.0;
  CHECK_THROWS_WITH(to_friction_problem(condensed).validate(),
                    Catch::Contains("delassus.w(0, 0) = -16 is negative"));
}
