#include "experiments/box/packing_cache.hpp"

#include <cmath>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("where the speed falls off exponentially, the time of rest is known") {
  RestForecast forecast(1e-3, 0.1);
  for (int step = 0; step < 400; ++step) {
    const double time = 0.2 + 1e-3 * step;
    forecast.note(time, 2.0 * std::exp(-10.0 * time));
  }
  CHECK(forecast.end() == Approx(std::log(2000.0) / 10.0).epsilon(1e-10));
}

TEST_CASE("while grains fall nothing is known, and rest is never in the past") {
  RestForecast forecast(0.05, 0.5);
  CHECK(std::isnan(forecast.end()));
  for (int step = 1; step < 100; ++step) forecast.note(1e-3 * step, 9.81e-3 * step);
  CHECK(std::isnan(forecast.end()));
  // slower than rest before everything has come down
  for (int step = 100; step < 300; ++step)
    forecast.note(1e-3 * step, 1e-3 * std::exp(-0.01 * step));
  CHECK(forecast.end() == 0.5);
  for (int step = 300; step < 900; ++step)
    forecast.note(1e-3 * step, 1e-3 * std::exp(-0.01 * step));
  CHECK(forecast.end() >= 0.89);
}
