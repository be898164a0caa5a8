// A comparison: crashes and timeouts are rows, nobody is believed without the judge, and what is
// there is not done again.

#include "experiments/compare/comparison.hpp"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <thread>

#include "experiments/compare/compare_options.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// A backend of the test that does to the process what a broken one might.
template <typename Act>
class Misbehaving final : public Solver {
 public:
  void prepare(const FrictionProblem&) override {}
  Solved solve(const FrictionProblem& problem, Impulses start, const Budget&) override {
    Solved solved;
    solved.impulses = std::move(start);
    Act{}(problem, solved);
    return solved;
  }
};

struct Crash {
  void operator()(const FrictionProblem&, Solved&) const { raise(SIGKILL); }
};
struct Hang {
  void operator()(const FrictionProblem&, Solved&) const {
    for (;;) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
};
struct Lie {
  void operator()(const FrictionProblem&, Solved& solved) const {
    solved.reason = StopReason::reached_tolerance;
  }
};
struct Throw {
  void operator()(const FrictionProblem&, Solved&) const {
    throw std::runtime_error("thrown on purpose");
  }
};
struct Refuse {
  void operator()(const FrictionProblem&, Solved&) const {
    throw UnsupportedProblem("refuse: on purpose");
  }
};
struct NoMemory {
  void operator()(const FrictionProblem&, Solved&) const { throw std::bad_alloc(); }
};

template <typename Act>
ComparedSolver misbehaving(const char* name) {
  return {name, ContactLaw::coulomb,
          []() -> std::unique_ptr<Solver> { return std::make_unique<Misbehaving<Act>>(); }};
}

CompareOptions options_in(const fs::path& folder, std::vector<ComparedSolver> solvers) {
  CompareOptions options;
  options.solvers = std::move(solvers);
  options.folder = folder;
  options.limits.memory_MB = 0.0;  // sanitizers reserve terabytes
  options.limits.warm_seconds = 0.0;
  options.max_seconds = 20.0;
  return options;
}

bool go_on(const CompareRow&, bool, size_t, size_t) { return true; }

std::vector<CompareCase> one_case() { return compare_cases({"known:contacts=12,bodies=6,seed=3"}); }

}  // namespace

TEST_CASE("Whatever a backend does becomes a row") {
  const TemporaryFolder folder;
  CompareOptions options =
      options_in(folder.path(),
                 {misbehaving<Crash>("crash"), misbehaving<Lie>("lie"), misbehaving<Throw>("throw"),
                  misbehaving<Refuse>("refuse"), misbehaving<NoMemory>("no_memory")});
  options.solvers.push_back(parse_solvers("pgs")[0]);
  options.tolerances = {1e-6};
  const std::vector<CompareRow> rows = run_comparison(one_case(), options, go_on);
  REQUIRE(rows.size() == 6);
  CHECK(rows[0].outcome == Outcome::crashed);
  CHECK(rows[1].outcome == Outcome::stopped);
  CHECK(rows[1].is_false_success());
  CHECK(rows[2].outcome == Outcome::stopped);
  CHECK(rows[2].note == "thrown on purpose");
  CHECK_FALSE(rows[2].claimed);
  CHECK(rows[3].outcome == Outcome::unsupported);
  CHECK(rows[3].note == "refuse: on purpose");
  CHECK(rows[4].outcome == Outcome::out_of_memory);
  CHECK(rows[5].outcome == Outcome::solved);
  CHECK(rows[5].error <= 1e-6);
  CHECK(rows[5].history.size() > 2);
  CHECK(rows[5].worst_contact >= 0);
  const std::string csv = read_whole_file(folder.path() / "results.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 7);
  CHECK(fs::exists(folder.path() / "manifest.json"));
}

TEST_CASE("A backend that does not stop is stopped") {
  const TemporaryFolder folder;
  CompareOptions options =
      options_in(folder.path(), {misbehaving<Hang>("hang"), parse_solvers("pgs")[0]});
  options.tolerances = {1e-4};
  options.max_seconds = 0.2;
  const std::vector<CompareRow> rows = run_comparison(one_case(), options, go_on);
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].outcome == Outcome::timeout);
  CHECK(rows[0].note.find("killed") != std::string::npos);
  CHECK(rows[1].outcome == Outcome::solved);
}

TEST_CASE("The measure of Siconos is reached through falling tolerances on the natural map") {
  const TemporaryFolder folder;
  CompareOptions options = options_in(folder.path(), parse_solvers("pgs,nncg"));
  options.measure = Measure::fclib;
  options.tolerances = {1e-3, 1e-7};
  const std::vector<CompareRow> rows = run_comparison(
      compare_cases({"known:contacts=20,bodies=10,seed=2,mass_ratio=100"}), options, go_on);
  REQUIRE(rows.size() == 4);
  for (const CompareRow& row : rows) {
    INFO(row.solver << " " << row.tolerance);
    CHECK(row.outcome == Outcome::solved);
    CHECK(row.error == row.fclib);
    CHECK(row.fclib <= row.tolerance);
    CHECK(row.rounds >= 1);
    for (size_t k = 1; k < row.history.size(); ++k)
      CHECK(row.history[k].seconds >= row.history[k - 1].seconds);
  }
  CHECK(rows[2].rounds > 1);  // 1e-7 is more than one fall of 1e-3
}

