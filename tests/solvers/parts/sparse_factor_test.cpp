#include "solvers/parts/sparse_factor.hpp"

#include <atomic>
#include <thread>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// A band matrix with a few distant entries, diagonally dominant or not.
SparseColumns random_sparse(int n, double diagonal, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, diagonal);
  for (int k = 0; k < 4 * n; ++k) {
    const int i = static_cast<int>(random.uniform() * n),
              j = static_cast<int>(random.uniform() * n);
    if (i == j) continue;
    const double value = random.uniform() - 0.5;
    entries.emplace_back(i, j, value);
    entries.emplace_back(j, i, 0.5 * value);
  }
  SparseColumns a(n, n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

}  // namespace

TEST_CASE("an LU factor solves unsymmetric systems, and knows singular ones", "[factors]") {
  LuFactor factor;
  for (const int n : {1, 9, 200, 200}) {
    const SparseColumns a = random_sparse(n, 5.0, static_cast<std::uint64_t>(n) + 7);
    REQUIRE(factor.factor(a));
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
    Eigen::VectorXd x;
    factor.solve(b, x);
    CHECK((a * x - b).norm() < 1e-11 * b.norm());
  }
  CHECK_FALSE(factor.factor(Eigen::MatrixXd::Ones(2, 2).sparseView()));
}

TEST_CASE("orderings are the same when several threads order at once", "[factors]") {
  // A square grid.
  constexpr int side = 60;
  BlockGraph graph;
  for (int k = 0; k < side * side; ++k) {
    if (k >= side) graph.neighbour.push_back(k - side);
    if (k % side > 0) graph.neighbour.push_back(k - 1);
    if (k % side < side - 1) graph.neighbour.push_back(k + 1);
    if (k < side * (side - 1)) graph.neighbour.push_back(k + side);
    graph.begin.push_back(static_cast<int>(graph.neighbour.size()));
    graph.unknown_begin.push_back(k + 1);
  }
  const std::vector<int> alone = dissection_order(graph);
  std::atomic<int> others = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (int k = 0; k < 10; ++k) others += dissection_order(graph) != alone;
      });
  }
  CHECK(others == 0);
}
