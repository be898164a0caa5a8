#include "solvers/parts/front_lu.hpp"

#include <limits>

#include "platform/random.hpp"
#include "solvers/parts/sparse_factor.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

struct Blocks {
  SparseColumns a;
  std::vector<int> begin{0};
};

/// I + H^T K H of `bodies` bodies of 1 to 6 unknowns, joined in random unknowns by `contacts`
/// random contacts of three rows. K is `stiffness` times the identity, or with `slips` like that of
/// a sliding contact: singular and unsymmetric.
Blocks newton_matrix(int bodies, int contacts, double stiffness, bool slips, std::uint64_t seed) {
  Random random(seed);
  Blocks blocks;
  for (int b = 0; b < bodies; ++b)
    blocks.begin.push_back(blocks.begin.back() + 1 + static_cast<int>(random.uniform() * 6));
  const int n = blocks.begin.back();
  std::vector<Eigen::Triplet<double>> h;
  for (int c = 0; c < contacts; ++c)
    for (int side = 0; side < 2; ++side) {
      const int b = static_cast<int>(random.uniform() * bodies);
      for (int i = 0; i < 3; ++i)
        for (int j = blocks.begin[b]; j < blocks.begin[b + 1]; ++j)
          h.emplace_back(3 * c + i, j, random.uniform() - 0.5);
    }
  std::vector<Eigen::Triplet<double>> k;
  for (int c = 0; c < contacts; ++c) {
    const bool sliding = slips && c % 2;
    for (int i = 0; i < 3; ++i)
      if (!sliding || i == 0) k.emplace_back(3 * c + i, 3 * c + i, stiffness);
    if (sliding) k.emplace_back(3 * c + 1, 3 * c, 0.4 * stiffness);
  }
  SparseColumns hm(3 * contacts, n), km(3 * contacts, 3 * contacts), identity(n, n);
  hm.setFromTriplets(h.begin(), h.end());
  km.setFromTriplets(k.begin(), k.end());
  identity.setIdentity();
  blocks.a = identity + SparseColumns(hm.transpose() * km * hm);
  blocks.a.makeCompressed();
  return blocks;
}

double relative_residual(const SparseColumns& a, const Eigen::VectorXd& x,
                         const Eigen::VectorXd& b) {
  return (a * x - b).norm() / (a.norm() * x.norm() + b.norm());
}

/// Checks that branches and trunk together hold every front once, that no branch is large, and that
/// branches depend on each other only through the trunk.
void check_shared_out(const FrontTree& tree) {
  std::vector<int> branch_of(tree.fronts.size(), -1);
  const auto work_of = [&](int first, int end) {
    double work = 0.0;
    for (int f = first; f < end; ++f) work += tree.fronts[f].own * std::pow(tree.fronts[f].rows, 2);
    return work;
  };
  const int fronts = static_cast<int>(tree.fronts.size());
  REQUIRE(tree.branches.size() > 1);
  REQUIRE(tree.trunk.size() > 0);
  std::size_t held = tree.trunk.size();
  for (std::size_t k = 0; k < tree.branches.size(); ++k) {
    const auto& [first, end] = tree.branches[k];
    held += end - first;
    std::fill(branch_of.begin() + first, branch_of.begin() + end, static_cast<int>(k));
    CHECK(work_of(first, end) <= work_of(0, fronts) / 3.0);
  }
  CHECK(held == tree.fronts.size());
  CHECK(std::is_sorted(tree.trunk.begin(), tree.trunk.end()));
  for (const int f : tree.trunk) CHECK(branch_of[f] == -1);
  for (int f = 0; f < fronts; ++f) {
    const int parent = tree.fronts[f].parent;
    if (branch_of[f] >= 0 && parent >= 0)
      CHECK((branch_of[parent] == branch_of[f] || branch_of[parent] < 0));
  }
}

Eigen::VectorXd right_side(int n) { return Eigen::VectorXd::LinSpaced(n, -1.0, 2.0); }

}  // namespace

TEST_CASE("a dissection eliminates every node once, whatever the graph", "[factors]") {
  for (const int contacts : {0, 5, 400}) {
    const Blocks blocks = newton_matrix(100, contacts, 1.0, false, 5);
    const BlockGraph graph =
        block_graph(blocks.begin, blocks.a.outerIndexPtr(), blocks.a.innerIndexPtr());
    std::vector<int> order = dissection_order(graph);
    CHECK(order == dissection_order(graph));
    std::sort(order.begin(), order.end());
    for (int k = 0; k < 100; ++k) CHECK(order[k] == k);
  }
}

