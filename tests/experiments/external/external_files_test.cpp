// The files of the protocol: round trips, and everything that is no answer.

#include "experiments/external/external_files.hpp"

#include <fstream>
#include <limits>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_file.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
using Catch::Contains;

namespace {

struct Asked {
  TemporaryFolder folder;
  KnownSolution known =
      make_known_solution({.bodies = 5, .contacts = 12, .frictionless_fraction = 0.3});
  ExternalRequest request{.problem = known.problem,
                          .start = known.r,
                          .tolerance = 1e-6,
                          .fclib_tolerance = 0.0,
                          .max_iterations = 77,
                          .max_seconds = std::numeric_limits<double>::infinity(),
                          .id = 5};
  ExternalAnswer answer{.reason = StopReason::reached_tolerance,
                        .impulses = known.r,
                        .iterations = 3,
                        .own_residual = 1e-7,
                        .seconds = 0.25,
                        .history = {{0, 0.0, 1.0}, {3, 0.25, 1e-7}}};
  std::filesystem::path file = folder.path() / "file.hdf5";

  std::string refusal() const {
    try {
      read_answer(file, request);
    } catch (const Error& error) {
      return error.what();
    }
    return "taken";
  }
};

}  // namespace

TEST_CASE("A request comes back as the same problem, in both forms") {
  const Asked a;
  REQUIRE(a.known.problem.row_count() < 3 * a.known.problem.contact_count());
  write_request(a.file, a.request);
  const ExternalRequest read = read_request(a.file);
  CHECK(read.tolerance == a.request.tolerance);
  CHECK(read.max_iterations == 77);
  CHECK(read.max_seconds == a.request.max_seconds);
  CHECK(read.id == 5);
  CHECK(read.problem.has_dynamics);
  CHECK(contact_error(read.problem, read.start).natural_map_max < 1e-12);
  {  // W, for who does not want M and H.
    const Hdf5Reader file(a.file);
    CHECK(file.has("/fclib_global/H"));
    CHECK(file.shape("/fclib_local/vectors/q")[0] == 36);
  }
  // Where only W is known, it is what bodies' readers get.
  Asked stored;
  stored.request.problem = condensed(a.known.problem);
  stored.request.start = three_rows(a.known.problem, a.known.r);
  write_request(stored.file, stored.request);
  CHECK_FALSE(read_request(stored.file).problem.has_dynamics);
}

TEST_CASE("An answer comes back with the rows of the problem") {
  const Asked a;
  write_answer(a.file, a.request, a.answer);
  const ExternalAnswer read = read_answer(a.file, a.request);
  CHECK(read.reason == StopReason::reached_tolerance);
  CHECK(read.impulses == a.answer.impulses);
  CHECK(read.iterations == 3);
  CHECK(read.own_residual == 1e-7);
  CHECK(read.seconds == 0.25);
  REQUIRE(read.history.size() == 2);
  CHECK(read.history[1].error == 1e-7);
}

TEST_CASE("What is no answer is refused with the reason") {
  Asked a;
  CHECK_THAT(a.refusal(), Contains("no such file"));
  SECTION("NaN") {
    a.answer.impulses[4] = std::nan("");
    write_answer(a.file, a.request, a.answer);
    CHECK_THAT(a.refusal(), Contains("/ballast_answer/r[") && Contains("not finite"));
  }
  SECTION("another problem's") {
    ExternalRequest other = a.request;
    other.id = 4;
    write_answer(a.file, other, a.answer);
    CHECK_THAT(a.refusal(), Contains("answers another problem"));
  }
  SECTION("another problem's with this number") {
    ExternalRequest other = a.request;
    other.problem = make_known_solution({.bodies = 3, .contacts = 4}).problem;
    a.answer.impulses.setZero(other.problem.row_count());
    write_answer(a.file, other, a.answer);
    CHECK_THAT(a.refusal(), Contains("12 entries, 12 contacts have 36"));
  }
  SECTION("half a file") {
    write_answer(a.file, a.request, a.answer);
    std::filesystem::resize_file(a.file, std::filesystem::file_size(a.file) / 2);
    CHECK_THAT(a.refusal(), Contains("truncated"));
  }
  SECTION("another version") {
    Hdf5Writer file(a.file, Hdf5Storage::plain);
    file.add_group("/ballast_answer");
    file.add("/ballast_answer/protocol", std::vector<int>{2});
    file.commit();
    CHECK_THAT(a.refusal(), Contains("protocol = 2") && Contains("speaks 1"));
  }
  SECTION("a request") {
    write_request(a.file, a.request);
    CHECK_THAT(a.refusal(), Contains("/ballast_answer/protocol: no such dataset"));
  }
}

TEST_CASE("Who cannot solve needs no impulses") {
  Asked a;
  a.answer.verdict = Verdict::unsupported;
  a.answer.impulses.resize(0);
  write_answer(a.file, a.request, a.answer);
  CHECK(read_answer(a.file, a.request).verdict == Verdict::unsupported);
  a.answer.verdict = Verdict::unsolved;
  a.answer.reason = StopReason::reached_tolerance;
  write_answer(a.file, a.request, a.answer);
  CHECK_THAT(a.refusal(), Contains("/ballast_answer/r: no such dataset"));
}

TEST_CASE("A stored problem is no request") {
  const Asked a;
  write_problem(a.file, a.known.problem);
  CHECK_THROWS_WITH(read_request(a.file), Contains("is no request"));
}
