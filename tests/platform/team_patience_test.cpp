#include "platform/team_patience.hpp"

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Rounds that are worked alone before the team is asked again.
int rounds_alone(TeamPatience& patience) {
  int rounds = 0;
  while (patience.works_alone()) ++rounds;
  return rounds;
}

}  // namespace

TEST_CASE("a team that is in time works together, always") {
  TeamPatience patience;
  for (int round = 0; round < 1000; ++round) {
    CHECK_FALSE(patience.works_alone());
    patience.note(false);
  }
}

TEST_CASE(
    "each lateness doubles the rounds alone, up to a limit, and good rounds bring them down") {
  TeamPatience patience;
  patience.note(true);
  int before = rounds_alone(patience);
  CHECK(before > 0);
  for (int k = 0; k < 5; ++k) {
    patience.note(true);
    CHECK(rounds_alone(patience) == 2 * before);
    before *= 2;
  }
  for (int k = 0; k < 30; ++k) {
    patience.note(true);
    before = rounds_alone(patience);
  }
  CHECK(before < 100000);
  for (int round = 0; round < 100000; ++round) patience.note(false);
  patience.note(true);
  CHECK(rounds_alone(patience) < before / 100);
}

TEST_CASE("on a machine where every trial is late, hardly any round is worked together") {
  TeamPatience patience;
  int together = 0;
  for (int round = 0; round < 1000000; ++round)
    if (!patience.works_alone()) {
      ++together;
      patience.note(true);
    }
  CHECK(together < 50);
}
