#include "experiments/compare/compare_diff.hpp"

#include <limits>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

CompareRow row(const std::string& content, double seconds, Verdict verdict = Verdict::solved) {
  CompareRow made;
  made.case_name = content;
  made.facts.content = content;
  made.solver = "pgs";
  made.tolerance = 1e-4;
  made.solve_seconds = seconds;
  made.verdict = verdict;
  return made;
}

}  // namespace

TEST_CASE("Each change has its word, and what matters comes first") {
  const std::vector<CompareRow> before = {row("slower", 1.0),
                                          row("faster", 1.0),
                                          row("same", 1.0),
                                          row("lost", 1.0),
                                          row("gone", 1.0),
                                          row("gained", 9.0, Verdict::timeout),
                                          row("never", 9.0, Verdict::crashed)};
  const std::vector<CompareRow> after = {row("slower", 1.2),
                                         row("faster", 0.8),
                                         row("same", 1.05),
                                         row("lost", 9.0, Verdict::timeout),
                                         row("gained", 1.0),
                                         row("new", 1.0),
                                         row("never", 9.0, Verdict::unsolved)};
  const auto changes = compare_diff(before, after, 1.1);
  REQUIRE(changes.size() == 8);
  CHECK(changes[0].change == Change::lost);
  CHECK(changes[1].change == Change::slower);
  CHECK(changes[1].before == 1.0);
  CHECK(changes[1].after == 1.2);
  for (const ChangedSolve& solve : changes) {
    INFO(solve.case_name << ": " << name_of(solve.change));
    if (solve.case_name == "gone")
      CHECK(solve.change == Change::only_before);
    else if (solve.case_name == "new")
      CHECK(solve.change == Change::only_after);
    else if (solve.case_name == "never")
      CHECK(solve.change == Change::same);
    else
      CHECK(solve.case_name == name_of(solve.change));
  }
}

TEST_CASE("A change within the spread of the repeats is none") {
  const std::vector<CompareRow> before = {row("a", 1.0), row("a", 1.1), row("a", 1.5)};
  const auto with = [&](double seconds) {
    const std::vector<CompareRow> after = {row("a", seconds)};
    const auto changes = compare_diff(before, after, 1.05);
    REQUIRE(changes.size() == 1);
    return changes[0];
  };
  CHECK(with(1.3).spread == 1.5);
  CHECK(with(1.3).before == 1.1);
  CHECK(with(1.3).change == Change::same);
  CHECK(with(1.7).change == Change::slower);
  CHECK(with(0.7).change == Change::faster);
}

TEST_CASE("A solve of which one repeat is not solved any more is lost") {
  const std::vector<CompareRow> before = {row("a", 1.0), row("a", 1.1)};
  const std::vector<CompareRow> after = {row("a", 1.0), row("a", 9.0, Verdict::timeout)};
  CHECK(compare_diff(before, after, 1.1).at(0).change == Change::lost);
  CHECK(compare_diff(after, before, 1.1).at(0).change == Change::gained);
}

TEST_CASE("Between two machines only what is lost counts") {
  const double never = std::numeric_limits<double>::infinity();
  const std::vector<CompareRow> before = {row("a", 1.0), row("b", 1.0)};
  const std::vector<CompareRow> after = {row("a", 50.0), row("b", 9.0, Verdict::unsolved)};
  const auto changes = compare_diff(before, after, never);
  CHECK(changes.at(0).change == Change::lost);
  CHECK(changes.at(1).change == Change::same);
}
