#include "solvers/backends/pyramid_lemke.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "problems/algebra/contact_error.hpp"
#include "solvers/parts/lemke.hpp"
#include "solvers/seam/iteration.hpp"
#include "solvers/seam/rounds.hpp"

namespace ballast {
namespace {

// Unknowns of contact k, scaled by s = 1 / sqrt(lambda_max(W_kk)) so that the matrix has a diagonal
// of about one:
//   0 <= r_N      ⟂  u_N >= 0
//   0 <= beta_j   ⟂  lambda + d_j . u_T >= 0          r_T = sum_j beta_j d_j
//   0 <= lambda   ⟂  mu r_N - sum_j beta_j >= 0        lambda: the sliding speed
// With mu = 0 only the first.
class PyramidLemke final : public Solver {
 public:
  explicit PyramidLemke(const PyramidLemkeSettings& settings) : settings_(settings) {}

  void prepare(const FrictionProblem& problem) override {
    moving_.take(problem);
    begin_.assign(1, 0);
    for (int k = 0; k < moving_.contact_count(); ++k)
      begin_.push_back(begin_.back() + (has_friction(k) ? settings_.unknowns_per_contact() : 1));
    if (begin_.back() > settings_.largest)
      throw UnsupportedProblem(
          "pyramid_lemke: " + std::to_string(begin_.back()) + " unknowns, at most " +
          std::to_string(settings_.largest) + " (dense pivoting; " +
          std::to_string(settings_.unknowns_per_contact()) + " per contact with friction)");
    assemble();
  }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    // Errors are looked at where there is something to see: at the start, at the end, at a limit.
    Iteration iteration(budget, {std::numeric_limits<int>::max(), 1.0});
    ContactJudge judge;
    Eigen::VectorXd x;
    moving_.gather(problem, r, x);
    moving_.scatter(problem, x, r);
    iteration.evaluated(judge.judge(problem, r).natural_map_rms, r);

    // Pivot by pivot; only the last basis is an answer.
    lemke_.begin(m_, q_);
    LemkeState state = LemkeState::running;
    Eigen::VectorXd z;
    while (state == LemkeState::running && iteration.next()) {
      state = lemke_.pivot();
      if (state == LemkeState::solved) {
        z = lemke_.solution();
        moving_.scatter(problem, impulses(z), r);
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
      for (int j = 0; j < settings_.sides; ++j) {
        const double angle = 2.0 * M_PI * j / settings_.sides;
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
      m_.block(at + 1, last, settings_.sides, 1).setOnes();
      m_.block(last, at + 1, 1, settings_.sides).setConstant(-1.0);
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

  PyramidLemkeSettings settings_;
  MovingContacts moving_;
  std::vector<int> begin_;  ///< unknowns of each contact
  Eigen::MatrixXd m_;
  Eigen::VectorXd q_;
  Lemke lemke_;
};

}  // namespace

std::unique_ptr<Solver> make_pyramid_lemke(const PyramidLemkeSettings& settings) {
  return std::make_unique<PyramidLemke>(settings);
}

}  // namespace ballast
