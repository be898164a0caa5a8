#include "solvers/backends/pyramid_lemke.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "problems/algebra/contact_error.hpp"
#include "solvers/backends/backends.hpp"
#include "solvers/parts/dense_kernels.hpp"
#include "solvers/seam/iteration.hpp"
#include "solvers/seam/rounds.hpp"

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
  const Eigen::VectorXd x = pivoted_solution(block, right);
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

namespace {

// Unknowns of contact k, scaled by s = 1 / sqrt(lambda_max(W_kk)) so that the matrix has a diagonal
// of about one:
//   0 <= r_N      ⟂  u_N >= 0
//   0 <= beta_j   ⟂  lambda + d_j . u_T >= 0          r_T = sum_j beta_j d_j
//   0 <= lambda   ⟂  mu r_N - sum_j beta_j >= 0        lambda: the sliding speed
// With mu = 0 only the first.
class PyramidLemke final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    moving_.take(problem);
    begin_.assign(1, 0);
    for (int k = 0; k < moving_.contact_count(); ++k)
      begin_.push_back(begin_.back() + (has_friction(k) ? unknowns_per_contact : 1));
    if (begin_.back() > most_unknowns)
      throw UnsupportedProblem("pyramid_lemke: " + std::to_string(begin_.back()) +
                               " unknowns, at most " + std::to_string(most_unknowns) +
                               " (dense pivoting; " + std::to_string(unknowns_per_contact) +
                               " per contact with friction)");
    assemble();
  }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    // Errors are looked at where there is something to see: at the start, at the end, at a limit.
    Iteration iteration(budget, {std::numeric_limits<int>::max(), 1.0});
    ContactJudge judge;
    Eigen::VectorXd x;
    moving_.gather(r, x);
    moving_.scatter(x, r);
    iteration.evaluated(judge.judge(problem, r).natural_map_rms, r);

    // Pivot by pivot; only the last basis is an answer.
    lemke_.begin(m_, q_);
    LemkeState state = LemkeState::running;
    Eigen::VectorXd z;
    while (state == LemkeState::running && iteration.next()) {
      state = lemke_.pivot();
      if (state == LemkeState::solved) {
        z = lemke_.solution();
        moving_.scatter(impulses(z), r);
      }
      if (iteration.error_due() || state != LemkeState::running)
        iteration.evaluated(judge.judge(problem, r).natural_map_rms, r);
    }
    Solved solved = iteration.finish(std::move(r));
    if (z.size() > 0) solved.own_residual = residual(z);
    // Ended by itself: there is nothing more that this method could do, for its own law or for
    // Coulomb's.
    if (state != LemkeState::running && solved.reason == StopReason::numerical_failure &&
        solved.impulses.allFinite())
      solved.reason = StopReason::stalled;
    return solved;
  }

 private:
  bool has_friction(int k) const { return moving_.rows(k) == 3 && moving_.friction[k] > 0.0; }

  /// r = E z of one contact, scaled; columns past r_N and beta are zero.
  Eigen::MatrixXd spread(int k) const {
    const int unknowns = begin_[k + 1] - begin_[k];
    Eigen::MatrixXd e = Eigen::MatrixXd::Zero(moving_.rows(k), unknowns);
    e(0, 0) = 1.0;
    if (unknowns > 1)
      for (int j = 0; j < sides; ++j) {
        const double angle = 2.0 * M_PI * j / sides;
        e(1, 1 + j) = std::cos(angle);
        e(2, 1 + j) = std::sin(angle);
      }
    return e / std::sqrt(moving_.lambda_max[k]);
  }

  /// m = E^T W E by pairs of contacts, and the rows that tie beta to lambda and mu r_N.
  void assemble() {
    const int n = begin_.back(), contacts = moving_.contact_count();
    const Eigen::MatrixXd w = moving_.w;
    std::vector<Eigen::MatrixXd> e;
    for (int k = 0; k < contacts; ++k) e.push_back(spread(k));
    m_.setZero(n, n);
    q_.setZero(n);
    // The diagonal block of a contact with friction, with D = (d_1 ..
    // d_sides) the pyramid's directions:
    //
    //     [ W_NN      W_NT D       0 ]   r_N          u_N
    //     [ D^T W_TN  D^T W_TT D   1 ]   beta    =>   lambda + d_j . u_T
    //     [ mu        -1 .. -1     0 ]   lambda       mu r_N - sum beta_j
    for (int k = 0; k < contacts; ++k) {
      const int at = begin_[k], size = begin_[k + 1] - at;
      // E^T q in the rows of r_N and beta; lambda's row has none.
      q_.segment(at, size) =
          e[k].transpose() * moving_.q.segment(moving_.row_begin[k], moving_.rows(k));
      for (int l = 0; l < contacts; ++l)
        m_.block(at, begin_[l], size, begin_[l + 1] - begin_[l]) =
            e[k].transpose() *
            w.block(moving_.row_begin[k], moving_.row_begin[l], moving_.rows(k), moving_.rows(l)) *
            e[l];
      if (size == 1) continue;
      const int last = at + size - 1;
      m_.block(at + 1, last, sides, 1).setOnes();
      m_.block(last, at + 1, 1, sides).setConstant(-1.0);
      m_(last, at) = moving_.friction[k];
    }
  }

  /// r = E z, in the rows that move.
  Eigen::VectorXd impulses(const Eigen::VectorXd& z) const {
    Eigen::VectorXd x(moving_.row_count());
    for (int k = 0; k < moving_.contact_count(); ++k)
      x.segment(moving_.row_begin[k], moving_.rows(k)) =
          spread(k) * z.segment(begin_[k], begin_[k + 1] - begin_[k]);
    return x;
  }

  /// max |min(z, m z + q)|, as a velocity [m/s].
  double residual(const Eigen::VectorXd& z) const {
    const Eigen::VectorXd least = z.cwiseMin(m_ * z + q_);
    double largest = 0.0;
    for (int k = 0; k < moving_.contact_count(); ++k)
      largest = std::max(
          largest,
          std::sqrt(moving_.lambda_max[k]) *
              least.segment(begin_[k], begin_[k + 1] - begin_[k]).lpNorm<Eigen::Infinity>());
    return largest;
  }

  /// Directions of friction per contact; their hull is inside the circle.
  static constexpr int sides = 8;
  static constexpr int unknowns_per_contact = sides + 2;  ///< with friction; 1 without
  static constexpr int most_unknowns = unknowns_per_contact * pyramid_lemke_limit;

  MovingContacts moving_;
  std::vector<int> begin_;  ///< unknowns of each contact
  Eigen::MatrixXd m_;
  Eigen::VectorXd q_;
  Lemke lemke_;
};

}  // namespace

std::unique_ptr<Solver> make_pyramid_lemke() { return std::make_unique<PyramidLemke>(); }

}  // namespace ballast
