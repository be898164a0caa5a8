// Times that others reached, read from their table and held beside ours.

#include "experiments/compare/reference_times.hpp"

#include <cmath>

#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("Reference times: names that differ by their suffixes, and ratios") {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "ref.csv", "problem,ms_1e-4,solver_1e-4\nx-condensed.dat,500,NSGS\ny.dat,,\nz.dat,7,ADMM\n");
  const std::vector<ReferenceTimes> reference = read_reference_times(file);
  REQUIRE(reference.size() == 1);
  CHECK(reference[0].tolerance == 1e-4);
  CHECK(reference[0].entries.at("x").seconds == Approx(0.5));
  const std::vector<CompareRow> rows = {
      hand_made_row("x.hdf5", "a", 2.0, Verdict::solved),
      hand_made_row("x.hdf5", "auto", 1.0, Verdict::solved),
      hand_made_row("y.dat", "a", 3.0, Verdict::solved),
      hand_made_row("y.dat", "auto", 4.0, Verdict::unsolved),
      hand_made_row("x.hdf5", "siconos_nsgs", 0.1, Verdict::solved)};
  const std::vector<CompareTable> tables = compare_tables(rows);
  const std::vector<ReferenceComparison> compared = compare_with_reference(tables, reference);
  REQUIRE(compared.size() == 1);
  REQUIRE(compared[0].lines.size() == 1);
  CHECK(compared[0].lines[0].our_solver == "auto");
  CHECK(compared[0].only_ours == std::vector<std::string>{"y.dat"});
  CHECK(compared[0].missing.empty());
  CHECK(compared[0].ratio(0.0, 60.0, false) == Approx(2.0));
  CHECK(compared[0].ratio(0.5, 60.0, true) == Approx(1.5));
  for (const char* bad :
       {"problem,ms\n", "problem,ms_1e-4,solver\nx,fast,me\n", "problem,ms_1e-4,solver\nx,1\n", ""})
    CHECK_THROWS_AS(read_reference_times(folder.write("bad.csv", bad)), Error);
}

TEST_CASE("What we did not solve counts with the limit, not with infinity") {
  const TemporaryFolder folder;
  const auto reference = read_reference_times(
      folder.write("ref.csv", "problem,ms_1e-4,solver_1e-4\r\nx.dat,1000,NSGS\r\n\r\n"));
  const std::vector<CompareRow> rows = {hand_made_row("x.dat", "a", 60.0, Verdict::timeout)};
  const std::vector<CompareTable> tables = compare_tables(rows);
  const auto compared = compare_with_reference(tables, reference);
  REQUIRE(compared.size() == 1);
  CHECK(compared[0].missing == std::vector<std::string>{"x.dat"});
  CHECK(compared[0].ratio(0.0, 30.0, false) == Approx(30.0));
  CHECK(std::isnan(compared[0].ratio(0.0, 30.0, true)));  // auto was not tried
  CHECK(problem_stem("CubeH8-condensed.dat") == "CubeH8");
  CHECK(problem_stem("CubeH8.hdf5") == "CubeH8");
}
