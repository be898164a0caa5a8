#include "experiments/view/problem_view.hpp"

#include <cmath>

#include "experiments/view/view_page.hpp"
#include "platform/atomic_file.hpp"
#include "problems/files/captured_problem.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/captured_run.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

TEST_CASE("the error of a captured problem falls with the iterations, contact by contact") {
  const TemporaryFolder folder;
  const fs::path file = captured_run(folder.path() / "run");
  const ViewData view =
      view_of_problem(file, {.backends = {"pgs", "auto"}, .iterations = {1, 200}});
  const CapturedProblem captured = read_captured(file);
  const size_t contacts = captured.problem.friction.size();
  REQUIRE(view.contacts);
  REQUIRE(view.contacts(0).size() == contacts);
  CHECK(view.contacts(0)[0].body_a == captured.id_a[0]);
  REQUIRE(view.errors.size() == 2);
  for (const ViewErrors& errors : view.errors) {
    REQUIRE(errors.error.size() == 2);
    for (size_t budget = 0; budget < 2; ++budget) {
      double square = 0.0;
      for (const double error : errors.error[budget]) square += error * error;
      CHECK(std::abs(std::sqrt(square / static_cast<double>(contacts)) - errors.rms[budget]) <=
            1e-9 * errors.rms[budget] + 1e-15);
    }
  }
  // without time for a second iteration larger budgets come to the same
  const ViewData hurried =
      view_of_problem(file, {.backends = {"pgs"}, .iterations = {1, 10, 100}, .max_seconds = 0.0});
  CHECK((hurried.errors[0].rms.size() == 3 && hurried.errors[0].error.size() == 3));
  CHECK(hurried.errors[0].rms[2] == hurried.errors[0].rms[0]);
  CHECK(view.errors[0].rms[1] < 0.1 * view.errors[0].rms[0]);
  const fs::path page = folder.path() / "page.html";
  write_view_page(view, page);
  check_page(read_whole_file(page));
  CHECK_THROWS_AS(view_of_problem(file, {.backends = {"nobody"}}), UnknownSolver);
}

TEST_CASE("a problem alone knows where its bodies are: there where the run has them") {
  const TemporaryFolder folder;
  const fs::path file = captured_run(folder.path() / "run");
  const ErrorQuestion question{.backends = {"pgs"}, .iterations = {10}};
  const ViewData in_run = view_of_problem(file, question);
  fs::copy_file(file, folder.path() / "alone.hdf5");
  const ViewData alone = view_of_problem(folder.path() / "alone.hdf5", question);
  CHECK(in_run.has_shapes);
  CHECK_FALSE(alone.has_shapes);
  CHECK(alone.errors[0].error == in_run.errors[0].error);
  REQUIRE(alone.system.grain_count == in_run.system.grain_count);
  const auto contacts = alone.contacts(0), known_contacts = in_run.contacts(0);
  REQUIRE(contacts.size() == known_contacts.size());
  for (size_t c = 0; c < contacts.size(); ++c) {
    const FrameContact &mine = contacts[c], &known = known_contacts[c];
    for (const auto& [body, other] :
         {std::pair(mine.body_a, known.body_a), std::pair(mine.body_b, known.body_b)}) {
      const auto b = static_cast<size_t>(body), o = static_cast<size_t>(other);
      REQUIRE(alone.system.bodies[b].is_wall() == in_run.system.bodies[o].is_wall());
      if (alone.system.bodies[b].is_wall()) continue;
      CHECK((alone.frames[0].pose[b].position - in_run.frames[0].pose[o].position).norm() < 1e-6);
      CHECK(alone.system.bodies[b].mass == Approx(in_run.system.bodies[o].mass));
      // the contact point is a corner of the hull, or inside
      CHECK(alone.system.bodies[b].shape.polyhedron->circumradius() >
            (mine.position.cast<double>() - alone.frames[0].pose[b].position).norm() - 1e-6);
    }
  }
}

}  // namespace
}  // namespace ballast
