#include "solvers/parts/dense_kernels.hpp"

#include <array>

#include <Eigen/Dense>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

Eigen::MatrixXd random_matrix(int rows, int columns, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd a(rows, columns);
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) a(i, j) = random.uniform() - 0.5;
  return a;
}

/// The slow twin: every entry is a sum over k in order, subtracted in pieces of 256.
void subtract_plainly(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& c) {
  for (int from = 0; from < a.cols(); from += 256)
    for (int j = 0; j < c.cols(); ++j)
      for (int i = 0; i < c.rows(); ++i) {
        double sum = 0.0;
        for (int k = from; k < std::min<int>(from + 256, a.cols()); ++k) sum += a(i, k) * b(k, j);
        c(i, j) -= sum;
      }
}

}  // namespace

TEST_CASE("products have the bits of plain loops, on every instruction set and any size") {
  for (const auto& [m, n, k] : {std::array<int, 3>{1, 1, 1},
                                {8, 6, 3},
                                {7, 5, 24},
                                {33, 20, 300},
                                {64, 13, 257},
                                {3, 100, 0},
                                {0, 4, 4},
                                {25, 0, 2}})
    for (const DenseKernels& kernels : dense_kernels()) {
      CAPTURE(m, n, k, kernels.instruction_set);
      // The matrices are blocks of larger ones, whose other entries must not change.
      const Eigen::MatrixXd a = random_matrix(m, k, 1), b = random_matrix(k, n, 2);
      Eigen::MatrixXd frame_a = random_matrix(m + 3, k, 5), frame_b = random_matrix(k + 2, n, 6),
                      frame = random_matrix(m + 5, n + 1, 3);
      frame_a.topRows(m) = a;
      frame_b.topRows(k) = b;
      Eigen::MatrixXd expected = frame, c = frame.topLeftCorner(m, n);
      subtract_plainly(a, b, c);
      expected.topLeftCorner(m, n) = c;
      kernels.product(m, n, k, frame_a.data(), m + 3, frame_b.data(), k + 2, frame.data(), m + 5);
      CHECK(frame == expected);
    }
}

TEST_CASE("a tile is solved to the same bits on every instruction set") {
  for (const int rows : {1, 3, 8})
    for (const int n : {1, 6, 20}) {
      const Eigen::MatrixXd l = random_matrix(rows, rows, 7), b = random_matrix(rows, n, 8);
      Eigen::MatrixXd expected = b;
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < rows; ++k)
          for (int i = k + 1; i < rows; ++i) expected(i, j) -= l(i, k) * expected(k, j);
      for (const DenseKernels& kernels : dense_kernels()) {
        CAPTURE(rows, n, kernels.instruction_set);
        Eigen::MatrixXd x = b;
        kernels.solve(rows, n, l.data(), rows, x.data(), rows);
        CHECK(x == expected);
      }
    }
}

TEST_CASE("triangles are solved and columns factored like Eigen does") {
  for (const int rows : {1, 7, 8, 9, 50, 131}) {
    CAPTURE(rows);
    const Eigen::MatrixXd l = random_matrix(rows, rows, 11) / rows;
    Eigen::MatrixXd x = random_matrix(rows, 17, 12);
    const Eigen::MatrixXd expected = l.triangularView<Eigen::UnitLower>().solve(x);
    solve_unit_lower(rows, 17, l.data(), rows, x.data(), rows);
    CHECK((x - expected).norm() < 1e-14 * expected.norm());
    // A tall block with a large diagonal: A = L U on its columns.
    const int columns = (rows + 1) / 2;
    Eigen::MatrixXd a = random_matrix(rows, columns, 13);
    a.diagonal().array() += columns;
    Eigen::MatrixXd factors = a;
    factor_columns(factors.data(), rows, rows, columns);
    Eigen::MatrixXd lower = factors;
    lower.triangularView<Eigen::Upper>().setZero();
    lower.diagonal().setOnes();
    const Eigen::MatrixXd upper =
        factors.topRows(columns).triangularView<Eigen::Upper>().toDenseMatrix();
    CHECK((lower * upper - a).norm() < 1e-14 * a.norm());
  }
}
