#include "platform/random.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("splitmix64 gives the published numbers") {
  SplitMix64 random(1234567);
  for (const std::uint64_t expected :
       {6457827717110365317u, 3203168211198807973u, 9817491932198370423u, 4593380528125082431u,
        16408922859458223821u})
    CHECK(random.next() == expected);
}

TEST_CASE("xoshiro256++ seeded by splitmix64 gives the numbers that other libraries give") {
  Random random(0);  // as Xoshiro256PlusPlus::seed_from_u64(0) of rand_xoshiro
  for (const std::uint64_t expected :
       {5987356902031041503u, 7051070477665621255u, 6633766593972829180u, 211316841551650330u,
        9136120204379184874u, 379361710973160858u})
    CHECK(random.next() == expected);
}

TEST_CASE("uniform and normal numbers have the moments they should have") {
  Random random(5);
  const int n = 200000;
  double mean = 0.0, square = 0.0, normal_mean = 0.0, normal_sq = 0.0;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform();
    REQUIRE((u >= 0.0 && u < 1.0));
    mean += u / n;
    square += u * u / n;
    const double x = random.normal();
    REQUIRE(std::abs(x) <= 6.0);
    normal_mean += x / n;
    normal_sq += x * x / n;
  }
  // Five standard errors of each mean.
  const double error = 5.0 / std::sqrt(static_cast<double>(n));
  CHECK(std::abs(mean - 0.5) < error * 0.29);
  CHECK(std::abs(square - 1.0 / 3.0) < error * 0.3);
  CHECK(std::abs(normal_mean) < error);
  CHECK(std::abs(normal_sq - 1.0) < error * 1.42);
}

TEST_CASE("a range is kept, and a logarithm is uniform") {
  Random random(8);
  const int n = 20000;
  int below_middle = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform(-3.0, 5.0);
    REQUIRE((x >= -3.0 && x < 5.0));
    const double y = random.log_uniform(1e-6, 1e6);
    REQUIRE((y > 0.99e-6 && y < 1.01e6));
    below_middle += y < 1.0;
  }
  CHECK(std::abs(below_middle - 0.5 * n) < 5.0 * 0.5 * std::sqrt(static_cast<double>(n)));
}

TEMPLATE_TEST_CASE("each index below n comes as often as the others", "", Random, SplitMix64) {
  TestType random(7);
  constexpr int n = 7, draws = 70000;
  std::vector<int> count(n, 0);
  for (int i = 0; i < draws; ++i) {
    const int k = random.below(n);
    REQUIRE((k >= 0 && k < n));
    ++count[k];
  }
  for (const int c : count) CHECK(std::abs(c - draws / n) < 5.0 * std::sqrt(1.0 * draws / n));
}
