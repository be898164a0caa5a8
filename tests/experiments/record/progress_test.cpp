#include "experiments/record/progress.hpp"

#include <sstream>

#include "tests/catch.hpp"

using namespace ballast;
using Catch::Matchers::Contains;

namespace {

/// The output of a Progress for a run of `steps` steps of 1 ms each.
std::string told(Progress::Style style, int steps, double seconds_per_step) {
  std::ostringstream out;
  double now = 100.0;
  {
    Progress progress(style, out, [&] { return now; });
    StepRecord record;
    record.contacts = 6312;
    record.error_rms = 1.96e-6;
    for (int step = 1; step <= steps; ++step) {
      now += seconds_per_step;
      record.time = 1e-3 * step;
      progress.show("drive", 1.0, record);
    }
    progress.finish();
  }
  return out.str();
}

}  // namespace

TEST_CASE("quiet says nothing") { CHECK(told(Progress::Style::quiet, 1000, 0.05).empty()); }

TEST_CASE("one plain line every ten seconds and one at the end") {
  const std::string text = told(Progress::Style::lines, 1000, 0.05);  // 50 s
  CHECK(std::count(text.begin(), text.end(), '\n') == 5);
  CHECK(text.find('\r') == std::string::npos);
  std::istringstream lines(text);
  std::string line;
  for (int k = 1; k <= 4; ++k) {
    REQUIRE(std::getline(lines, line));
    INFO(line);
    CHECK_THAT(line, Contains("drive ") && Contains(" 50.0 ms/step") && Contains("error 2.0e-06") &&
                         Contains("6312 contacts"));
    CHECK_THAT(line, Contains(std::to_string(20 * k) + " %") &&
                         Contains(std::to_string(50 - 10 * k) + " s left"));
  }
  REQUIRE(std::getline(lines, line));
  CHECK_THAT(line, Contains("100 %") && !Contains("left"));
  CHECK(told(Progress::Style::lines, 10, 0.01).find('\n') ==
        told(Progress::Style::lines, 10, 0.01).size() - 1);
}

TEST_CASE("a bar rewrites its line, at most ten times a second, and ends it") {
  const std::string text = told(Progress::Style::bar, 1000, 0.01);  // 10 s
  CHECK(std::count(text.begin(), text.end(), '\n') == 1);
  CHECK(text.back() == '\n');
  const auto writes = std::count(text.begin(), text.end(), '\r');
  CHECK((writes >= 80 && writes <= 102));
  CHECK_THAT(text, Contains("[######......]") && Contains("[############] 100 %"));
}

TEST_CASE("phases, resumed runs and silence") {
  std::ostringstream out;
  double now = 0.0;
  {
    Progress progress(Progress::Style::lines, out, [&] { return now; });
    progress.finish();  // nothing was shown yet
    CHECK(out.str().empty());
    StepRecord record;
    for (int step = 1; step <= 30; ++step) {
      record.time = 0.01 * step;
      progress.show("rain", 3.0, record, 0.5);
      now += 1.0;
    }
    progress.finish();
    out.str("");
    // When a phase is entered in its middle, the rate counts from there.
    for (int step = 1; step <= 12; ++step) {
      record.time = 0.5 + 0.01 * step;
      progress.show("drive", 1.0, record);
      now += 1.0;
    }
  }
  CHECK_THAT(out.str(), Contains("drive ") && Contains("39 s left") && Contains("1000.0 ms/step") &&
                            !Contains("rms"));
}

TEST_CASE("where the end is not known, neither part nor time left is made up") {
  std::ostringstream out;
  Progress progress(Progress::Style::lines, out, [] { return 0.0; });
  StepRecord record;
  for (int step = 1; step < 10; ++step) {
    record.time = 1e-3 * step;
    progress.show("rain", std::nan(""), record, 0.5);
  }
  progress.finish();
  CHECK_THAT(out.str(), Contains("rain   ? %  0.009 s") && !Contains("left") && !Contains("nan"));
}
