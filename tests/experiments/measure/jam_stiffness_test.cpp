#include "experiments/measure/jam_stiffness.hpp"

#include <cmath>

#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/pressed_wall.hpp"

using namespace ballast;

namespace {

constexpr double mass = 2.0, h = 1e-3;

/// Goes a part of the way to the solution.
class Hesitant final : public Solver {
 public:
  explicit Hesitant(double part) : part_(part) {}
  void prepare(const FrictionProblem&) override {}
  Solved solve(const FrictionProblem& problem, Impulses start, const Budget&) override {
    Eigen::VectorXd v;
    body_velocity(problem.dynamics, problem.row_begin, start, v);
    Solved solved;
    solved.impulses = start - part_ * mass * v;
    solved.reason = StopReason::iteration_limit;
    return solved;
  }

 private:
  double part_;
};

double stiffness(double part, double start) {
  Hesitant solver(part);
  return jam_stiffness(solver, pressed_wall(), Impulses::Constant(1, start), {}, h);
}

}  // namespace

TEST_CASE("A solver that does nothing leaves the wall free: k_art is m / h^2") {
  CHECK(stiffness(0.0, 2.0) == Approx(mass / (h * h)));
}

TEST_CASE("A solver that goes part of the way leaves a jam that is so much stiffer") {
  CHECK(stiffness(0.75, 2.0) == Approx(4.0 * mass / (h * h)));
  // What it would still have come closer at the same load does not count.
  CHECK(stiffness(0.75, 1.5) == Approx(4.0 * mass / (h * h)));
}

TEST_CASE("A jam solved exactly is rigid") {
  const auto pgs = make_solver("pgs");
  const double k = jam_stiffness(*pgs, pressed_wall(), Impulses::Constant(1, 2.0), {1e-14}, h);
  CHECK(k > 1e12 * mass / (h * h));
}

TEST_CASE("Without a wall, or without a force on it, there is no jam") {
  CHECK(std::isnan(stiffness(0.5, 0.0)));
  FrictionProblem none;
  none.has_dynamics = true;
  Hesitant solver(0.5);
  CHECK(std::isnan(jam_stiffness(solver, none, {}, {}, h)));
}
