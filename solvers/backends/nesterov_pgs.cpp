#include "solvers/backends/nesterov_pgs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/gauss_seidel/sweep_search.hpp"

namespace ballast {
namespace {

// With r^_k the iterate that sweep k left, and d_k what it changed:
//   r := r^_k + beta (r^_k - r^_k-1),  beta = j / (j + 2) in the j-th sweep of a search
//   r^_k+1 := sweep(r)
// Where a solve converges by a factor q a sweep, the best beta is about q^2: so beta is never more
// than the mean factor of |d|^2 over the last sweeps. The law is not a minimisation, and momentum
// may circle: a search in which |d|^2 grows ends, and after some searches that came to nothing
// plain sweeps follow for a while.
class Momentum {
 public:
  void forget() { swept_ = 0; }

  /// `square`: |d|^2 of the last sweep; of none before the first.
  SearchStep next(double square) {
    ++total_;
    if (++swept_ == 1) return {};
    if (swept_ == 2 || resting_ > 0) {
      resting_ = std::max(0, resting_ - 1);
      begin_search(square);
      return {};
    }
    squares_[++age_ % window] = square;
    least_ = std::min(least_, square);
    if (square > rise * least_) {
      vain_ = age_ < short_search ? vain_ + 1 : 0;
      if (vain_ == most_vain) {
        vain_ = 0;
        resting_ = rest;
      }
      begin_search(square);
      return {};
    }
    const double beta = std::min(age_ / (age_ + 2.0), mean_factor(square));
    return {.beta = beta, .gain = 0.0, .ahead = beta};
  }

  /// Where a quarter more sweeps gained less than a tenth, momentum goes round without end: plain
  /// sweeps follow, the more the more often that was so.
  void see(double error) {
    best_ = std::min(best_, error);
    if (resting_ > 0 || total_ < std::max(first_mark, 5 * mark_ / 4)) return;
    if (best_ > 0.9 * best_at_mark_) resting_ = ++losses_ * total_ / 4;
    mark_ = total_;
    best_at_mark_ = best_;
  }
  /// A search ends by what its sweeps change, in next().
  static constexpr bool begins_anew() { return false; }

 private:
  void begin_search(double square) {
    age_ = 0;
    squares_[0] = least_ = square;
  }
  /// Over the last 1, 2, 4 or 8 sweeps: their roots are square roots, which are the same on every
  /// machine.
  double mean_factor(double square) const {
    int sweeps = 1;
    while (2 * sweeps <= std::min(age_, window - 1)) sweeps *= 2;
    double factor = square / squares_[(age_ - sweeps) % window];
    for (int root = sweeps; root > 1; root /= 2) factor = std::sqrt(factor);
    return factor;
  }

  static constexpr double rise = 1.3;     ///< of |d|^2, over the least one of its search
  static constexpr int window = 9;        ///< squares for a mean factor
  static constexpr int short_search = 6;  ///< sweeps
  static constexpr int most_vain = 3;     ///< short searches one after the other
  static constexpr int rest = 32;         ///< plain sweeps after them
  static constexpr int first_mark = 256;  ///< sweeps before momentum is judged by the error

  int swept_ = 0;                          ///< sweeps from the current start
  int age_ = 0;                            ///< sweeps since the search began
  double squares_[window]{};               ///< |d|^2, by age
  double least_ = 0.0;                     ///< of the search
  int total_ = 0, mark_ = 0, losses_ = 0;  ///< sweeps; at the last judgement; those it lost
  double best_ = std::numeric_limits<double>::max(), best_at_mark_ = best_;  ///< errors [m/s]
  int vain_ = 0, resting_ = 0;  ///< short searches until now, plain sweeps still to come
};

}  // namespace

std::unique_ptr<Solver> make_nesterov_pgs(const NesterovSettings& settings) {
  return std::make_unique<SweepSearch<Momentum>>(settings.returns_best);
}

}  // namespace ballast
