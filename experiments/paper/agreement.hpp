#pragma once
// One rule that says whether Ballast and the paper agree. It is applied to every row of the
// report's first table; docs/manual/paper.md states it in words.
//
// The paper's words are a range of values, Ballast's a value with its 95 % interval.
//   agrees    the value lies in the range, its interval within three times the range, the law whose
//             parameter it is holds within the samples' scatter (p >= 0.01), and the whole of the
//             paper's statement was tested
//   partly    the value lies in the range, but one of the other three is missing; or it lies within
//             three times the range
//   DIFFERS   the value lies farther off, and its interval does not reach the range
//   reported  there is no interval, or it reaches the range although the value lies far off: not
//             decided

#include "experiments/measure/curve_fit.hpp"
#include "experiments/page/text.hpp"

namespace ballast {

enum class Agreement { agrees, partly, differs, reported };
const char* word_of(Agreement agreement);

/// What the paper's words allow. One side may be infinite; three times such a range is the range.
struct PaperRange {
  double low, high;

  static PaperRange about(double value, double half_width);
  static PaperRange exponent(double value);  ///< 0.1 to both sides
  /// A number written with "~", or "almost": 30 % to both sides.
  static PaperRange roughly(double value);
  static PaperRange at_most(double value);
  static PaperRange at_least(double value);

  bool holds(double value) const { return low <= value && value <= high; }
  PaperRange widened() const;  ///< three times as wide, about the same middle
};

/// What Ballast found.
struct Found {
  double value = not_known, low = not_known, high = not_known;  ///< with its 95 % interval
  double law_p = 1.0;    ///< of the misfit of the law whose parameter it is
  bool is_whole = true;  ///< false: a part of the paper's statement, or samples chosen by it
};
/// Student's interval; of one sample there is none.
Found found(const SampleMean& mean);
Found found(const PowerFit& fit, double law_p);
/// The same, of a part of the paper's statement.
Found part_of(Found found);

Agreement agreement_of(const PaperRange& paper, const Found& found);

/// "−2.1 … −1.9", "≤ 0.26"
page::Text words_of(const PaperRange& range);
/// "−1.70 [−1.74, −1.66]", and what keeps it from agreeing besides its value.
page::Text words_of(const Found& found);

}  // namespace ballast
