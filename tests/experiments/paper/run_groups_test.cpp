#include "experiments/paper/run_groups.hpp"

#include <cmath>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

VariedValue value_of(double value, std::vector<int> seeds, const std::vector<double>& rises) {
  VariedValue result;
  result.value = value;
  result.seeds = std::move(seeds);
  for (const double rise : rises) {
    result.samples.emplace_back();
    result.samples.back().rise = rise;
  }
  return result;
}

}  // namespace

TEST_CASE("exponents between two values compare every sample with itself") {
  // ten times the displacement in the second sample: no error of the exponent
  const VariedValue a = value_of(5.0, {1, 2, 3}, {4.0, 40.0, 7.0}),
                    b = value_of(10.0, {1, 2}, {1.0, 10.0});
  const SampleMean exponent = exponent_between(a, b, &Observation::rise);
  CHECK(exponent.samples == 2);
  CHECK(exponent.mean == Approx(-2.0));
  CHECK(exponent.error == Approx(0.0).margin(1e-12));
  const SampleMean between = interpolated(a, b, 7.0, &Observation::rise);
  CHECK(between.mean == Approx(0.5 * (4.0 + 40.0) * 25.0 / 49.0));
  CHECK(std::isnan(exponent_between(a, value_of(10.0, {4}, {1.0}), &Observation::rise).mean));
}

TEST_CASE("a group knows its values, and says nothing of others") {
  const RunGroup group{"f", {value_of(5.0, {1, 2}, {1.0, 3.0}), value_of(10.0, {1}, {4.0})}};
  REQUIRE(group.at(10.0));
  CHECK(group.at(10.0)->value == 10.0);
  CHECK(group.at(7.0) == nullptr);
  const SampleMean mean = group.mean_at(5.0, &Observation::rise);
  CHECK(mean.mean == 2.0);
  CHECK(std::isnan(group.mean_at(7.0, &Observation::rise).mean));
}

TEST_CASE("a table of observables has their heads where its words say {observables}") {
  const page::Table table = observable_table("looseness.slow");
  REQUIRE(table.head.size() == 3 + observable_columns().size());
  CHECK(plain_words(table.head[0]) == "solver");
  CHECK(plain_words(table.head[3]) == "Δx_max (mm)");
  CHECK_FALSE(table.caption.empty());
}

TEST_CASE("what a packing has in common is in the scatter between samples, not from run to run") {
  // two packings that always differ by a factor e^2, and runs that miss that by e^0.2
  const auto logs = [](double a, double b) {
    return std::vector<double>{std::exp(a), std::exp(b)};
  };
  const std::vector<VariedValue> values{value_of(1.0, {1, 2}, logs(0.0, 2.2)),
                                        value_of(2.0, {1, 2}, logs(5.0, 6.8)),
                                        value_of(3.0, {1}, {7.0})};
  const PooledError between = scatter_between(values, &Observation::rise),
                    paired = scatter_paired(values, &Observation::rise);
  CHECK(between.degrees_of_freedom == 2);
  CHECK(between.deviation == Approx(std::sqrt(0.5 * (2.2 * 2.2 / 2.0 + 1.8 * 1.8 / 2.0))));
  CHECK(paired.degrees_of_freedom == 1);
  CHECK(paired.deviation == Approx(0.2));  // differences of 2.2 and 1.8, made of four runs
  CHECK(scatter_paired({values[0]}, &Observation::rise).degrees_of_freedom == 0);
}
