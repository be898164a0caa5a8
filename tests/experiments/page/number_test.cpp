#include "experiments/page/number.hpp"

#include <limits>

#include "experiments/measure/curve_fit.hpp"
#include "tests/catch.hpp"

namespace ballast::page {
namespace {

TEST_CASE("numbers as a reader wants them") {
  const auto text = [](double value, int digits = 3) { return plain_words(number(value, digits)); };
  CHECK(text(0.0) == "0");
  CHECK(text(1.23456) == "1.23");
  CHECK(text(0.00123456) == "0.00123");
  CHECK(text(0.000123456) == "1.23×10⁻⁴");
  CHECK(text(-17.96) == "−18.0");
  CHECK(text(123456.0) == "123456");
  CHECK(text(999999.9) == "1.00×10⁶");
  CHECK(text(0.0009999) == "0.00100");
  CHECK(text(5.0e-324, 2) == "4.9×10⁻³²⁴");
  CHECK(number(1e-9, 1).spans == std::vector<Span>{{"1×10", 0, ""}, {"−9", superscript, ""}});
}

TEST_CASE("what is not known is a dash, with no unit and no error") {
  const Text dash("–", note);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double value : {not_known, infinite, -infinite}) {
    CHECK(number(value) == dash);
    CHECK(exact(value) == dash);
    CHECK(quantity(value, "mm") == dash);
    CHECK(exact_quantity(value, "mm") == dash);
    CHECK(with_error(value, 1.0) == dash);
    CHECK(percent(value) == dash);
  }
  CHECK(interval(not_known, 2.0) == "[" + dash + ", 2.00]");
}

TEST_CASE("settings and counts have no trailing zeros") {
  CHECK(plain_words(exact(1200.0)) == "1200");
  CHECK(plain_words(exact(2e-4)) == "2×10⁻⁴");
  CHECK(plain_words(exact(0.54)) == "0.54");
  CHECK(plain_words(exact(-100.0)) == "−100");
  CHECK(plain_words(exact(1e6)) == "1×10⁶");
}

TEST_CASE("units follow a narrow space") {
  CHECK(quantity(0.25, "mm", 2) == Text("0.25\u202fmm"));
  CHECK(quantity(2.0, "m s^−2^") == "2.00\u202fm s" + Text("−2", superscript));
  CHECK(exact_quantity(0.25, "") == Text("0.25"));
}

TEST_CASE("errors, deviations, intervals") {
  CHECK(plain_words(with_error(1.23456, 0.0421)) == "1.235 ± 0.042");
  CHECK(plain_words(with_error(123.4, 5.6)) == "123.4 ± 5.6");
  CHECK(plain_words(with_error(-0.5, 0.12)) == "−0.50 ± 0.12");
  CHECK(plain_words(with_error(1.5, not_known)) == "1.50");
  CHECK(plain_words(with_error(1e8, 2e7)) == "1.00×10⁸ ± 2.0×10⁷");
  CHECK(plain_words(percent(0.0312)) == "+3.1 %");
  CHECK(plain_words(percent(-0.12)) == "−12 %");
  CHECK(plain_words(interval(-1.1, 1.4)) == "[−1.10, 1.40]");
}

TEST_CASE("verdicts") {
  CHECK(verdict(1e-3, 1e-3) == Text("✓ met", good));
  CHECK(verdict(1.1e-3, 1e-3) == Text("✗ missed", bad));
  CHECK(verdict(not_known, 1e-3).empty());
  CHECK(verdict(1.0, not_known).empty());
}

}  // namespace
}  // namespace ballast::page
