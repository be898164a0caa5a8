// Generated piles: as difficult as was asked, and solvable.

#include "problems/algebra/pile_problems.hpp"

#include <Eigen/Eigenvalues>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

/// 1 - rank(W)/rows, by eigenvalues.
double rank_deficiency(const FrictionProblem& problem) {
  const Eigen::MatrixXd w = Eigen::MatrixXd(delassus_matrix(problem));
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(w, Eigen::EigenvaluesOnly).eigenvalues();
  const double rank = static_cast<double>((values.array() > 1e-10 * values.maxCoeff()).count());
  return 1.0 - rank / problem.row_count();
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

TEST_CASE("Rest is allowed at every contact of a pile: a solution exists") {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    PileSettings settings = random_pile(seed, 200);
    settings.is_stored = false;
    const FrictionProblem problem = make_pile(settings);
    Eigen::VectorXd u;
    body_to_contact_velocity(problem.dynamics, problem.row_begin,
                             Eigen::VectorXd::Zero(problem.dynamics.dof_count()), u);
    for (int c = 0; c < problem.contact_count(); ++c) {
      CHECK(u[3 * c] >= 0.0);
      CHECK(u[3 * c + 1] == 0.0);
      CHECK(u[3 * c + 2] == 0.0);
    }
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

TEST_CASE("Members of the family differ, and stay within what it promises") {
  int stored = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const PileSettings settings = random_pile(seed, 300);
    CHECK((settings.contacts >= 2 && settings.contacts <= 300));
    CHECK(
        (settings.redundancy < 0.8 && settings.mass_ratio <= 1e4 && settings.friction_max <= 1.0));
    stored += settings.is_stored;
    CHECK_NOTHROW(make_pile(settings).validate());
  }
  CHECK((stored > 20 && stored < 40));
}
