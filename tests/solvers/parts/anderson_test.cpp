#include "solvers/parts/anderson.hpp"

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("a linear fixed point of n unknowns is found in n + 1 combinations") {
  constexpr int n = 5;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    a(i, i) = 0.5 + 0.1 * i;  // plain iterations contract by 0.9
    if (i > 0) a(i, i - 1) = 0.3;
  }
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
  const Eigen::VectorXd exact = (Eigen::MatrixXd::Identity(n, n) - a).partialPivLu().solve(b);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  Anderson mixing;
  mixing.reset(n);
  for (int k = 0; k < n + 2; ++k) mixing.step(x, a * x + b);
  CHECK((x - exact).norm() < 1e-4 * exact.norm());
  mixing.forget();
  const Eigen::VectorXd image = a * x + b;
  mixing.step(x, image);
  CHECK(x == image);  // nothing remembered: the plain step
}

TEST_CASE("entries that are not compared are combined all the same") {
  // x1 halves its distance to 2; the second entry is a linear function of the first, which mixing
  // must preserve.
  Eigen::VectorXd x(2), image(2);
  x << 0.0, 1.0;
  Anderson mixing;
  mixing.reset(3);
  for (int k = 0; k < 4; ++k) {
    image[0] = 0.5 * x[0] + 1.0;
    image[1] = 3.0 * image[0] + 1.0;
    mixing.step(x, image, 1);
    CHECK(x[1] == Approx(3.0 * x[0] + 1.0));
  }
  CHECK(x[0] == Approx(2.0));
}
