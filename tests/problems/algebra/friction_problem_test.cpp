#include "problems/algebra/friction_problem.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string complaint(const FrictionProblem& problem) {
  return ballast::complaint<InvalidProblem>([&] { problem.validate(); });
}

struct Damage {
  const char* names;  ///< the beginning of the message
  std::function<void(FrictionProblem&)> make;
};

FrictionProblem both_forms() {
  FrictionProblem problem = oracle::mixed_problem();
  add_delassus_form(problem);
  return problem;
}

void check_all(const std::vector<Damage>& damages) {
  for (const Damage& damage : damages) {
    FrictionProblem problem = both_forms();
    damage.make(problem);
    CAPTURE(complaint(problem), damage.names);
    CHECK(complaint(problem).rfind(damage.names, 0) == 0);
  }
}

Eigen::VectorXd some_impulses(int rows) { return Eigen::VectorXd::LinSpaced(rows, -1.0, 2.0); }

}  // namespace

TEST_CASE("velocities agree with dense matrices") {
  const FrictionProblem problems[] = {oracle::mixed_problem(), make_known_solution({}).problem};
  for (const FrictionProblem& problem : problems) {
    const Impulses r = some_impulses(problem.row_count());
    const Eigen::MatrixXd h = oracle::dense_h(problem), mass = oracle::dense_mass(problem);
    Eigen::VectorXd q, u, v, p;
    free_contact_velocity(problem, q);
    CHECK((q - oracle::dense_q(problem)).norm() < 1e-12 * q.norm());
    contact_velocity(problem, r, u);
    const Eigen::VectorXd expected = oracle::dense_delassus(problem) * r + oracle::dense_q(problem);
    CHECK((u - expected).norm() < 1e-12 * expected.norm());
    contact_velocity(only_delassus(problem), r, u);
    CHECK((u - expected).norm() < 1e-12 * expected.norm());
    body_velocity(problem.dynamics, problem.row_begin, r, v);
    CHECK((mass * (v - problem.dynamics.v_free) - h.transpose() * r).norm() < 1e-12 * r.norm());
    contact_to_body_impulse(problem.dynamics, problem.row_begin, r, p);
    CHECK((p - h.transpose() * r).norm() < 1e-13 * r.norm());
    CHECK((Eigen::MatrixXd(sparse_mass(problem.dynamics)) - mass).norm() == 0.0);
    CHECK((Eigen::MatrixXd(sparse_h(problem)) - h).norm() == 0.0);
  }
}

TEST_CASE("impulses of the wrong size are refused") {
  const FrictionProblem problem = oracle::mixed_problem();
  Eigen::VectorXd u;
  CHECK_THROWS_AS(contact_velocity(problem, Impulses::Zero(problem.row_count() + 1), u),
                  InvalidProblem);
  CHECK_THROWS_AS(body_velocity(problem.dynamics, problem.row_begin, Impulses::Zero(2), u),
                  InvalidProblem);
}

TEST_CASE("a problem without its contacts keeps its bodies and its storage") {
  FrictionProblem problem = oracle::mixed_problem();
  const int bodies = problem.dynamics.body_count();
  const double* h = problem.dynamics.h.data();
  const std::size_t capacity = problem.dynamics.h.capacity();
  problem.clear_contacts();
  CHECK(problem.contact_count() == 0);
  CHECK(problem.row_count() == 0);
  CHECK(problem.dynamics.body_count() == bodies);
  CHECK(problem.dynamics.h.capacity() == capacity);
  CHECK(problem.dynamics.h.data() == h);
}

TEST_CASE("a sound problem passes, in each form") {
  FrictionProblem problem = both_forms();
  CHECK(complaint(problem) == "");
  problem.has_dynamics = false;
  CHECK(complaint(problem) == "");
  CHECK(complaint(FrictionProblem{}) == "");
}

