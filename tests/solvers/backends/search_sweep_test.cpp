// The sweep along a search direction against its twin: the whole iterate moved as a vector, then a
// plain sweep.

#include "problems/algebra/known_solutions.hpp"
#include "solvers/gauss_seidel/body_sweep.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// The combination as the formula says it, on impulses and velocities as one vector.
class Twin {
 public:
  explicit Twin(Eigen::Index size) : before_(Eigen::VectorXd::Zero(size)), direction_(before_) {}

  double sweep(BodySweep& sweep, SearchStep step, Eigen::Index impulses) {
    Eigen::VectorXd x;
    sweep.save(x);
    const Eigen::VectorXd along = step.beta * direction_;
    direction_ = along + step.gain * (x - before_);
    x += along;
    before_ = x;
    sweep.restore(x);
    sweep.sweep();
    sweep.save(x);
    return (x - before_).head(impulses).squaredNorm();
  }

 private:
  Eigen::VectorXd before_, direction_;
};

}  // namespace

TEST_CASE(
    "a sweep along a search direction moves impulses and velocities by the same step, then "
    "sweeps") {
  KnownSolutionSettings settings;
  settings.bodies = 60;
  settings.contacts = 200;
  settings.frictionless_fraction = 0.3;
  settings.seed = 8;
  const FrictionProblem problem = make_known_solution(settings).problem;
  const Impulses start = Impulses::Constant(problem.row_count(), 1e-3);

  BodySweep fast, slow;
  for (BodySweep* sweep : {&fast, &slow}) {
    sweep->prepare(problem);
    sweep->load(problem, start);
  }
  fast.use_threads(2);
  SweepSearch search;
  fast.start_search(search);
  Eigen::VectorXd fast_state, slow_state;
  slow.save(slow_state);
  Eigen::VectorXd weights;
  slow.impulse_weights(weights);
  Twin twin(slow_state.size());

  for (const SearchStep step :
       {SearchStep{0.0, 0.0}, {0.0, 1.0}, {0.7, 1.0}, {0.3, 1.0}, {0.0, 1.0}, {0.9, 1.0}}) {
    const double fast_square = fast.sweep(search, step),
                 slow_square = twin.sweep(slow, step, weights.size());
    CHECK(fast_square == Approx(slow_square).epsilon(1e-12));
    fast.save(fast_state);
    slow.save(slow_state);
    CHECK(fast_state == slow_state);
  }
  CHECK(fast_state.allFinite());
  CHECK(fast_state.head(weights.size()).norm() > 0.0);
}
