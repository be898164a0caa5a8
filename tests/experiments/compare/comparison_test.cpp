// A comparison tries every combination once, keeps stored rows, and goes on after any crash.

#include "experiments/compare/comparison.hpp"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "platform/atomic_file.hpp"
#include "platform/interrupt.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

CompareOptions options_in(const fs::path& folder, std::vector<ComparedSolver> solvers) {
  CompareOptions options;
  options.solvers = std::move(solvers);
  options.folder = folder;
  options.limits.memory_MB = 0.0;  // sanitizers reserve terabytes
  options.limits.min_timing_seconds = 0.0;
  options.max_seconds = 20.0;
  return options;
}

void untold(const CompareRow&, bool, size_t, size_t) {}

std::vector<CompareCase> one_case() { return compare_cases({"known:contacts=12,bodies=6,seed=3"}); }

}  // namespace

TEST_CASE("Rows that are there are not made again, damage or other options make new ones") {
  const TemporaryFolder folder;
  CompareOptions options = options_in(folder.path(), parse_solvers("pgs"));
  options.tolerances = {1e-4, 1e-6};
  options.repeats = 2;
  int made = 0;
  const auto count = [&](const CompareRow&, bool was_stored, size_t, size_t) {
    made += !was_stored;
  };
  const std::vector<CompareRow> first = run_comparison(one_case(), options, count);
  CHECK(made == 4);
  const std::vector<CompareRow> second = run_comparison(one_case(), options, count);
  CHECK(made == 4);
  REQUIRE(second.size() == first.size());
  for (size_t k = 0; k < first.size(); ++k) CHECK(to_json(first[k]) == to_json(second[k]));
  // A damaged row is made again.
  const fs::path file = folder.path() / "rows" / (first[0].key + ".json");
  write_whole_file(file, read_whole_file(file).substr(0, 40));
  CHECK(run_comparison(one_case(), options, count).at(0).verdict == Verdict::solved);
  CHECK(made == 5);
  CHECK(compare_row_of_json(read_whole_file(file), file.string()).key == first[0].key);
  // So is one with the content of another row.
  write_whole_file(file, to_json(first[1]));
  CHECK(run_comparison(one_case(), options, count).at(0).tolerance == first[0].tolerance);
  CHECK(made == 6);
  options.max_seconds = 21.0;
  run_comparison(one_case(), options, count);
  CHECK(made == 10);
}

TEST_CASE("A comparison goes on after kill -9") {
  const TemporaryFolder folder;
  const std::vector<CompareCase> cases = compare_cases({"known:contacts=12,bodies=6,count=30"});
  CompareOptions options = options_in(folder.path(), parse_solvers("pgs"));
  options.tolerances = {1e-6};
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    run_comparison(cases, options, [](const CompareRow&, bool, size_t done, size_t) {
      if (done == 7) kill(getpid(), SIGKILL);
    });
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  int made = 0;
  const std::vector<CompareRow> rows = run_comparison(
      cases, options,
      [&](const CompareRow&, bool was_stored, size_t, size_t) { made += !was_stored; });
  CHECK(rows.size() == 30);
  CHECK(made == 23);
  for (const CompareRow& row : rows) CHECK(row.verdict == Verdict::solved);
}

TEST_CASE("An interrupt stops the comparison after the row under way") {
  const TemporaryFolder folder;
  const std::vector<CompareCase> cases = compare_cases({"known:contacts=12,bodies=6,count=5"});
  CompareOptions options = options_in(folder.path(), parse_solvers("pgs"));
  options.tolerances = {1e-6};
  std::vector<CompareRow> rows;
  {
    const InterruptGuard guard;
    rows = run_comparison(cases, options, [](const CompareRow&, bool, size_t done, size_t) {
      if (done == 2) raise(SIGINT);
    });
  }
  const InterruptGuard forgotten;  // forgets the interrupt for the tests that follow
  CHECK(rows.size() == 2);
  CHECK(read_whole_file(folder.path() / "manifest.json").find("the same command goes on") !=
        std::string::npos);
}