TEST_CASE("fronts solve like dense elimination and like UMFPACK, symmetric or not", "[factors]") {
  FrontLu fronts;
  for (const int bodies : {1, 2, 7, 60, 150})
    for (const bool slips : {false, true})
      for (const double stiffness : {0.0, 1.0, 1e6}) {
        CAPTURE(bodies, slips, stiffness);
        const Blocks blocks = newton_matrix(bodies, 3 * bodies, stiffness, slips, 11);
        const int n = blocks.begin.back();
        const Eigen::VectorXd b = right_side(n);
        fronts.analyse(blocks.a, blocks.begin);
        REQUIRE(fronts.factor(blocks.a));
        Eigen::VectorXd x, general;
        fronts.solve(b, x);
        CHECK(relative_residual(blocks.a, x, b) < 1e-14);
        const Eigen::VectorXd dense = oracle::dense_solution(blocks.a, b);
        CHECK((x - dense).norm() < 1e-14 * std::max(1.0, stiffness) * 1e3 * dense.norm());
        LuFactor umfpack;
        REQUIRE(umfpack.factor(blocks.a));
        umfpack.solve(b, general);
        CHECK((x - general).norm() < 1e-14 * std::max(1.0, stiffness) * 1e3 * general.norm());
      }
}

TEST_CASE("one analysis serves new numbers, and a new pattern gets its own", "[factors]") {
  FrontLu fronts;
  for (const std::uint64_t seed : {1u, 1u, 2u, 3u}) {
    const Blocks blocks = newton_matrix(50, 100, 10.0, true, seed);
    const Eigen::VectorXd b = right_side(blocks.begin.back());
    fronts.analyse(blocks.a, blocks.begin);
    Eigen::VectorXd x;
    for (const double scale : {1.0, -3.0}) {
      const SparseColumns scaled = scale * blocks.a;
      REQUIRE(fronts.factor(scaled));
      fronts.solve(b, x);
      CHECK(relative_residual(scaled, x, b) < 1e-14);
    }
  }
}

TEST_CASE("the same matrix gives the same bits, whatever was factored before", "[factors]") {
  const Blocks blocks = newton_matrix(80, 200, 1e3, true, 4),
               other = newton_matrix(90, 100, 1.0, false, 8);
  const Eigen::VectorXd b = right_side(blocks.begin.back());
  Eigen::VectorXd x, y;
  FrontLu fresh, used;
  used.analyse(other.a, other.begin);
  REQUIRE(used.factor(other.a));
  for (FrontLu* fronts : {&fresh, &used}) {
    fronts->analyse(blocks.a, blocks.begin);
    REQUIRE(fronts->factor(blocks.a));
    fronts->solve(b, fronts == &fresh ? x : y);
  }
  CHECK(x == y);
}

TEST_CASE("any number of threads factors to the same bits", "[factors]") {
  // Large enough for branches and a trunk.
  const Blocks blocks = newton_matrix(500, 900, 1e3, true, 21);
  const Eigen::VectorXd b = right_side(blocks.begin.back());
  Eigen::VectorXd alone;
  for (const int threads : {1, 2, 3}) {
    WorkerTeam team;
    team.resize(threads);
    FrontLu fronts;
    fronts.use_team(&team);
    fronts.analyse(blocks.a, blocks.begin);
    check_shared_out(fronts.tree());
    for (int repeat = 0; repeat < 10; ++repeat) {
      REQUIRE(fronts.factor(blocks.a));
      Eigen::VectorXd x;
      fronts.solve(b, x);
      if (alone.size() == 0) alone = x;
      REQUIRE(x == alone);
    }
  }
  CHECK(relative_residual(blocks.a, alone, b) < 1e-14);
}

TEST_CASE("a breakdown is reported, and the next matrix is factored", "[factors]") {
  const Blocks good = newton_matrix(30, 60, 1.0, false, 6);
  FrontLu fronts;
  fronts.analyse(good.a, good.begin);
  // The rank is lower by one, exactly and up to rounding: the last unknown's row and column are a
  // mean of those of two others.
  const int n = static_cast<int>(good.a.rows());
  for (const double part : {1.0, 0.7}) {
    Eigen::MatrixXd dense = Eigen::MatrixXd(good.a);
    dense.row(n - 1) = part * dense.row(0) + (1.0 - part) * dense.row(1);
    dense.col(n - 1) = part * dense.col(0) + (1.0 - part) * dense.col(1);
    SparseColumns singular = dense.sparseView(1.0, 0.0);
    singular.makeCompressed();
    fronts.analyse(singular, good.begin);
    CHECK_FALSE(fronts.factor(singular));
  }
  SparseColumns damaged = good.a;
  fronts.analyse(good.a, good.begin);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    damaged.valuePtr()[7] = bad;
    CHECK_FALSE(fronts.factor(damaged));
  }
  REQUIRE(fronts.factor(good.a));
  const Eigen::VectorXd b = right_side(n);
  Eigen::VectorXd x;
  fronts.solve(b, x);
  CHECK(relative_residual(good.a, x, b) < 1e-14);
}
