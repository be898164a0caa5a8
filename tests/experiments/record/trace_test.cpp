// A plot in one line.

#include "experiments/record/trace.hpp"

#include <cmath>
#include <cstdlib>

#include "platform/status_line.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE(
    "A trace rises from the lowest block to the highest, and is blank where nothing is known") {
  Trace trace;
  CHECK(trace.is_flat());
  for (int k = 0; k < 480; ++k) trace.add(k / 960.0, k);
  CHECK_FALSE(trace.is_flat());
  CHECK(trace.text(16) == "▁▂▃▄▅▆▇█        ");
  CHECK(columns_of(trace.text(12)) == 12);
  CHECK(trace.text(0).empty());
}

TEST_CASE("Equal ratios are equal heights of a logarithmic trace") {
  Trace trace(true);
  for (int k = 0; k < 8; ++k) trace.add((k + 0.9) / 8.0, std::pow(10.0, k));
  CHECK(trace.text(8) == "▁▂▃▄▅▆▇█");
}

TEST_CASE("What cannot be shown is left out, and one value is flat") {
  Trace trace(true);
  for (const double value : {0.0, -1.0, std::nan(""), 5.0}) trace.add(0.5, value);
  trace.add(-0.1, 7.0);
  trace.add(std::nan(""), 7.0);
  CHECK(trace.is_flat());
  CHECK(trace.text(2) == " ▁");
}

TEST_CASE("Unicode is written where the locale says so") {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) unsetenv(name);
  CHECK_FALSE(writes_unicode());
  setenv("LANG", "en_US.UTF-8", 1);
  CHECK(writes_unicode());
  setenv("LC_ALL", "C", 1);
  CHECK_FALSE(writes_unicode());
  unsetenv("LC_ALL");
}
