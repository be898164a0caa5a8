#include "platform/clock.hpp"

#include <thread>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("a stopwatch runs in seconds, and its laps add up") {
  const Stopwatch whole;
  Stopwatch laps;
  double sum = 0.0;
  for (int lap = 0; lap < 3; ++lap) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    CHECK(laps.seconds() >= 0.0099);
    const double time = laps.restart();
    CHECK(time >= 0.0099);
    sum += time;
  }
  const double all = whole.seconds();
  CHECK(all >= sum);
  CHECK(all < 60.0);  // seconds, not milliseconds
  CHECK(all - sum < 0.5 * all + 0.01);
  CHECK(whole.seconds() >= all);
}

TEST_CASE("a time has passed from its moment on, as the stopwatch itself says") {
  const Stopwatch watch;
  CHECK(watch.has_passed(0.0));
  CHECK_FALSE(watch.has_passed(1e30));
  while (!watch.has_passed(0.03)) CHECK(watch.seconds() < 30.0);
  CHECK(watch.seconds() >= 0.03);
}