TEST_CASE("Rows that are there are not made again, and a change of options makes new ones") {
  const TemporaryFolder folder;
  CompareOptions options = options_in(folder.path(), parse_solvers("pgs"));
  options.tolerances = {1e-4, 1e-6};
  options.repeats = 2;
  int made = 0;
  const auto count = [&](const CompareRow&, bool was_there, size_t, size_t) {
    made += !was_there;
    return true;
  };
  const std::vector<CompareRow> first = run_comparison(one_case(), options, count);
  CHECK(made == 4);
  const std::vector<CompareRow> second = run_comparison(one_case(), options, count);
  CHECK(made == 4);
  REQUIRE(second.size() == first.size());
  for (size_t k = 0; k < first.size(); ++k) CHECK(to_json(first[k]) == to_json(second[k]));
  options.max_seconds = 21.0;
  run_comparison(one_case(), options, count);
  CHECK(made == 8);
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
      return true;
    });
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  int made = 0;
  const std::vector<CompareRow> rows =
      run_comparison(cases, options, [&](const CompareRow&, bool was_there, size_t, size_t) {
        made += !was_there;
        return true;
      });
  CHECK(rows.size() == 30);
  CHECK(made == 23);
  for (const CompareRow& row : rows) CHECK(row.outcome == Outcome::solved);
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
      return !InterruptGuard::requested();
    });
  }
  const InterruptGuard forgotten;  // for the tests that follow
  CHECK(rows.size() == 2);
  CHECK(read_whole_file(folder.path() / "manifest.json").find("the same command goes on") !=
        std::string::npos);
}

TEST_CASE("A row survives its file to the last bit") {
  CompareRow row;
  row.key = "k";
  row.case_name = "a, \"b\"";
  row.note = "line\nbreak";
  row.error = 0.1 + 0.2;
  row.fclib = std::nan("");
  row.outcome = Outcome::timeout;
  row.start = StartKind::warm;
  row.measure = Measure::fclib;
  row.history = {{0, 1, 1e-300, 1.0 / 3.0}, {1, 2, 0.5, 5e-324}};
  const CompareRow back = compare_row_of_json(to_json(row), "file");
  CHECK(to_json(back) == to_json(row));
  CHECK(back.error == row.error);
  CHECK(std::isnan(back.fclib));
  REQUIRE(back.history.size() == 2);
  CHECK(back.history[1].error == 5e-324);
  CHECK(compare_csv({row}).find("\"a, \"\"b\"\"\"") != std::string::npos);
  CHECK_THROWS_WITH(compare_row_of_json("{}", "row.json"),
                    Catch::StartsWith("row.json: is no row"));
}

TEST_CASE("Cases: families, names, and what is refused") {
  CHECK(family_of_file("Capsules-i101-404.dat") == "Capsules");
  CHECK(family_of_file("Rover1039.dat") == "Rover");
  CHECK(family_of_file("NESpheres_30_1.dat") == "NESpheres");
  CHECK(compare_cases({"known:count=3"}).size() == 3);
  const std::vector<CompareCase> made = compare_cases({"stress:stack,ratio=1e3", "stress:all"});
  CHECK(made.size() > 10);
  CHECK(made[0].load().facts.mass_ratio == Approx(1e3));
  CHECK(made[0].load().facts.velocity_scale == 9.81e-3);
  for (const CompareCase& c : made) CHECK_NOTHROW(c.load());
  const TemporaryFolder folder;
  for (const std::string word :
       {"known:bodies=x", "known:colour=3", "known:contacts=0", "known:bodies",
        "stress:", "stress:stack,weight=3", "stress:stack,rows=2", "/no/such/file.dat"})
    CHECK_THROWS_AS(compare_cases({word}), Error);
  CHECK_THROWS_AS(compare_cases({folder.path().string()}), Error);
  CHECK_THROWS_AS(compare_cases({folder.write("notes.txt", "").string()}), Error);
  folder.write("b.dat", "3 0 0 0 0");
  folder.write("a.dat", "3 0 0 0 0");
  const std::vector<CompareCase> cases =
      compare_cases({(folder.path() / "*.dat").string(), folder.path().string()});
  REQUIRE(cases.size() == 4);
  CHECK(cases[0].name == "a.dat");
  CHECK(cases[2].name == "a.dat (2)");
}

TEST_CASE("What is measured of a case") {
  KnownSolutionSettings settings;
  settings.bodies = 3;
  settings.contacts = 40;
  settings.frictionless_fraction = 0.0;
  const KnownSolution known = make_known_solution(settings);
  const CaseFacts facts = case_facts(known.problem, {}, 2.0);
  CHECK(facts.contacts == 40);
  CHECK(facts.rows == 120);
  CHECK(facts.dofs == 18);
  CHECK(facts.rank_deficiency == Approx(1.0 - 18.0 / 120.0));
  CHECK(facts.mass_ratio == Approx(1.0));
  FrictionProblem stored = known.problem;  // W alone
  add_delassus_form(stored);
  stored.has_dynamics = false;
  CHECK(case_facts(stored, {}, 2.0).dofs == 0);
  CHECK(case_facts(stored, {}, 2.0).rank_deficiency == Approx(facts.rank_deficiency));
  CHECK(case_facts(stored, {}, 2.0).mass_ratio > 1.0);
  CHECK(case_facts(known.problem, known.r, 2.0).content != facts.content);
  CHECK(case_facts(known.problem, {}, 3.0).content != facts.content);
  CHECK(case_facts(known.problem, {}, 2.0).content == facts.content);
}
