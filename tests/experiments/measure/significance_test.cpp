// Tests of significance against published tables and worked examples.

#include "experiments/measure/significance.hpp"

#include <cmath>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("Student's t has the p of the tables") {
  // two-sided, Abramowitz and Stegun table 26.10
  CHECK(student_p(12.706, 1) == Approx(0.05).epsilon(1e-3));
  CHECK(student_p(63.657, 1) == Approx(0.01).epsilon(1e-3));
  CHECK(student_p(4.303, 2) == Approx(0.05).epsilon(1e-3));
  CHECK(student_p(-2.228, 10) == Approx(0.05).epsilon(1e-3));
  CHECK(student_p(2.845, 20) == Approx(0.01).epsilon(1e-3));
  CHECK(student_p(0.0, 5) == Approx(1.0));
  // with one degree of freedom t is Cauchy's, with two there is a closed form
  CHECK(student_p(1.0, 1) == Approx(0.5));
  CHECK(student_p(3.0, 2) == Approx(1.0 - 3.0 / std::sqrt(11.0)));
  CHECK(std::isnan(student_p(1.0, 0)));
}

TEST_CASE("the quantile of Student's t is that of the tables") {
  CHECK(student_t95(1) == Approx(12.706).epsilon(1e-4));
  CHECK(student_t95(2) == Approx(4.303).epsilon(1e-4));
  CHECK(student_t95(30) == Approx(2.042).epsilon(3e-4));
  CHECK(student_t95(120) == Approx(1.980).epsilon(3e-4));
  CHECK(student_t95(100000) == Approx(1.960).epsilon(1e-4));
  CHECK(std::isinf(student_t95(0)));
}

TEST_CASE("F and chi squared have the p of the tables") {
  CHECK(f_p(4.26, 2, 9) == Approx(0.05).epsilon(3e-3));
  CHECK(f_p(10.04, 1, 10) == Approx(0.01).epsilon(3e-3));
  CHECK(f_p(2.98, 10, 10) == Approx(0.05).epsilon(3e-3));
  CHECK(f_p(0.0, 3, 5) == Approx(1.0));
  // chi^2 of 18.307 at 10 degrees of freedom, of 3.841 at 1
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  CHECK(f_p(18.307 / 10.0, 10, unbounded) == Approx(0.05).epsilon(1e-3));
  CHECK(f_p(3.841, 1, unbounded) == Approx(0.05).epsilon(1e-3));
  CHECK(f_p(37.566 / 20.0, 20, unbounded) == Approx(0.01).epsilon(1e-3));
  // t squared is F with one degree of freedom above
  CHECK(f_p(2.5 * 2.5, 1, 7) == Approx(student_p(2.5, 7)));
}

TEST_CASE("Holm's correction of a worked example, in the order given") {
  const std::vector<double> p{0.04, 0.01, not_known, 0.03, 0.005};
  const std::vector<double> corrected = holm(p);
  CHECK(corrected[4] == Approx(0.02));  // 4 x 0.005
  CHECK(corrected[1] == Approx(0.03));  // 3 x 0.01
  CHECK(corrected[3] == Approx(0.06));  // 2 x 0.03
  CHECK(corrected[0] == Approx(0.06));  // 0.04, but not below the one before
  CHECK(std::isnan(corrected[2]));
  CHECK(holm(std::vector<double>{0.6, 0.7})[0] == 1.0);
}

TEST_CASE("a pooled error takes each group about its own mean") {
  const std::vector<std::vector<double>> groups{
      {1.0, 3.0}, {10.0, 11.0, 12.0}, {5.0}, {not_known, 7.0}};
  const PooledError pooled = pooled_error(groups);
  CHECK(pooled.degrees_of_freedom == 3);
  CHECK(pooled.deviation == Approx(std::sqrt((2.0 + 2.0) / 3.0)));
  CHECK(std::isnan(pooled_error(std::vector<std::vector<double>>{{1.0}}).deviation));
}

TEST_CASE("Student's own pairs: the extra hours of sleep of ten patients") {
  // Student (1908), drugs 1 and 2: t = 4.062, p = 0.002833
  const std::vector<double> a{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0},
      b{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
  const Difference paired = paired_difference(a, b);
  CHECK(paired.mean == Approx(1.58));
  CHECK(paired.mean / paired.error == Approx(4.0621).epsilon(1e-4));
  CHECK(paired.p() == Approx(0.002833).epsilon(1e-3));
  CHECK(paired.half_width() == Approx(2.262 * paired.error).epsilon(1e-3));
  CHECK(std::isnan(paired_difference(a, {}).p()));
}

TEST_CASE("where nothing differs, p is below 0.05 once in twenty times") {
  Random random(11);
  int below = 0;
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<std::vector<double>> groups(2);
    for (std::vector<double>& group : groups)
      for (int k = 0; k < 3; ++k) {
        double gauss = -6.0;  // twelve uniform numbers: normal enough for this
        for (int n = 0; n < 12; ++n) gauss += random.uniform(0.0, 1.0);
        group.push_back(gauss);
      }
    if (paired_difference(groups[0], groups[1]).p() < 0.05) ++below;
  }
  CHECK(below > 0.035 * trials);
  CHECK(below < 0.065 * trials);
}
