#include "experiments/compare/ranking.hpp"

#include <cmath>
#include <numeric>

#include "experiments/compare/compare_page.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"

using namespace ballast;

namespace {

/// A case of run `run` on which the backends a, b, ... take these seconds; 0: not solved.
void add_case(std::vector<CompareRow>& rows, const std::string& name,
              const std::vector<double>& seconds) {
  for (size_t s = 0; s < seconds.size(); ++s) {
    const std::string solver(1, static_cast<char>('a' + s));
    rows.push_back(hand_made_row(name.c_str(), solver.c_str(), std::max(seconds[s], 1.0),
                                 seconds[s] > 0.0 ? Verdict::solved : Verdict::unsolved));
  }
}

std::vector<Eigen::Index> all_of(const TriedCases& tried) {
  std::vector<Eigen::Index> all(tried.cases.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

TEST_CASE("Cases that every backend tried are compared, unsolved ones with the limit") {
  std::vector<CompareRow> rows;
  add_case(rows, "x", {1.0, 2.0});
  add_case(rows, "y", {0.0, 2.0});
  add_case(rows, "z", {1.0});                                        // b did not try it
  rows.push_back(hand_made_row("x", "a", 3.0, Verdict::solved, 1));  // its median becomes 2
  rows.push_back(hand_made_row("w", "", 0.0, Verdict::unreadable));
  rows.push_back(hand_made_row("x", "a", 1.0, Verdict::solved));
  rows.back().tolerance = 1e-8;
  const std::vector<TriedCases> tried = tried_cases(rows);
  REQUIRE(tried.size() == 2);
  CHECK(tried[0].tolerance == 1e-4);
  CHECK(tried[1].solvers == std::vector<std::string>{"a"});
  REQUIRE(tried[0].cases.size() == 2);
  CHECK(tried[0].cases[1]->case_name == "y");
  CHECK(tried[0].log_seconds(0, 0) == Approx(std::log(2.0 + summary_shift)));
  CHECK(tried[0].log_seconds(1, 0) == Approx(std::log(60.0 + summary_shift)));
}

TEST_CASE("Ranks are by mean time, and their range is where they are sure") {
  std::vector<CompareRow> rows;
  Random random(7);
  // a is ten times faster than b and c, which differ from run to run; d and e never solve.
  for (int run = 0; run < 12; ++run)
    for (int step = 0; step < 3; ++step)
      add_case(rows, "run" + std::to_string(run) + "-step_" + std::to_string(step),
               {0.1, run % 2 ? 1.5 : 2.5, run % 2 ? 2.5 : 1.5, 0.0, 0.0});
  const std::vector<TriedCases> tried = tried_cases(rows);
  const std::vector<Estimate> ranks = ranks_of(tried[0], all_of(tried[0]));
  REQUIRE(ranks.size() == 5);
  CHECK(ranks[0].value == 1.0);
  CHECK(ranks[0].high == 1.0);
  CHECK(ranks[1].low == 2.0);
  CHECK(ranks[1].high == 3.0);
  CHECK(ranks[3].value == 4.5);
  CHECK(ranks[4].low == 4.5);
  // The draws are the same every time. With too few runs there is no range.
  CHECK(ranks_of(tried[0], all_of(tried[0]))[2].low == ranks[2].low);
  std::vector<Eigen::Index> few = all_of(tried[0]);
  few.resize(4);  // two runs
  CHECK(ranks_of(tried[0], few)[0].value == 1.0);
  CHECK(std::isnan(ranks_of(tried[0], few)[0].low));
  CHECK(std::isnan(ranks_of(tried[0], {})[0].value));
}

TEST_CASE("Cases of a run are alike, and a phase is no family") {
  CHECK(run_of("shaken/25-1-step_0000050") == "shaken/25-1-");
  CHECK(run_of("pile-c10-s1.hdf5") == "pile-c10-s1.hdf5");
  CompareRow row;
  row.family = "shaken, active";
  CHECK(base_family(row) == "shaken");
}
