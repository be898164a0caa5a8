#include "solvers/seam/rounds.hpp"

#include <chrono>
#include <limits>
#include <thread>

#include <Eigen/Eigenvalues>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

/// A problem, its solution in the rows that can move, and a loop over rounds.
struct Trial {
  KnownSolution known = make_known_solution({.bodies = 10, .contacts = 8});
  ReducedProblem moving;
  Eigen::VectorXd exact;

  Trial() {
    moving.take(known.problem);
    exact = known.r(moving.row);
  }
  Solved solve(const Budget& budget, int patience,
               const std::function<void(const RoundRequest&, RoundAnswer&)>& round) {
    return solve_in_rounds(moving, Impulses::Zero(known.problem.row_count()), budget, patience,
                           round);
  }
};

}  // namespace

TEST_CASE("rounds go on until the judge is content, and each counts what it cost") {
  Trial trial;
  std::vector<int> left;
  int rounds = 0;
  const Solved solved = trial.solve({.tolerance = 1e-6, .max_iterations = 100}, 3,
                                    [&](const RoundRequest& request, RoundAnswer& answer) {
                                      left.push_back(request.left.max_iterations);
                                      CHECK(request.left.max_seconds > 0.0);
                                      CHECK(request.last == request.best);  // every round improves
                                      answer.x = request.last + 0.9 * (trial.exact - request.last);
                                      answer.iterations = 4;
                                      ++rounds;
                                    });
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(solved.iterations == 4 * rounds);
  CHECK(rounds < 15);
  for (std::size_t k = 0; k < left.size(); ++k) CHECK(left[k] == 100 - 4 * static_cast<int>(k));
  CHECK(contact_error(trial.known.problem, solved.impulses).natural_map_rms <= 1e-6);
}

TEST_CASE("the best iterate is returned, not the last") {
  Trial trial;
  int round = 0;
  const Solved solved = trial.solve({.tolerance = 0.0, .max_iterations = 3}, 100,
                                    [&](const RoundRequest& request, RoundAnswer& answer) {
                                      if (round == 2) CHECK(request.last != request.best);
                                      answer.x = (round == 0 ? 1.001 : 3.0) * trial.exact;
                                      ++round;
                                    });
  CHECK(round == 3);
  CHECK(solved.reason == StopReason::iteration_limit);
  CHECK((solved.impulses - 1.001 * trial.known.r).norm() <= 1e-12 * trial.known.r.norm());
}

TEST_CASE("rounds that stand still stall, those that a limit ended do not count") {
  Trial trial;
  int rounds = 0;
  const auto idle = [&](bool finished) {
    rounds = 0;
    return trial.solve({.tolerance = 1e-12, .max_iterations = 50}, 5,
                       [&](const RoundRequest& request, RoundAnswer& answer) {
                         answer.x = request.last;
                         answer.finished = finished;
                         ++rounds;
                       });
  };
  CHECK(idle(true).reason == StopReason::stalled);
  CHECK(rounds == 5);
  CHECK(idle(false).reason == StopReason::iteration_limit);
  CHECK(rounds == 50);
}

TEST_CASE("nothing is taken from a round that fails") {
  Trial trial;
  const Eigen::VectorXd no_number =
      Eigen::VectorXd::Constant(trial.exact.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Eigen::VectorXd& bad : {Eigen::VectorXd(), Eigen::VectorXd{{0.0}}, no_number}) {
    const Solved solved = trial.solve(
        {.tolerance = 1e-12}, 4, [&](const RoundRequest&, RoundAnswer& answer) { answer.x = bad; });
    CHECK(solved.reason == StopReason::stalled);
    CHECK(solved.iterations == 4);
    CHECK(solved.impulses == Impulses::Zero(trial.known.problem.row_count()));
  }
}

