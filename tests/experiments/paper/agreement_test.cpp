// The one rule of the verdicts, case by case as its header says it.

#include "experiments/paper/agreement.hpp"

#include "tests/catch.hpp"

using namespace ballast;

namespace {

Agreement exponent_verdict(double value, double half_width, double law_p = 0.5) {
  return agreement_of(
      PaperRange::exponent(-2.0),
      {.value = value, .low = value - half_width, .high = value + half_width, .law_p = law_p});
}

}  // namespace

TEST_CASE("in the range and sharp agrees; wide, of a law that fails, or of a part: partly") {
  CHECK(exponent_verdict(-1.93, 0.05) == Agreement::agrees);
  CHECK(exponent_verdict(-1.93, 0.5) == Agreement::partly);
  CHECK(exponent_verdict(-1.93, 0.05, 1e-3) == Agreement::partly);
  CHECK(exponent_verdict(-1.93, 0.05, not_known) == Agreement::agrees);
  Found found{.value = -1.93, .low = -1.95, .high = -1.91};
  CHECK(agreement_of(PaperRange::exponent(-2.0), part_of(found)) == Agreement::partly);
}

TEST_CASE("scatter is not rewarded: a value far off whose interval reaches the range is open") {
  CHECK(exponent_verdict(-1.75, 0.01) == Agreement::partly);
  CHECK(exponent_verdict(-1.5, 0.1) == Agreement::differs);
  CHECK(exponent_verdict(-1.5, 0.6) == Agreement::reported);
  CHECK(exponent_verdict(-1.93, not_known) == Agreement::reported);
}

TEST_CASE("a bound is not widened") {
  const auto of = [](double value, double half) {
    return agreement_of(PaperRange::at_most(0.26),
                        {.value = value, .low = value - half, .high = value + half});
  };
  CHECK(of(0.2, 0.05) == Agreement::agrees);
  CHECK(of(0.2, 0.1) == Agreement::partly);
  CHECK(of(0.3, 0.01) == Agreement::differs);
  CHECK(of(0.3, 0.1) == Agreement::reported);
  CHECK(agreement_of(PaperRange::at_least(0.0), found(SampleMean{1.0, 0.1, 3})) ==
        Agreement::agrees);
  CHECK(agreement_of(PaperRange::at_least(0.0), found(SampleMean{1.0, not_known, 1})) ==
        Agreement::reported);
}

TEST_CASE("ranges and findings in words") {
  CHECK(plain_words(words_of(PaperRange::exponent(-2.0))) == "−2.1 … −1.9");
  CHECK(plain_words(words_of(PaperRange::roughly(0.01))) == "0.007 … 0.013");
  CHECK(plain_words(words_of(PaperRange::at_most(0.26))) == "≤ 0.26");
  const Found found{.value = -1.7, .low = -1.74, .high = -1.66, .law_p = 1e-4};
  CHECK(plain_words(words_of(found)) == "−1.70 [−1.74, −1.66]; the law misses the points");
}
