// Converts the matrices of a file to bodies and contacts, and back.

#include "problems/files/fclib_file.hpp"

#include <limits>

#include "platform/random.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

/// Unit masses, and contacts that touch the given unknowns.
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

/// u of the impulses r by the file's own equations.
Eigen::VectorXd velocity_of(const GlobalProblem& global, const Eigen::VectorXd& r) {
  const Eigen::MatrixXd m = global.m, h = global.h;
  return h.transpose() * oracle::dense_solution(m, h * r + global.f) + global.w;
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
  const FrictionProblem problem =
      make_known_solution({.bodies = 5, .contacts = 9, .frictionless_fraction = 0.0}).problem;
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
  // A wall that is coupled to a grain by its mass is not a wall.
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

TEST_CASE(
    "a mass that is none, not symmetric or not definite is refused, with bodies and without") {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  struct Wrong {
    int unknowns, touched;
    std::vector<Eigen::Triplet<double>> entries;
    const char* says;
  };
  const Wrong wrongs[] = {
      {6, 0, {{0, 0, -1.0}}, "M(0, 0) = -1"},
      {8, 0, {{3, 3, 0.0}}, "M is not positive definite"},
      // The block of a body: its lower triangle alone would be taken for the whole.
      {6, 0, {{0, 1, 0.5}}, "dynamics.mass[6] = "},
      {6, 0, {{0, 1, 2.0}, {1, 0, 2.0}}, "not positive definite"},  // eigenvalues -1 and 3
      // Eight unknowns are no bodies. Unknowns that no contact touches do not show in W.
      {8, 3, {{3, 3, -1.0}}, "M is not positive definite"},
      {8, 0, {{3, 3, -1.0}}, "M is not positive definite"},
      {8, 0, {{0, 7, 2.0}, {7, 0, 2.0}}, "M is not positive definite"},
      {8, 0, {{3, 3, infinite}}, "not finite"},
      {6, 0, {{3, 3, infinite}}, "is not"}};
  for (const auto& [unknowns, touched, entries, says] : wrongs) {
    GlobalProblem global = unit_masses(unknowns, {{touched}});
    for (const auto& entry : entries) global.m.coeffRef(entry.row(), entry.col()) = entry.value();
    CHECK_THROWS_WITH(to_friction_problem(global).validate(), Catch::Contains(says));
  }
}

TEST_CASE("what is not finite is refused where W is formed, though no contact sees it") {
  GlobalProblem global = unit_masses(8, {{0}});
  to_friction_problem(global);
  SECTION("H") { global.h.coeffRef(0, 1) = -std::numeric_limits<double>::infinity(); }
  SECTION("f") { global.f[5] = std::nan(""); }
  SECTION("w") { global.w[2] = std::numeric_limits<double>::infinity(); }
  CHECK_THROWS_WITH(to_friction_problem(global), Catch::Contains("not finite"));
}

TEST_CASE("an M that is not quite symmetric is taken as it is where W is formed") {
  GlobalProblem global = unit_masses(8, {{0}, {7}});
  global.m.coeffRef(0, 7) = 0.25;
  check_same_law(global, to_friction_problem(global));
}

TEST_CASE("sizes that do not agree are refused") {
  GlobalProblem global = unit_masses(6, {{0}});
  SECTION("M") { global.m.conservativeResize(6, 5); }
  SECTION("H") { global.h.conservativeResize(5, 3); }
  SECTION("f") { global.f.conservativeResize(5); }
  SECTION("w") { global.w.conservativeResize(2); }
  SECTION("mu") { global.mu.assign(2, 0.5); }
  CHECK_THROWS_WITH(to_friction_problem(global), Catch::Contains("do not agree"));
}