TEST_CASE("Every case is tried by every solver to every tolerance, and the table says so") {
  const TemporaryFolder folder;
  CompareOptions options = options_in(folder.path(), parse_solvers("pgs,nncg"));
  options.tolerances = {1e-2, 1e-4};
  options.starts = {StartKind::cold, StartKind::warm};  // made cases have no warm start
  options.exact_seconds = 5.0;
  size_t last = 0;
  const std::vector<CompareRow> rows =
      run_comparison(compare_cases({"known:contacts=12,bodies=6,count=2"}), options,
                     [&](const CompareRow&, bool, size_t done, size_t count) {
                       CHECK(done > last);
                       last = done;
                       CHECK(count == 16);
                     });
  CHECK(last == 16);  // combinations that cannot be tried count as done
  REQUIRE(rows.size() == 8);
  CHECK(rows[0].solver == "pgs");
  CHECK(rows[1].solver == "nncg");
  CHECK(rows[1].tolerance == 1e-2);
  CHECK(rows[2].tolerance == 1e-4);
  CHECK(rows[4].case_name != rows[0].case_name);
  CHECK(rows[0].distance.velocity > 0.0);
  CHECK(rows[2].distance.velocity < 0.1 * rows[0].distance.velocity);
  CHECK(rows[2].distance.statuses >= 0);
  const std::string csv = read_whole_file(folder.path() / "results.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 9);
  const std::string manifest = read_whole_file(folder.path() / "manifest.json");
  CHECK(manifest.find("\"solved\": 8") != std::string::npos);
}

TEST_CASE("What a looser tolerance took all the time for is not tried to a tighter one") {
  const TemporaryFolder folder;
  CompareOptions options = options_in(folder.path(), parse_solvers("pgs,nncg"));
  options.tolerances = {1e-2, 1e-4};
  options.max_seconds = 1e-9;
  const std::vector<CompareRow> rows = run_comparison(one_case(), options, untold);
  REQUIRE(rows.size() == 4);
  for (const size_t k : {0, 1}) {
    const CompareRow &loose = rows[k], &tight = rows[k + 2];
    CHECK(loose.verdict == Verdict::timeout);
    CHECK(loose.note.empty());
    CHECK(tight.verdict == Verdict::timeout);
    CHECK(tight.note == "not tried: out of time to 0.01 already");
    CHECK(tight.tolerance == 1e-4);
    CHECK(tight.solver == loose.solver);
    CHECK(tight.key != loose.key);
    CHECK(tight.solve_seconds == loose.solve_seconds);
  }
  options.max_seconds = 20.0;
  for (const CompareRow& row : run_comparison(one_case(), options, untold)) CHECK(row.note.empty());
}

TEST_CASE("A solve is repeated where another tolerance of the case was missed") {
  const TemporaryFolder folder;
  CompareOptions options = options_in(folder.path(), parse_solvers("pgs"));
  options.tolerances = {1e-7, 1e-30};
  options.repeats = 3;
  int solved = 0, missed = 0;
  for (const CompareRow& row : run_comparison(one_case(), options, untold))
    ++(row.verdict == Verdict::solved ? solved : missed);
  CHECK(solved == 3);
  CHECK(missed == 1);
}

TEST_CASE("A case that cannot be read is one row with its reason, and the others go on") {
  const TemporaryFolder folder;
  std::vector<CompareCase> cases = compare_cases({"known:contacts=12,bodies=6,count=2"});
  const std::string broken = folder.write("broken.dat", "no problem").string();
  cases.insert(cases.begin() + 1, compare_cases({broken}).front());
  CompareOptions options = options_in(folder.path(), parse_solvers("pgs,nncg"));
  options.tolerances = {1e-2, 1e-4};
  options.repeats = 2;
  size_t last = 0;
  const auto follow = [&](const CompareRow&, bool, size_t done, size_t count) {
    CHECK(done > last);
    CHECK(count == 24);
    last = done;
  };
  const std::vector<CompareRow> rows = run_comparison(cases, options, follow);
  CHECK(last == 24);
  REQUIRE(rows.size() == 4 + 1 + 4 + 8);  // the unreadable case has one row, also with two repeats
  CHECK(rows[4].verdict == Verdict::unreadable);
  CHECK(rows[4].case_name == "broken.dat");
  CHECK(rows[4].solver.empty());
  CHECK_THAT(rows[4].note, Catch::Contains(broken));
  CHECK(std::ranges::count(rows, Verdict::solved, &CompareRow::verdict) == 16);
  CHECK(read_whole_file(folder.path() / "results.csv").find("unreadable") != std::string::npos);
  // Once mended, the case is tried.
  write_whole_file(broken, "3\n1\n0 3 3\n3 3\n1 0 0 0 1 0 0 0 1\n-1 0 0\n0.5\n");
  last = 0;
  const std::vector<CompareRow> mended = run_comparison(cases, options, follow);
  CHECK(std::ranges::count(mended, Verdict::solved, &CompareRow::verdict) == 24);
}

TEST_CASE("Tolerances come sorted from loose to tight, each once") {
  CHECK(parse_tolerances("1e-8,0.01,1e-4,1e-2") == std::vector<double>{1e-2, 1e-4, 1e-8});
  for (const char* wrong : {"", "1e-4,", "0", "-1", "nan", "inf", "1e-4x", "1e-4 1e-8"})
    CHECK_THROWS_AS(parse_tolerances(wrong), std::invalid_argument);
  CHECK_THROWS_WITH(parse_tolerances("1e-4,,2"), Catch::Contains("a number > 0"));
}

TEST_CASE("Starts are cold or warm, each once") {
  CHECK(parse_starts("warm,cold,warm") == std::vector{StartKind::warm, StartKind::cold});
  CHECK_THROWS_WITH(parse_starts("tepid"), Catch::Contains("cold, warm"));
}

TEST_CASE("Solvers are taken from the list by name, each once, or all that were built") {
  const std::vector<ComparedSolver> two = parse_solvers("pgs,nncg,pgs");
  REQUIRE(two.size() == 2);
  CHECK(two[0].name == "pgs");
  CHECK(two[1].name == "nncg");
  CHECK(two[0].make() != nullptr);
  size_t built = 0;
  for (const SolverEntry& entry : solver_list()) built += entry.make != nullptr;
  CHECK(parse_solvers("all").size() == built);
  CHECK_THROWS_AS(parse_solvers("oracle"), UnknownSolver);
  CHECK_THROWS_AS(parse_solvers("pgs,"), UnknownSolver);
}
