#include "experiments/view/problem_view.hpp"

#include <cmath>

#include "experiments/run/run.hpp"
#include "experiments/view/view_page.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "problems/files/captured_problem.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// The first problem captured from a pyramid of boxes at rest.
fs::path captured_in(const fs::path& folder) {
  RunOptions options;
  options.scene = "settled_rest";
  options.overrides = {"scene.duration=0.02"};
  options.output = folder;
  options.capture = "every=5";
  run(options);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "capture"))
    if (is_captured(entry.path())) return entry.path();
  FAIL("nothing was captured");
  return {};
}

TEST_CASE("the error of a captured problem falls with the iterations, contact by contact") {
  const TemporaryFolder folder;
  const fs::path file = captured_in(folder.path() / "run");
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

}  // namespace
}  // namespace ballast
