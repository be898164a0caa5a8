// Made problems: piles are solvable and have the difficulty that was asked for; small problems have
// known answers.

#include "problems/algebra/made_problems.hpp"

#include <set>

#include <Eigen/Eigenvalues>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

constexpr double gh = made_gravity_step;

/// 1 - rank(W)/rows, by eigenvalues.
double rank_deficiency(const FrictionProblem& problem) {
  const Eigen::MatrixXd w = Eigen::MatrixXd(delassus_matrix(problem));
  const Eigen::VectorXd values = oracle::eigenvalues(w);
  const double rank = static_cast<double>((values.array() > 1e-10 * values.maxCoeff()).count());
  return 1.0 - rank / problem.row_count();
}

/// The least |H^T r - M (v - v_free)| over all r: zero if some impulses bring the bodies to v.
double unreachable(const FrictionProblem& problem, const Eigen::VectorXd& v) {
  const Eigen::MatrixXd pull = oracle::dense_h(problem).transpose();
  const Eigen::VectorXd wanted = oracle::dense_mass(problem) * (v - problem.dynamics.v_free);
  const Eigen::VectorXd r = pull.colPivHouseholderQr().solve(wanted);
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

TEST_CASE("A pile has the size, redundancy, masses, friction and open share that are asked for") {
  for (const double redundancy : {0.0, 0.4, 0.8}) {
    const FrictionProblem problem = make_pile({.contacts = 120,
                                               .redundancy = redundancy,
                                               .mass_ratio = 1e3,
                                               .friction_min = 0.2,
                                               .friction_max = 0.7,
                                               .active = 0.5,
                                               .mass_unit = 10.0});
    CHECK_NOTHROW(problem.validate());
    CHECK(problem.contact_count() == 120);
    CHECK(problem.row_count() == 360);
    CHECK(rank_deficiency(problem) == Approx(redundancy).margin(0.08));
    const DynamicsForm& dynamics = problem.dynamics;
    double least = 1e300, most = 0.0;
    for (int b = 0; b < dynamics.body_count(); ++b) {
      least = std::min(least, dynamics.mass[dynamics.mass_begin[b]]);
      most = std::max(most, dynamics.mass[dynamics.mass_begin[b]]);
    }
    CHECK(least >= 10.0);
    CHECK(most <= 1e4);
    CHECK(most / least > 50.0);
    int open = 0;
    for (int c = 0; c < 120; ++c) {
      CHECK(problem.friction[c] >= 0.2);
      CHECK(problem.friction[c] <= 0.7);
      open += dynamics.bias[problem.row_begin[c]] > 0.0;
    }
    CHECK(open > 30);
    CHECK(open < 90);
  }
}

TEST_CASE("The same settings make the same pile, stored or not") {
  PileSettings settings;
  settings.contacts = 30;
  settings.seed = 7;
  const FrictionProblem once = make_pile(settings), again = make_pile(settings);
  CHECK(once.dynamics.h == again.dynamics.h);
  CHECK(once.dynamics.v_free == again.dynamics.v_free);
  settings.is_stored = true;
  const FrictionProblem stored = make_pile(settings);
  CHECK_FALSE(stored.has_dynamics);
  CHECK_NOTHROW(stored.validate());
  CHECK((stored.delassus.w - delassus_matrix(once)).norm() == 0.0);
  settings.seed = 8;
  CHECK((make_pile(settings).delassus.q - stored.delassus.q).norm() > 0.0);
}

TEST_CASE("Members of the family differ, stay within what it promises, and have a solution") {
  int stored = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    PileSettings settings = random_pile(seed, 300);
    CHECK((settings.contacts >= 2 && settings.contacts <= 300));
    CHECK(
        (settings.redundancy < 0.8 && settings.mass_ratio <= 1e4 && settings.friction_max <= 1.0));
    stored += settings.is_stored;
    CHECK_NOTHROW(make_pile(settings).validate());
    // Every contact allows rest: a solution exists.
    settings.is_stored = false;
    const FrictionProblem pile = make_pile(settings);
    for (int c = 0; c < pile.contact_count(); ++c) {
      const auto u = pile.dynamics.bias.segment<3>(3 * c);
      CHECK((u[0] >= 0.0 && u[1] == 0.0 && u[2] == 0.0));
    }
  }
  CHECK((stored > 20 && stored < 40));
}

TEST_CASE("stress problems: the velocities said to be the answer can be reached, and fit") {
  int checked = 0;
  std::set<std::string> names;
  for (const StressProblem& stress : stress_problems()) {
    CAPTURE(stress.name);
    CHECK(names.insert(stress.name).second);
    CHECK(stress.problem.contact_count() <= 60);
    CHECK_NOTHROW(stress.problem.validate());
    if (stress.v.size() == 0) continue;
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
  // A stack: each contact carries the bodies above it.
  const StressProblem stack = mass_stack({1.0, 1e3, 5.0}, 1);
  check_solution(stack, gh * Eigen::Vector3d(1006.0, 1005.0, 5.0));
  // A chain: every contact carries the force times the step of 1 ms.
  check_solution(jammed_chain(5, 1000.0), Impulses::Constant(6, 1.0));
  // A block of 2 kg: r_N = 2 g h, with the friction mu r_N against the motion.
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
  const StressProblem sticks = painleve_rod(2.0, 0.1);  // cannot slip, as p < 0
  CHECK(sticks.u == Eigen::Vector3d::Zero());
  CHECK(contact_error(painleve_rod(2.0, -0.1).problem, Impulses::Zero(3)).natural_map_max == 0.0);
}