TEST_CASE("a solve that is cancelled does not wait for a child") {
  Trial trial;
  bool is_cancelled = false;
  const Budget budget{.tolerance = 1e-12, .is_cancelled = [&] { return is_cancelled; }};
  const auto hang = [](RoundAnswer&) {
    std::this_thread::sleep_for(std::chrono::hours(1));
    return true;
  };
  const Solved solved =
      trial.solve(budget, 4, [&](const RoundRequest& request, RoundAnswer& answer) {
        is_cancelled = true;
        CHECK_FALSE(answer_apart(request.left, hang, answer));
      });
  CHECK(solved.reason == StopReason::time_limit);
  CHECK(solved.iterations == 1);
}

TEST_CASE("what a round did besides its own work is start-up") {
  Trial trial;
  const auto solve = [&](double own_seconds) {
    return trial.solve({.tolerance = 1e-6, .max_seconds = 1e6}, 3,
                       [&](const RoundRequest&, RoundAnswer& answer) {
                         std::this_thread::sleep_for(std::chrono::milliseconds(20));
                         answer.x = trial.exact;
                         answer.seconds = own_seconds;
                       });
  };
  CHECK(solve(0.0).startup_seconds >= 0.02);
  CHECK(solve(-1.0).startup_seconds < solve(0.0).startup_seconds);
}

TEST_CASE("rounds stop on Siconos' measure where the budget asks for it") {
  Trial trial;
  FclibStop stop(trial.known.problem, 1e-3);
  Budget budget{.tolerance = 0.0};
  budget.fclib = &stop;
  const Solved solved =
      trial.solve(budget, 3, [&](const RoundRequest& request, RoundAnswer& answer) {
        answer.x = request.last + 0.5 * (trial.exact - request.last);
      });
  CHECK(solved.reason == StopReason::reached_tolerance);
  const double fclib = contact_error(trial.known.problem, solved.impulses).fclib;
  CHECK(fclib <= 1e-3);
  CHECK(fclib > 1e-4);
}

TEST_CASE("the contacts that move, as the dense operator has them") {
  const FrictionProblem problem = oracle::mixed_problem();  // contact 4 cannot move
  ReducedProblem moving;
  moving.take(problem);
  CHECK(moving.contact == std::vector<int>{0, 1, 2, 3, 5, 6});
  CHECK(moving.row_begin == std::vector<int>{0, 3, 6, 7, 10, 13, 14});
  CHECK(moving.contact_count() == 6);
  CHECK(moving.row_count() == 14);
  CHECK(moving.rows(2) == 1);

  const Eigen::MatrixXd w = oracle::dense_delassus(problem);
  const Eigen::VectorXd q = oracle::dense_q(problem);
  std::vector<int> rows;
  for (const int c : moving.contact)
    for (int i = problem.row_begin[c]; i < problem.row_begin[c + 1]; ++i) rows.push_back(i);
  CHECK((Eigen::MatrixXd(moving.w) - w(rows, rows)).norm() <= 1e-12 * w.norm());
  CHECK((moving.q - q(rows)).norm() <= 1e-14 * q.norm());
  for (int k = 0; k < moving.contact_count(); ++k) {
    const int c = moving.contact[k];
    CHECK(moving.friction[k] == problem.friction[c]);
    const Eigen::MatrixXd block = w.block(problem.row_begin[c], problem.row_begin[c],
                                          problem.contact_rows(c), problem.contact_rows(c));
    CHECK(moving.lambda_max[k] == Approx(oracle::eigenvalues(block).maxCoeff()));
  }
}

TEST_CASE("impulses there and back: what moves stays, what does not becomes zero") {
  FrictionProblem problem = oracle::mixed_problem();
  ReducedProblem moving;
  moving.take(problem);
  const Impulses r = Impulses::LinSpaced(problem.row_count(), 1.0, 2.0);
  const Eigen::VectorXd x = r(moving.row);
  CHECK(x.size() == 14);
  Impulses back, expected = r;
  moving.scatter(x, back);
  expected.segment(problem.row_begin[4], 3).setZero();
  CHECK(back == expected);
  // A problem without contacts follows.
  problem.clear_contacts();
  problem.dynamics.bias.resize(0);
  moving.take(problem);
  CHECK(moving.contact_count() == 0);
  CHECK(moving.row_count() == 0);
}
