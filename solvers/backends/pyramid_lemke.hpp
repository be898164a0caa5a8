#pragma once
// Lemke's complementary pivoting, by which the pyramid's law is solved.

#include <vector>

#include <Eigen/Dense>

namespace ballast {

enum class LemkeState { running, solved, ray };

/// Complementary pivoting, dense, with the lexicographic ratio test: Cottle, Pang, Stone 1992, "The
/// linear complementarity problem", 4.4. Find z >= 0 with w = m z + q >= 0 and z . w = 0, one pivot
/// at a time. The lexicographic rule meets no basis twice, so that it ends for every m; it ends
/// with a solution when m is copositive-plus and some z >= 0 has m z + q >= 0. Memory 16 n^2 bytes,
/// a pivot costs about 4 n^2 operations.
class Lemke {
 public:
  /// Covering vector of ones. `m` is kept by reference until solution().
  void begin(const Eigen::MatrixXd& m, const Eigen::VectorXd& q);
  /// One pivot. `ray`: no solution was found this way.
  LemkeState pivot();
  LemkeState state() const { return state_; }
  /// Of a solved problem: computed afresh from the final basis, without the rounding of the pivots;
  /// negative rounding becomes zero.
  Eigen::VectorXd solution() const;

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  int leaving_row(int entering) const;
  bool lexicographically_less(int i, int j, int entering) const;
  void exchange(int row, int entering);
  int complement(int variable) const { return variable < n_ ? variable + n_ : variable - n_; }

  // Variables: w_0..w_n-1, z_0..z_n-1, the artificial one. Columns of the tableau in that order,
  // then q.
  int n_ = 0, entering_ = 0;
  LemkeState state_ = LemkeState::solved;
  Rows tableau_;
  std::vector<int> basis_;  ///< variable of each row
  const Eigen::MatrixXd* m_ = nullptr;
  Eigen::VectorXd q_;
};

}  // namespace ballast
