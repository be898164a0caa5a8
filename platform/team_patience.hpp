#pragma once
// When working together does not pay: on a machine that is busy with other programs.

#include <algorithm>

namespace ballast {

/// Told after each round of a team whether somebody was late, it says whether the caller had better
/// do the next ones alone. Each lateness doubles the number of rounds alone, many good rounds halve
/// it: on a busy machine the team is tried rarely enough to cost little, on a free one it works.
class TeamPatience {
 public:
  /// Waiting for the others' last parts for so much longer than one's own took is late [s]: shorter
  /// than the kernel's slice for another program.
  static constexpr double late = 2e-4;

  /// Asked before each round.
  bool works_alone() {
    if (alone_ == 0) return false;
    --alone_;
    return true;
  }

  /// After a round that was worked together.
  void note(bool was_late) {
    if (was_late) {
      next_ = std::min(2 * next_, most);
      alone_ = next_;
      good_ = 0;
    } else if (++good_ == good_rounds) {
      next_ = std::max(next_ / 2, least);
      good_ = 0;
    }
  }

 private:
  static constexpr int least = 32, most = 32768, good_rounds = 256;

  int alone_ = 0;     // rounds that are still to be worked alone
  int next_ = least;  // half of what the next lateness will cost
  int good_ = 0;      // rounds in time, one after another
};

}  // namespace ballast
