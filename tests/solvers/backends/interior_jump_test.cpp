#include "solvers/backends/interior_jump.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

struct Jumper {
  FrictionProblem problem = make_known_solution({}).problem;
  UnitMassContacts contacts;
  UnitMassSystem system;
  InteriorJump jump;
  ContactColumns r;
  Impulses impulses = Impulses::Zero(problem.row_count());

  Jumper() {
    contacts.prepare(problem);
    system.prepare(contacts);
    jump.prepare(contacts, system);
    contacts.from_impulses(impulses, r);
  }
  double start_error() const { return contact_error(problem, impulses).natural_map_rms; }
};

}  // namespace

TEST_CASE("a jump says how far it came, and the course has its best", "[factors]") {
  Jumper jumper;
  const double scale = jumper.start_error();
  Course course({.tolerance = 0.0, .max_iterations = 100}, jumper.impulses, scale);
  const double error = jumper.jump.run(course, jumper.r, 0, scale, 1e-4);
  CHECK(error < 1e-4 * scale);
  CHECK(course.error() == error);
  jumper.contacts.to_impulses(jumper.r, jumper.impulses);
  CHECK(error == Approx(contact_error(jumper.problem, jumper.impulses).natural_map_rms));
  const int spent = 100 - course.rest().max_iterations;
  CHECK(spent > 3);
  CHECK(spent < 60);
}

TEST_CASE("a jump keeps to the budget, and another number is another jump", "[factors]") {
  double errors[2];
  for (const int number : {0, 1}) {
    Jumper jumper;
    Course course({.tolerance = 0.0, .max_iterations = 3}, jumper.impulses, jumper.start_error());
    errors[number] = jumper.jump.run(course, jumper.r, number, jumper.start_error(), 1e-4);
    CHECK(course.over());
    CHECK(course.rest().max_iterations == 0);
  }
  CHECK(errors[0] != errors[1]);
}
