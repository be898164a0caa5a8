#include "solvers/backends/nncg.hpp"

#include <limits>

#include "solvers/gauss_seidel/sweep_search.hpp"

namespace ballast {
namespace {

// One iteration, with r^ the iterate that the last sweep left and r the one it began from:
//   d = r^ - r (minus the gradient),  beta = |d|^2 / |d before|^2
//   beta > 1: the search restarts, p = 0, r := r^
//   else      r := r^ + beta p,  p := beta p + d
//   r^ := sweep(r)
// The law is not a minimisation, and now and then the search circles: when the error has grown from
// one look to the next, plain sweeps follow until the one after.
class FletcherReeves {
 public:
  void forget() { begins_ = true; }

  /// The first sweep of a search is plain.
  SearchStep next(double square) {
    if (begins_) last_ = 0.0;
    const bool is_first = begins_ || !accelerates_;
    begins_ = false;
    if (is_first) return {};
    double beta = last_ > 0.0 ? square / last_ : 0.0;
    if (beta > 1.0) beta = 0.0;
    last_ = square;
    return {.beta = beta, .gain = 1.0};
  }

  void see(double error) {
    accelerates_ = !accelerates_ || error < last_error_;
    last_error_ = error;
  }
  bool begins_anew() const { return !accelerates_; }

 private:
  bool begins_ = true, accelerates_ = true;
  double last_ = 0.0;  ///< |d|^2 of the sweep before the last
  double last_error_ = std::numeric_limits<double>::max();
};

}  // namespace

std::unique_ptr<Solver> make_nncg() {
  return std::make_unique<SweepSearch<FletcherReeves>>(/*returns_best=*/false);
}

}  // namespace ballast
