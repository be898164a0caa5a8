#include "solvers/backends/anderson_pgs.hpp"

#include <limits>
#include <utility>

#include "solvers/gauss_seidel/any_sweep.hpp"
#include "solvers/parts/anderson.hpp"

namespace ballast {
namespace {

// Only swept iterates, which lie in the cones, are judged or returned. The change of a sweep is
// measured in the impulses, each scaled by the root of its own entry of W, so that heavy and light
// bodies count alike.
class AndersonPgs final : public Solver {
 public:
  explicit AndersonPgs(const AndersonPgsSettings& settings) : settings_(settings) {}

  void prepare(const FrictionProblem& problem) override { sweep_.prepare(problem); }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {4, 1.1});
    const auto load = [&] { sweep_->load(problem, r); };
    load();
    sweep_->store(problem, r);
    iteration.evaluated(sweep_->error(), r);
    begin();
    while (iteration.next()) {
      sweep_->sweep();
      if (iteration.error_due())
        iteration.evaluated(swept_error(*sweep_, problem, iteration, r, load), r);
      sweep_->save(image_);
      extrapolate();
      sweep_->restore(x_);
    }
    return iteration.finish(std::move(r));
  }

 private:
  // No past: the first sweep is taken as it comes.
  void begin() {
    sweep_->impulse_weights(weights_);
    sweep_->save(x_);
    good_image_ = x_;
    mixing_.reset(settings_.memory);
    last_change_ = std::numeric_limits<double>::infinity();
  }

  /// x_ := the mixed iterate; or, where the last mixing made the sweep's work much larger, the good
  /// image from before it.
  void extrapolate() {
    const Eigen::Index compared = weights_.size();
    // |G(x) - x| in the weights of W's diagonal.
    const double change = ((image_ - x_).head(compared).cwiseProduct(weights_)).norm();
    if (!(change <= settings_.allowed_growth * last_change_)) {
      mixing_.forget();
      last_change_ = std::numeric_limits<double>::infinity();
      x_ = good_image_;
      return;
    }
    mixing_.step(x_, image_, compared, weights_);
    good_image_.swap(image_);
    last_change_ = change;
  }

  AndersonPgsSettings settings_;
  AnySweep sweep_;
  Anderson mixing_;
  Eigen::VectorXd x_, image_, good_image_, weights_;
  double last_change_ = 0.0;
};

}  // namespace

std::unique_ptr<Solver> make_anderson_pgs(const AndersonPgsSettings& settings) {
  return std::make_unique<AndersonPgs>(settings);
}

}  // namespace ballast
