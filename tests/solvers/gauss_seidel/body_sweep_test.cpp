#include "solvers/gauss_seidel/body_sweep.hpp"
#include "platform/worker_team.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/solvers/gauss_seidel/grain_problem.hpp"
#include "tests/support/slow_sweep.hpp"

using namespace ballast;

namespace {

/// A sweep along a search direction, the slow way: the whole iterate moved as a vector, then a
/// plain sweep. The combination as the formula says it, on impulses and velocities as one vector.
class Twin {
 public:
  explicit Twin(Eigen::Index size) : before_(Eigen::VectorXd::Zero(size)), direction_(before_) {}

  double sweep(BodySweep& sweep, SearchStep step, Eigen::Index impulses) {
    Eigen::VectorXd x;
    sweep.save(x);
    const Eigen::VectorXd along = step.beta * direction_ + step.ahead * (x - before_);
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
  WorkerTeam team;
  team.resize(2);
  fast.use_team(&team);
  fast.start_search();
  Eigen::VectorXd fast_state, slow_state;
  slow.save(slow_state);
  Eigen::VectorXd weights;
  slow.impulse_weights(weights);
  Twin twin(slow_state.size());

  for (const SearchStep step : samples::all_search_steps) {
    const double fast_square = fast.sweep(step),
                 slow_square = twin.sweep(slow, step, weights.size());
    CHECK(fast_square == Approx(slow_square).epsilon(1e-12));
    fast.save(fast_state);
    slow.save(slow_state);
    CHECK(fast_state == slow_state);
  }
  CHECK(fast_state.allFinite());
  CHECK(fast_state.head(weights.size()).norm() > 0.0);
}

TEST_CASE("a sweep over bodies is that of dense matrices, in its own order") {
  const FrictionProblem problem =
      make_known_solution({.bodies = 20, .contacts = 30, .frictionless_fraction = 0.3}).problem;
  BodySweep sweep;
  sweep.prepare(problem);
  check_beside_slow_sweep(sweep, problem, problem, plan_order(problem));
}

TEST_CASE("contacts and bodies of every kind: loaded and stored alike, but for what cannot move") {
  const FrictionProblem problem = oracle::mixed_problem();  // contact 4: nothing moves
  BodySweep sweep;
  sweep.prepare(problem);
  const Impulses r = Impulses::LinSpaced(problem.row_count(), 0.1, 0.9);
  Impulses back = Impulses::Zero(problem.row_count()), expected = r;
  expected.segment(problem.row_begin[4], 3).setZero();
  sweep.load(problem, r);
  sweep.store(problem, back);
  CHECK((back - expected).norm() <= 1e-14 * r.norm());
  CHECK(sweep.error() == Approx(contact_error(problem, expected).natural_map_rms));
}

TEST_CASE("a saved iterate swept again gives the same; weights are those of W's diagonal") {
  const FrictionProblem problem = make_known_solution({.bodies = 20, .contacts = 60}).problem;
  BodySweep sweep;
  sweep.prepare(problem);
  sweep.load(problem, Impulses::Zero(problem.row_count()));
  for (int k = 0; k < 3; ++k) sweep.sweep();
  Eigen::VectorXd state, weights;
  sweep.save(state);
  Impulses first = Impulses::Zero(problem.row_count()), again = first;
  sweep.sweep();
  sweep.store(problem, first);
  sweep.restore(state);
  sweep.sweep();
  sweep.store(problem, again);
  CHECK((first - again).norm() <= 1e-12 * first.norm());

  sweep.impulse_weights(weights);
  CHECK(weights.size() == problem.row_count());
  std::vector<Eigen::Matrix3d> blocks;
  delassus_diagonal(problem, blocks);
  double normal_squares = 0.0;
  for (const Eigen::Matrix3d& block : blocks) normal_squares += block(0, 0);
  double found = 0.0;  // the records' normal entries: the first of three, then those of one row
  int one_row = 0;
  for (int c = 0; c < problem.contact_count(); ++c) one_row += problem.contact_rows(c) == 1;
  for (int k = 0; k < problem.contact_count() - one_row; ++k)
    found += weights[3 * k] * weights[3 * k];
  found += weights.tail(one_row).squaredNorm();
  CHECK(found == Approx(normal_squares));
}

TEST_CASE("grains are swept in groups, anything else and every variant contact by contact") {
  BodySweep sweep;
  sweep.prepare(samples::grain_problem());
  CHECK(sweep.is_wide());
  sweep.prepare(oracle::mixed_problem());
  CHECK_FALSE(sweep.is_wide());
  sweep.prepare(samples::grain_problem());
  CHECK(sweep.is_wide());
  sweep.use_variants();
  sweep.prepare(samples::grain_problem());
  CHECK_FALSE(sweep.is_wide());
}
