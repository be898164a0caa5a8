#include "solvers/parts/lemke.hpp"

#include <cmath>

namespace ballast {
namespace {

/// Entries of the entering column below this are no pivots, and ratios closer than this are equal;
/// relative to the column, and for a problem whose diagonal is about one.
constexpr double no_pivot = 1e-11;
constexpr double tie = 1e-12;

}  // namespace

void Lemke::begin(const Eigen::MatrixXd& m, const Eigen::VectorXd& q) {
  n_ = static_cast<int>(q.size());
  m_ = &m;
  q_ = q;
  basis_.resize(n_);
  for (int i = 0; i < n_; ++i) basis_[i] = i;
  if (n_ == 0 || q.minCoeff() >= 0.0) {  // z = 0
    state_ = LemkeState::solved;
    return;
  }
  // I w - m z - 1 z_0 = q.
  tableau_.setZero(n_, 2 * n_ + 2);
  tableau_.leftCols(n_).setIdentity();
  tableau_.middleCols(n_, n_) = -m;
  tableau_.col(2 * n_).setConstant(-1.0);
  tableau_.col(2 * n_ + 1) = q;
  state_ = LemkeState::running;
  // The artificial variable enters where q is least; of equals the last, which is lexicographically
  // the least.
  int row = 0;
  for (int i = 1; i < n_; ++i)
    if (q[i] <= q[row]) row = i;
  const int left = basis_[row];
  exchange(row, 2 * n_);
  entering_ = complement(left);
}

/// Compares rows i and j of the basis' inverse, which stands in the columns of w, each over its
/// pivot. Rows of a regular matrix are never in proportion: exactly one row leaves.
bool Lemke::lexicographically_less(int i, int j, int entering) const {
  const double pivot_i = tableau_(i, entering), pivot_j = tableau_(j, entering);
  for (int column = 0; column < n_; ++column) {
    const double a = tableau_(i, column) / pivot_i, b = tableau_(j, column) / pivot_j;
    if (std::abs(a - b) > tie * (1.0 + std::abs(a) + std::abs(b))) return a < b;
  }
  return i < j;
}

int Lemke::leaving_row(int entering) const {
  // The entering variable grows until the first variable of the basis reaches zero: the least
  // ratio of right-hand side to column.
  const double floor = no_pivot * std::max(1.0, tableau_.col(entering).cwiseAbs().maxCoeff());
  const auto ratio = [&](int i) {
    return std::max(0.0, tableau_(i, 2 * n_ + 1)) / tableau_(i, entering);
  };
  int best = -1;
  for (int i = 0; i < n_; ++i) {
    if (!(tableau_(i, entering) > floor)) continue;
    if (best < 0) {
      best = i;
      continue;
    }
    const double difference = ratio(i) - ratio(best);
    const double equal = tie * (1.0 + ratio(best));
    if (difference > equal) continue;
    // Among equals the artificial variable leaves first: that is the solution.
    if (difference < -equal || basis_[i] == 2 * n_ ||
        (basis_[best] != 2 * n_ && lexicographically_less(i, best, entering)))
      best = i;
  }
  return best;
}

/// Gauss-Jordan: the entering variable's column becomes a unit vector.
void Lemke::exchange(int row, int entering) {
  tableau_.row(row) /= tableau_(row, entering);
  for (int i = 0; i < n_; ++i) {
    const double factor = tableau_(i, entering);
    if (i != row && factor != 0.0) tableau_.row(i) -= factor * tableau_.row(row);
  }
  basis_[row] = entering;
}

LemkeState Lemke::pivot() {
  if (state_ != LemkeState::running) return state_;
  const int row = leaving_row(entering_);
  // Nothing in the basis limits the entering variable: the path of solutions goes off along a ray.
  if (row < 0) return state_ = LemkeState::ray;
  const int left = basis_[row];
  exchange(row, entering_);
  if (left == 2 * n_) return state_ = LemkeState::solved;
  // z_i w_i = 0 is kept for every i, as what enters is always the partner of what has just left.
  entering_ = complement(left);
  return state_;
}

Eigen::VectorXd Lemke::solution() const {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(n_);
  std::vector<int> active;  // the z in the basis: their w are zero
  for (const int variable : basis_)
    if (variable >= n_ && variable < 2 * n_) active.push_back(variable - n_);
  if (active.empty()) return z;
  const Eigen::MatrixXd block = (*m_)(active, active);
  const Eigen::VectorXd right = -q_(active);
  const Eigen::VectorXd x = block.partialPivLu().solve(right);
  // A basis that only rounding keeps regular: then the tableau's own values.
  const bool close = x.allFinite() && (block * x - right).lpNorm<Eigen::Infinity>() <=
                                          1e-9 * (1.0 + right.lpNorm<Eigen::Infinity>());
  if (close)
    for (std::size_t k = 0; k < active.size(); ++k)
      z[active[k]] = std::max(0.0, x[static_cast<Eigen::Index>(k)]);
  else
    for (int i = 0; i < n_; ++i)
      if (basis_[i] >= n_ && basis_[i] < 2 * n_)
        z[basis_[i] - n_] = std::max(0.0, tableau_(i, 2 * n_ + 1));
  return z;
}

}  // namespace ballast