TEST_CASE("the first bad entry is named, with its array and its value") {
  check_all({
      {"row_begin has 7 entries", [](auto& p) { p.row_begin.pop_back(); }},
      {"row_begin[0] = 1", [](auto& p) { p.row_begin[0] = 1; }},
      {"row_begin[3] = 8 gives contact 2 2 rows", [](auto& p) { p.row_begin[3] = 8; }},
      {"friction[1] = nan is not finite", [](auto& p) { p.friction[1] = not_a_number; }},
      {"friction[1] = -0.5 is negative", [](auto& p) { p.friction[1] = -0.5; }},
      {"friction[1] = 10001 is above 10000", [](auto& p) { p.friction[1] = 10001.0; }},
      {"friction[1] = inf is not finite", [](auto& p) { p.friction[1] = infinity; }},
      {"friction[2] = 0.25: a one-row contact", [](auto& p) { p.friction[2] = 0.25; }},
      {"has_dynamics = 0", [](auto& p) { p.has_dynamics = p.has_delassus = false; }},
      {"dynamics.dof_begin is empty", [](auto& p) { p.dynamics.dof_begin.clear(); }},
      {"dynamics.dof_begin[0] = -1", [](auto& p) { p.dynamics.dof_begin[0] = -1; }},
      {"dynamics.dof_begin[2] = 6 gives body 1 0 unknowns",
       [](auto& p) { p.dynamics.dof_begin[2] = 6; }},
      {"dynamics.dof_begin[2] = 5", [](auto& p) { p.dynamics.dof_begin[2] = 5; }},
      {"dynamics.dof_begin[3] = 17", [](auto& p) { p.dynamics.dof_begin[3] = 17; }},
      {"dynamics.mass_begin has 3", [](auto& p) { p.dynamics.mass_begin.pop_back(); }},
      {"dynamics.mass_begin[1] = 35", [](auto& p) { p.dynamics.mass_begin[1] = 35; }},
      {"dynamics.mass has 45 entries", [](auto& p) { p.dynamics.mass.pop_back(); }},
      {"dynamics.mass[38] = inf", [](auto& p) { p.dynamics.mass[38] = infinity; }},
      {"dynamics.mass[45] = 0: the block of body 2", [](auto& p) { p.dynamics.mass[45] = 0.0; }},
      {"dynamics.mass[36] = ",
       [](auto& p) { p.dynamics.mass[37] = p.dynamics.mass[39] = 50.0; }},     // indefinite
      {"dynamics.mass[39] = ", [](auto& p) { p.dynamics.mass[39] += 1e-6; }},  // not symmetric
      {"dynamics.v_free has 9", [](auto& p) { p.dynamics.v_free.conservativeResize(9); }},
      {"dynamics.v_free[3] = nan", [](auto& p) { p.dynamics.v_free[3] = not_a_number; }},
      {"dynamics.body_a has 6", [](auto& p) { p.dynamics.body_a.pop_back(); }},
      {"dynamics.body_a[2] = 3 is not one of the 3", [](auto& p) { p.dynamics.body_a[2] = 3; }},
      {"dynamics.body_b[2] = -2", [](auto& p) { p.dynamics.body_b[2] = -2; }},
      {"dynamics.body_b[0] = 0: body_a and body_b are the same",
       [](auto& p) { p.dynamics.body_b[0] = 0; }},
      {"dynamics.h_begin has 7", [](auto& p) { p.dynamics.h_begin.pop_back(); }},
      {"dynamics.h_begin[1] = 26", [](auto& p) { p.dynamics.h_begin[1] = 26; }},
      {"dynamics.h has", [](auto& p) { p.dynamics.h.push_back(0.0); }},
      {"dynamics.h[7] = -inf", [](auto& p) { p.dynamics.h[7] = -infinity; }},
      {"dynamics.bias has 16", [](auto& p) { p.dynamics.bias.conservativeResize(16); }},
      {"dynamics.bias[16] = nan", [](auto& p) { p.dynamics.bias[16] = not_a_number; }},
      {"delassus.q has 16", [](auto& p) { p.delassus.q.conservativeResize(16); }},
      {"delassus.q[2] = inf", [](auto& p) { p.delassus.q[2] = infinity; }},
      {"delassus.w rows has 16", [](auto& p) { p.delassus.w.conservativeResize(16, 17); }},
      {"delassus.w columns has 18", [](auto& p) { p.delassus.w.conservativeResize(17, 18); }},
      {"delassus.w(0, 4) = nan", [](auto& p) { p.delassus.w.coeffRef(0, 4) = not_a_number; }},
      {"delassus.w(4, 4) = -1 is negative", [](auto& p) { p.delassus.w.coeffRef(4, 4) = -1.0; }},
      {"delassus.w(1, 0) = ",
       [](auto& p) { p.delassus.w.coeffRef(1, 0) += 10.0 * p.delassus.w.coeff(0, 0); }},
      {"delassus.w(1, 0) = 1000",
       [](auto& p) { p.delassus.w.coeffRef(1, 0) = p.delassus.w.coeffRef(0, 1) = 1000; }},
      {"delassus.w(0, 0) = 1: the block of contact 0 is not positive semidefinite (det",
       [](auto& p) {  // every 2 x 2 minor is positive, the determinant is not
         const double block[3][3] = {{1, 0.9, -0.9}, {0.9, 1, 0.9}, {-0.9, 0.9, 1}};
         for (int i = 0; i < 3; ++i)
           for (int j = 0; j < 3; ++j) p.delassus.w.coeffRef(i, j) = block[i][j];
       }},
      {"delassus.w row 0 has column 17",
       [](auto& p) { p.delassus.w.innerIndexPtr()[p.delassus.w.outerIndexPtr()[1] - 1] = 17; }},
      {"delassus.w row 0 has column 0 after 0",
       [](auto& p) { p.delassus.w.innerIndexPtr()[1] = 0; }},
      // Numbers whose squares or inverses overflow.
      {"dynamics.v_free[3] = 1e+308 is beyond 1e+30",
       [](auto& p) { p.dynamics.v_free[3] = 1e308; }},
      {"dynamics.bias[2] = -1.0000000000000001e+31 is beyond",
       [](auto& p) { p.dynamics.bias[2] = -1.0000000000000001e31; }},
      {"dynamics.mass[38] = 1.0000000000000001e+50 is beyond",
       [](auto& p) { p.dynamics.mass[38] = 1e50; }},
      {"dynamics.mass[45] = 1.0000000000000001e-31 is below 1.0000000000000001e-30",
       [](auto& p) { p.dynamics.mass[45] = 1e-31; }},
      {"dynamics.h[7] = 1.0000000000000001e+50 is beyond", [](auto& p) { p.dynamics.h[7] = 1e50; }},
      {"delassus.q[2] = 1e+308 is beyond", [](auto& p) { p.delassus.q[2] = 1e308; }},
      {"delassus.w(0, 0) = 1.0000000000000001e+50 is beyond",
       [](auto& p) { p.delassus.w.coeffRef(0, 0) = 1e50; }},
      {"delassus.w(0, 0) = 1e-50: the block of contact 0 is not zero and below",
       [](auto& p) {
         for (int i = 0; i < 3; ++i)
           for (int j = 0; j < 3; ++j) p.delassus.w.coeffRef(i, j) = i == j ? 1e-50 : 0.0;
       }},
  });
  FrictionProblem problem = both_forms();
  problem.dynamics.v_free[3] = -largest_entry;
  CHECK(complaint(problem) == "");
}

