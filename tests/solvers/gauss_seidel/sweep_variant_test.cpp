#include "solvers/gauss_seidel/sweep_variant.hpp"

#include <array>

#include "problems/algebra/friction_cone.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "solvers/gauss_seidel/any_sweep.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/slow_sweep.hpp"

using namespace ballast;

namespace {

std::vector<FrictionProblem> varied_problems() {
  return {make_known_solution({.contacts = 60}).problem, oracle::mixed_problem()};
}

/// In both forms, with the order of the plain sweep.
template <typename Task>
void for_forms(const FrictionProblem& problem, const Task& task) {
  task(problem, plan_order(problem));
  task(only_delassus(problem), in_order(problem));
}

/// One sweep over dense matrices, each contact's change relaxed and projected back onto its cone.
void relaxed_slowly(const FrictionProblem& problem, const std::vector<int>& order,
                    double relaxation, Impulses& r) {
  const Eigen::MatrixXd w = oracle::dense_delassus(problem);
  const Eigen::VectorXd q = oracle::dense_q(problem);
  for (const int c : order) {
    Impulses exact = r;
    slow_sweep(problem, w, q, std::array{c}, exact);
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    const int rows = problem.contact_rows(c), begin = problem.row_begin[c];
    x.head(rows) = ((1.0 - relaxation) * r + relaxation * exact).segment(begin, rows);
    r.segment(begin, rows) = project_cone(x, problem.friction[c]).head(rows);
  }
}

}  // namespace

TEST_CASE("the slow loop with the plain settings is the plain sweep") {
  for (const FrictionProblem& given : varied_problems())
    for_forms(given, [&](const FrictionProblem& problem, const std::vector<int>& order) {
      AnySweep plain, other;
      Impulses start = Impulses::Constant(problem.row_count(), 0.1), fast = start, slow = start;
      other.use_variants();
      for (AnySweep* sweep : {&plain, &other}) {
        sweep->prepare(problem);
        (*sweep)->load(problem, start);
      }
      for (int k = 0; k < 3; ++k) {
        plain->sweep();
        other->sweep_by({}, order);
      }
      plain->store(problem, fast);
      other->store(problem, slow);
      CHECK((fast - slow).norm() <= 1e-9 * fast.norm());
      CHECK(plain->error() == Approx(other->error()).epsilon(1e-6).margin(1e-13));
    });
}

TEST_CASE("relaxation takes each contact's change further or less far, back onto its cone") {
  const FrictionProblem given =
      make_known_solution({.bodies = 20, .contacts = 30, .frictionless_fraction = 0.4}).problem;
  for (const double relaxation : {0.5, 1.6})
    for_forms(given, [&](const FrictionProblem& problem, const std::vector<int>& order) {
      AnySweep sweep;
      sweep.use_variants();
      sweep.prepare(problem);
      Impulses fast = Impulses::Constant(problem.row_count(), 0.05), slow = fast;
      sweep->load(problem, fast);
      for (int k = 0; k < 3; ++k) {
        sweep->sweep_by({.relaxation = relaxation}, order);
        relaxed_slowly(given, order, relaxation, slow);
      }
      sweep->store(problem, fast);
      CHECK((fast - slow).norm() <= 1e-9 * slow.norm());
    });
}

TEST_CASE("a solution is what no variant leaves") {
  const KnownSolution known = make_known_solution({.bodies = 20, .contacts = 15});
  AnySweep sweep;
  sweep.prepare(known.problem);
  for (const SweepVariant variant :
       {SweepVariant{.rule = LocalRule::projection}, SweepVariant{.relaxation = 1.3},
        SweepVariant{.relaxation = 0.5}}) {
    sweep->load(known.problem, known.r);
    sweep->sweep_by(variant, in_order(known.problem));
    Impulses r = known.r;
    sweep->store(known.problem, r);
    CHECK((r - known.r).norm() <= 1e-9 * known.r.norm());
  }
}
