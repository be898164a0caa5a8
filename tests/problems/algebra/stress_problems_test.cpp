#include "problems/algebra/stress_problems.hpp"

#include <set>

#include "problems/algebra/contact_error.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

constexpr double gh = stress_gravity_step;

/// The least |H^T r - M (v - v_free)| over all r: zero when some impulses bring the bodies to v.
double unreachable(const FrictionProblem& problem, const Eigen::VectorXd& v) {
  const Eigen::MatrixXd pull = oracle::dense_h(problem).transpose();
  const Eigen::VectorXd wanted = oracle::dense_mass(problem) * (v - problem.dynamics.v_free);
  const Eigen::VectorXd r = pull.completeOrthogonalDecomposition().solve(wanted);
  return (pull * r - wanted).norm();
}

void check_solution(const StressProblem& stress, const Impulses& r) {
  const ContactError error = contact_error(stress.problem, r);
  CHECK(error.natural_map_max <= 1e-13);
  ContactJudge judge;
  judge.judge(stress.problem, r);
  CHECK((judge.body_velocity() - stress.v).norm() <= 1e-13 * (1.0 + stress.v.norm()));
}

}  // namespace

TEST_CASE("stress problems: names are unique, sizes small, and the broken ones are refused") {
  std::set<std::string> names;
  for (const StressProblem& stress : stress_problems()) {
    CAPTURE(stress.name);
    CHECK(names.insert(stress.name).second);
    CHECK(stress.problem.contact_count() <= 60);
    if (stress.refused.empty()) {
      CHECK_NOTHROW(stress.problem.validate());
    } else {
      CHECK_THROWS_WITH(stress.problem.validate(), Catch::Contains(stress.refused));
    }
  }
}

TEST_CASE("stress problems: the velocities said to be the answer can be reached, and fit") {
  int checked = 0;
  for (const StressProblem& stress : stress_problems()) {
    if (!stress.refused.empty() || stress.v.size() == 0) continue;
    CAPTURE(stress.name);
    const double size = 1.0 + oracle::dense_mass(stress.problem).norm();
    CHECK(unreachable(stress.problem, stress.v) <= 1e-11 * size);
    const Eigen::VectorXd u =
        oracle::dense_h(stress.problem) * stress.v + stress.problem.dynamics.bias;
    CHECK((u - stress.u).norm() <= 1e-13 * (1.0 + u.norm()));
    ++checked;
  }
  CHECK(checked >= 15);
}

TEST_CASE("stress problems: impulses known by hand solve them") {
  // A stack: each contact carries what lies on it.
  const StressProblem stack = mass_stack({1.0, 1e3, 5.0}, 1);
  check_solution(stack, gh * Eigen::Vector3d(1006.0, 1005.0, 5.0));
  // A chain: every contact carries force times the step of 1 ms.
  check_solution(jammed_chain(5, 1000.0), Impulses::Constant(6, 1.0));
  // A block of 2 kg: r_N = 2 g h, friction mu r_N against the motion.
  const double heading = 0.7;
  check_solution(
      sliding_block(0.4, heading),
      2.0 * gh * Eigen::Vector3d(1.0, -0.4 * std::cos(heading), -0.4 * std::sin(heading)));
}

TEST_CASE("stress problems: the rod's tip slides, sticks, or has several answers") {
  // W_NN = 1.6, W_TN = 1.2: while it slides forward, u_N = -approach + (1.6 - 1.2 mu) r_N = 0.
  const StressProblem slides = painleve_rod(0.5, 0.1);
  const double rn = 0.1 / (1.6 - 1.2 * 0.5);
  CHECK(contact_error(slides.problem, Eigen::Vector3d(rn, -0.5 * rn, 0.0)).natural_map_max <=
        1e-14);
  CHECK(slides.u[1] > 0.0);
  const StressProblem sticks = painleve_rod(2.0, 0.1);  // no slip: p < 0
  CHECK(sticks.u == Eigen::Vector3d::Zero());
  CHECK(contact_error(painleve_rod(2.0, -0.1).problem, Impulses::Zero(3)).natural_map_max == 0.0);
}
