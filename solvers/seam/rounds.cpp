#include "solvers/seam/rounds.hpp"

#include <algorithm>
#include <utility>

#include "platform/pack.hpp"
#include "platform/program.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {

SparseRows chosen(const SparseRows& w, const std::vector<int>& row) {
  SparseRows pick(static_cast<Eigen::Index>(row.size()), w.cols());
  for (int i = 0; i < pick.rows(); ++i) pick.insert(i, row[i]) = 1.0;
  return pick * w * SparseRows(pick.transpose());
}

void ReducedProblem::take(const FrictionProblem& problem) {
  std::vector<Eigen::Matrix3d> diagonal;
  delassus_diagonal(problem, diagonal);
  Eigen::VectorXd whole_q;
  free_contact_velocity(problem, whole_q);
  // The contacts to keep, and the positions of their rows.
  *this = {};
  whole = &problem;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const double largest = largest_eigenvalue(diagonal[c]);
    if (!(largest > 0.0)) continue;
    contact.push_back(c);
    friction.push_back(problem.friction[c]);
    lambda_max.push_back(largest);
    for (int i = 0; i < problem.contact_rows(c); ++i) row.push_back(problem.row_begin[c] + i);
    row_begin.push_back(row_begin.back() + problem.contact_rows(c));
  }
  q = whole_q(row);
  w = chosen(delassus_matrix(problem), row);
}

bool answer_apart(const Budget& left, const std::function<bool(RoundAnswer&)>& call,
                  RoundAnswer& answer) {
  if (is_expendable_process()) return call(answer);
  const auto carry = [](auto& carrier, auto& carried) {
    carrier.list(carried.x);
    carrier.numbers(carried.iterations, carried.seconds);
  };
  const auto work = [&] {
    RoundAnswer there;
    if (!call(there)) return std::string();
    Packer packer;
    carry(packer, there);
    return packer.bytes();
  };
  const ChildResult child = run_in_child(left.max_seconds, work, left.is_cancelled);
  if (child.end != ChildEnd::complete || child.answer.empty()) return false;
  Unpacker unpacker(child.answer, "a child's answer");
  carry(unpacker, answer);
  unpacker.finish();
  return true;
}

Solved solve_in_rounds(const ReducedProblem& moving, Impulses start, const Budget& budget,
                       int patience,
                       const std::function<void(const RoundRequest&, RoundAnswer&)>& round) {
  Course course(budget, std::move(start));
  ContactJudge judge;
  Impulses r;
  Eigen::VectorXd last, best;
  double last_error = 0.0;
  // The foreign solver has stopped before the judge works: the judge's time is not the solver's.
  const auto judged = [&](const Eigen::VectorXd& x) {
    Stopwatch watch;
    last = x;
    moving.scatter(last, r);
    last_error = judge.judge(*moving.whole, r).natural_map_rms;
    course.add_startup(watch.restart());
    course.offer(r, last_error);
    best = course.best()(moving.row);
    course.add_startup(watch.seconds());
  };
  judged(course.best()(moving.row));
  // A round makes progress if the error is a tenth less than at the last progress.
  double from = course.error();
  int idle = 0;  // finished rounds without progress
  while (!course.over() && idle < patience) {
    RoundAnswer answer;
    const Budget left = course.rest();
    const Stopwatch watch;
    round({last, best, last_error, left}, answer);
    if (answer.seconds >= 0.0) course.add_startup(watch.seconds() - answer.seconds);
    course.spend(std::clamp(answer.iterations, 1, left.max_iterations));
    if (answer.x.size() == last.size() && answer.x.allFinite()) judged(answer.x);
    if (course.error() < 0.9 * from) {
      from = course.error();
      idle = 0;
    } else if (answer.finished) {
      ++idle;
    }
  }
  return course.finish();
}

}  // namespace ballast
