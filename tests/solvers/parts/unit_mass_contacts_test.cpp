#include "solvers/parts/unit_mass_contacts.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/support/fixed_contact.hpp"

using namespace ballast;

namespace {

FrictionProblem some_problem(std::uint64_t seed) {
  return make_known_solution({.mass_ratio = 100.0, .seed = seed}).problem;
}

}  // namespace

TEST_CASE("unit masses change neither contact velocities nor the judge's error") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const FrictionProblem problem = some_problem(seed);
    UnitMassContacts contacts;
    contacts.prepare(problem);
    ContactColumns r;
    contacts.from_impulses(Impulses::LinSpaced(problem.row_count(), -1.0, 3.0), r);
    Impulses stacked;
    contacts.to_impulses(r, stacked);
    Eigen::VectorXd x, u;
    contacts.body_velocity(r, x);
    contact_velocity(problem, stacked, u);
    for (int c = 0; c < problem.contact_count(); ++c) {
      const Eigen::Vector3d mine = contacts.velocity(x, c);
      for (int i = 0; i < problem.contact_rows(c); ++i)
        CHECK(mine[i] == Approx(u[problem.row_begin[c] + i]).margin(1e-12));
    }
    CHECK(contacts.error(r, [&](int c) { return contacts.velocity(x, c); }) ==
          Approx(contact_error(problem, stacked).natural_map_rms).epsilon(1e-12));
  }
}

TEST_CASE("impulses come out as they went in, each in its cone") {
  const KnownSolution known = make_known_solution({});
  UnitMassContacts contacts;
  contacts.prepare(known.problem);
  ContactColumns r;
  Impulses again;
  contacts.from_impulses(known.r, r);
  contacts.to_impulses(r, again);
  CHECK((again - known.r).norm() < 1e-14 * known.r.norm());
  contacts.from_impulses(Impulses::Constant(known.problem.row_count(), -1.0), r);
  for (int c = 0; c < contacts.contact_count(); ++c) {
    CHECK(r(0, c) >= 0.0);
    CHECK(r.col(c).tail<2>().norm() <= contacts[c].friction * r(0, c) + 1e-15);
  }
}

TEST_CASE("where nothing moves there is no impulse, and nothing is pushed") {
  FrictionProblem problem = some_problem(1);
  add_fixed_contact(problem);
  UnitMassContacts contacts;
  contacts.prepare(problem);
  ContactColumns r;
  contacts.from_impulses(Impulses::Ones(problem.row_count()), r);
  CHECK(r.col(contacts.contact_count() - 1).norm() == 0.0);
  Eigen::VectorXd x;
  contacts.body_velocity(r, x);
  CHECK(x.tail<UnitMassContacts::width>().norm() == 0.0);
}