TEST_CASE("a stored operator may be unsymmetric, by more than some per cent") {
  for (const double part : {0.02, 0.16, 1.5}) {
    FrictionProblem problem = both_forms();
    const double size = std::sqrt(problem.delassus.w.coeff(0, 0) * problem.delassus.w.coeff(1, 1));
    problem.delassus.w.coeffRef(1, 0) += 0.5 * part * size;
    problem.delassus.w.coeffRef(0, 1) -= 0.5 * part * size;
    CHECK(complaint(problem) == "");
  }
}

TEST_CASE("known masses are not looked at again, others and all the rest are") {
  const FrictionProblem good = make_known_solution({.contacts = 20}).problem;
  KnownMasses valid;
  CHECK_FALSE(valid.has_masses_of(good.dynamics));
  good.validate(&valid);
  REQUIRE(valid.has_masses_of(good.dynamics));
  good.validate(&valid);
  const auto refuses = [&](const std::function<void(FrictionProblem&)>& harm, bool same_masses) {
    FrictionProblem other = good;
    harm(other);
    CHECK(valid.has_masses_of(other.dynamics) == same_masses);
    CHECK_THROWS_AS(other.validate(&valid), InvalidProblem);
    CHECK(valid.has_masses_of(good.dynamics));
  };
  refuses([](auto& p) { p.dynamics.mass[0] = -1.0; }, false);
  refuses([](auto& p) { p.dynamics.dof_begin.back() += 1; }, false);
  refuses([](auto& p) { p.dynamics.h.back() = not_a_number; }, true);
  refuses([](auto& p) { p.dynamics.v_free[1] = not_a_number; }, true);
  refuses([](auto& p) { p.friction[0] = -0.5; }, true);
  // Changes one mass by its last bit.
  FrictionProblem other = good;
  other.dynamics.mass[0] = std::nextafter(other.dynamics.mass[0], 1e30);
  CHECK_FALSE(valid.has_masses_of(other.dynamics));
}
