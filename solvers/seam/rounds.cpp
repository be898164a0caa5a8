#include "solvers/seam/rounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "platform/pack.hpp"
#include "platform/program.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {

void MovingContacts::take(const FrictionProblem& problem) {
  std::vector<Eigen::Matrix3d> diagonal;
  delassus_diagonal(problem, diagonal);
  const SparseRows whole = delassus_matrix(problem);
  Eigen::VectorXd whole_q;
  free_contact_velocity(problem, whole_q);

  // The contacts to keep, and where their rows go.
  contact.clear();
  row_begin.assign(1, 0);
  friction.clear();
  lambda_max.clear();
  std::vector<int> row_here(problem.row_count(), -1);
  for (int c = 0; c < problem.contact_count(); ++c) {
    const double largest = largest_eigenvalue(diagonal[c]);
    if (!(largest > 0.0)) continue;
    contact.push_back(c);
    friction.push_back(problem.friction[c]);
    lambda_max.push_back(largest);
    for (int i = 0; i < problem.contact_rows(c); ++i)
      row_here[problem.row_begin[c] + i] = row_begin.back() + i;
    row_begin.push_back(row_begin.back() + problem.contact_rows(c));
  }
  // Their part of q and W.
  q.resize(row_count());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(whole.nonZeros());
  for (int row = 0; row < problem.row_count(); ++row) {
    if (row_here[row] < 0) continue;
    q[row_here[row]] = whole_q[row];
    for (SparseRows::InnerIterator entry(whole, row); entry; ++entry)
      if (row_here[entry.col()] >= 0)
        entries.emplace_back(row_here[row], row_here[entry.col()], entry.value());
  }
  w.resize(row_count(), row_count());
  w.setFromTriplets(entries.begin(), entries.end());
}

void MovingContacts::gather(const FrictionProblem& problem, const Impulses& r,
                            Eigen::VectorXd& x) const {
  x.resize(row_count());
  for (int k = 0; k < contact_count(); ++k)
    x.segment(row_begin[k], rows(k)) = r.segment(problem.row_begin[contact[k]], rows(k));
}

void MovingContacts::scatter(const FrictionProblem& problem, const Eigen::VectorXd& x,
                             Impulses& r) const {
  r.setZero(problem.row_count());
  for (int k = 0; k < contact_count(); ++k)
    r.segment(problem.row_begin[contact[k]], rows(k)) = x.segment(row_begin[k], rows(k));
}

bool answer_apart(double max_seconds, const std::function<bool(RoundAnswer&)>& call,
                  RoundAnswer& answer) {
  if (is_expendable_process()) return call(answer);
  const auto carry = [](auto& carrier, auto& carried) {
    carrier.list(carried.x);
    carrier.numbers(carried.iterations, carried.seconds);
  };
  const ChildResult child = run_in_child(max_seconds, [&] {
    RoundAnswer there;
    if (!call(there)) return std::string();
    Packer packer;
    carry(packer, there);
    return packer.bytes();
  });
  if (child.answer.empty()) return false;
  Unpacker unpacker(child.answer, "a child's answer");
  carry(unpacker, answer);
  unpacker.finish();
  return true;
}

namespace {

/// Rounds without progress: a tenth less error than when it was last seen.
struct Progress {
  double from;
  int idle = 0;

  void see(double best_error, bool is_round_finished) {
    if (best_error < 0.9 * from) {
      from = best_error;
      idle = 0;
    } else if (is_round_finished) {
      ++idle;
    }
  }
};

}  // namespace

Solved solve_in_rounds(const FrictionProblem& problem, const MovingContacts& moving, Impulses start,
                       const Budget& budget, int patience,
                       const std::function<void(const RoundRequest&, RoundAnswer&)>& round) {
  ContactJudge judge;
  // Standing still is judged by rounds, below.
  Iteration iteration(budget, {}, std::numeric_limits<int>::max());
  Impulses r = std::move(start);
  // A foreign solver has stopped by its own measure when the judge looks: that time is not its own.
  const auto error_of = [&](const Eigen::VectorXd& x) {
    const Stopwatch watch;
    moving.scatter(problem, x, r);
    const double error = judge.judge(problem, r).natural_map_rms;
    iteration.add_startup(watch.seconds());
    return error;
  };
  const auto evaluated = [&](const Eigen::VectorXd& x, double error) {
    const Stopwatch watch;
    moving.scatter(problem, x, r);
    if (budget.fclib) budget.fclib->reached(r, error);
    iteration.add_startup(watch.seconds());
    iteration.evaluated(error, r);
  };

  Eigen::VectorXd last;
  moving.gather(problem, r, last);
  Eigen::VectorXd best = last;
  double last_error = error_of(last), best_error = last_error;
  evaluated(best, best_error);
  Progress progress{best_error};
  bool stalled = false;
  RoundAnswer answer;
  while (!stalled && iteration.next()) {
    const Budget left = budget.after(iteration.count() - 1, iteration.seconds());
    answer.x.resize(0);
    answer.iterations = 1;
    answer.seconds = -1.0;
    answer.finished = true;
    const Stopwatch watch;
    round({last, best, last_error, left}, answer);
    if (answer.seconds >= 0.0) iteration.add_startup(watch.seconds() - answer.seconds);
    // The round's own iterations are booked; the loop has counted one.
    for (int i = 1; i < std::min(answer.iterations, left.max_iterations); ++i) iteration.next();
    // The judge looks at what came back.
    if (answer.x.size() == last.size() && answer.x.allFinite()) {
      last = answer.x;
      last_error = error_of(last);
      if (last_error < best_error) {
        best_error = last_error;
        best = last;
      }
    }
    progress.see(best_error, answer.finished);
    iteration.error_due();
    evaluated(best, best_error);
    stalled = progress.idle >= patience;
  }
  moving.scatter(problem, best, r);
  Solved solved = iteration.finish(std::move(r));
  // The loop ended by itself, and none of the budget's reasons applies.
  if (stalled && solved.reason == StopReason::numerical_failure && std::isfinite(best_error))
    solved.reason = StopReason::stalled;
  return solved;
}

}  // namespace ballast
