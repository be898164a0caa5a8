#include "solvers/parts/coulomb_interior.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/stress_problems.hpp"
#include "tests/catch.hpp"
#include "tests/support/fixed_contact.hpp"

using namespace ballast;

namespace {

/// What it needs, on one problem.
struct Interior {
  UnitMassContacts contacts;
  UnitMassSystem system;
  CoulombInterior point;
  ContactColumns r;
  Impulses impulses;

  explicit Interior(const FrictionProblem& problem) {
    contacts.prepare(problem);
    system.prepare(contacts);
    point.prepare(contacts, system);
    contacts.from_impulses(Impulses::Zero(problem.row_count()), r);
  }
  /// Steps until the error is below `enough`, at most so many. Returns the error [m/s].
  double run(double nu, double enough, int steps) {
    point.begin(r, nu);
    double error = 1e300;
    for (int k = 0; k < steps && !(error < enough); ++k) {
      const double length = point.step(0.9);
      if (length == 0.0) break;
      CHECK(length <= 1.0);
      error = point.round(r);
    }
    contacts.to_impulses(r, impulses);
    return error;
  }
};

}  // namespace

TEST_CASE("interior points reach solutions of Coulomb's law, of any rank and row count",
          "[factors]") {
  int solved = 0;
  for (const int contacts : {1, 15, 60})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      CAPTURE(contacts, seed);
      KnownSolutionSettings settings;
      settings.contacts = contacts;
      settings.mass_ratio = 10.0;
      settings.seed = seed;
      const FrictionProblem problem = make_known_solution(settings).problem;
      Interior interior(problem);
      const double error = interior.run(1.0, 1e-7, 60);
      CHECK(error == Approx(contact_error(problem, interior.impulses).natural_map_rms));
      solved += error < 1e-7;
    }
  CHECK(solved >= 9);  // of 12: it is all or nothing
}

TEST_CASE("without friction nothing can go wrong", "[factors]") {
  KnownSolutionSettings settings;
  settings.friction_max = 0.0;
  settings.contacts = 80;
  Interior interior(make_known_solution(settings).problem);
  CHECK(interior.run(1.0, 1e-7, 60) < 1e-7);
}

TEST_CASE("a sliding block stays on its plane: the law is Coulomb's, not its relaxation",
          "[factors]") {
  const StressProblem stress = sliding_block(0.4, 0.3);
  Interior interior(stress.problem);
  REQUIRE(interior.run(1e-4, 1e-9, 60) < 1e-9);
  Eigen::VectorXd u;
  contact_velocity(stress.problem, interior.impulses, u);
  CHECK(std::abs(u[0]) < 1e-8);
  CHECK(u.tail<2>().norm() > 0.9);
}

TEST_CASE("where nothing moves there is no impulse", "[factors]") {
  FrictionProblem problem = make_known_solution({}).problem;
  add_fixed_contact(problem);
  Interior interior(problem);
  interior.run(1.0, 1e-7, 60);
  CHECK(interior.impulses.tail<3>().norm() == 0.0);
  CHECK(interior.impulses.allFinite());
}
