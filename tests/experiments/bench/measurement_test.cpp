// Measurements: their quartiles, their files, and two files side by side.

#include "experiments/bench/measurement.hpp"

#include <algorithm>
#include <cmath>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("A measurement has the quartiles of its values") {
  const Measurement m = measurement_of("g", "n", "ms", {4.0, 1.0, 2.0, 3.0, 10.0});
  CHECK(m.median == 3.0);
  CHECK(m.mean == 4.0);
  CHECK(m.low == 2.0);
  CHECK(m.high == 4.0);
  CHECK(m.samples == 5);
  CHECK(measurement_of("g", "n", "ms", {1.0, 2.0}).median == 1.5);
  CHECK_THROWS_AS(measurement_of("g", "n", "ms", {}), std::invalid_argument);
}

TEST_CASE("Results are written, read and compared") {
  const TemporaryFolder folder;
  const auto a = measurement_of("sweep", "pgs", "ns", {10.0}),
             b = measurement_of("sweep", "pgs", "ns", {5.0}),
             other = measurement_of("sweep", "jacobi", "ns", {7.0});
  write_bench_result(folder.path() / "a", "kernels", "ballast bench kernels", {a, other});
  write_bench_result(folder.path() / "b", "kernels", "ballast bench kernels", {b});
  const BenchResult first = read_bench_result(folder.path() / "a" / "kernels.json");
  CHECK(first.kind == "kernels");
  CHECK_FALSE(first.commit.empty());
  REQUIRE(first.measurements.size() == 2);
  CHECK(first.measurements[0].median == 10.0);
  const std::string table =
      bench_ratio_table(first, read_bench_result(folder.path() / "b" / "kernels.json"));
  CHECK_THAT(table, Catch::Contains("| sweep/pgs | ns | 10 | 5 | 0.5 |"));
  CHECK_THAT(table, Catch::Contains("only in A: sweep/jacobi"));
  write_whole_file(folder.path() / "bad.json", "{\"kind\": 3}");
  CHECK_THROWS_WITH(
      read_bench_result(folder.path() / "bad.json"),
      Catch::EndsWith("bad.json: is no result of ballast bench: " + std::string(broken_json)));
  CHECK_THROWS_AS(read_bench_result(folder.path() / "none.json"), Error);
}

TEST_CASE("What was not finite comes back as not known, and the terminal's table has every line") {
  const TemporaryFolder folder;
  const Measurement lost = measurement_of("g", "lost", "ms", {std::nan("")}),
                    kept = measurement_of("g", "kept", "ms", {2.0});
  write_bench_result(folder.path(), "step", "ballast bench step", {lost, kept});
  const BenchResult back = read_bench_result(folder.path() / "step.json");
  REQUIRE(back.measurements.size() == 2);
  CHECK(std::isnan(back.measurements[0].median));
  CHECK(back.measurements[1].median == 2.0);
  CHECK(back.measurements[1].samples == 1);
  const std::string table = measurement_table(back.measurements);
  CHECK_THAT(table, Catch::Contains("g/lost") && Catch::Contains("g/kept"));
  CHECK(std::count(table.begin(), table.end(), '\n') == 2);
}
