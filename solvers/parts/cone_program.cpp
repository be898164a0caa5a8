#include "solvers/parts/cone_program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ballast {

/// Units are taken out of the impulses [N s] by r = unit D x with D = diag(1 /
/// sqrt(lambda_max(W_cc))). Then D u = unit (D W D x + D q / unit): the program has D W D for W,
/// whose diagonal blocks have no eigenvalue above one, and D q / unit for q.
void ConeProgram::take(const FrictionProblem& problem) {
  moving_.take(problem);
  operator_.prepare(problem);
  friction = moving_.friction;
  row_begin.assign(1, 0);
  row_.clear();
  scale_.resize(moving_.row_count());
  double largest_lambda = 0.0;
  for (int k = 0; k < moving_.contact_count(); ++k) {
    const int rows = friction[k] > 0.0 ? 3 : 1;
    scale_.segment(row_begin.back(), rows).setConstant(1.0 / std::sqrt(moving_.lambda_max[k]));
    for (int i = 0; i < rows; ++i) row_.push_back(moving_.row_begin[k] + i);
    row_begin.push_back(row_begin.back() + rows);
    largest_lambda = std::max(largest_lambda, moving_.lambda_max[k]);
  }
  scale_.conservativeResize(row_count());
  q = scale_.cwiseProduct(moving_.q(row_));
  unit_ = q.size() > 0 ? q.lpNorm<Eigen::Infinity>() : 0.0;
  if (!(unit_ > 0.0)) unit_ = 1.0;
  q /= unit_;
  // The largest velocity [m/s] that an entry of size one can stand for.
  velocity_unit_ = unit_ * std::sqrt(largest_lambda);

  // W between the rows that are left, its blocks scaled on both sides.
  w_as_is_ = chosen(moving_.w, row_);
  for (int i = 0; i < row_count(); ++i)
    for (SparseRows::InnerIterator entry(w_as_is_, i); entry; ++entry)
      entry.valueRef() *= scale_[i] * scale_[entry.col()];
  const SparseRows transposed = w_as_is_.transpose();
  w = 0.5 * (w_as_is_ + transposed);
  scale_ *= unit_;  // from here on: impulse = scale * x
}

void ConeProgram::project(Eigen::VectorXd& x) const {
  for (int k = 0; k < contact_count(); ++k)
    if (has_friction(k))
      x.segment<3>(row_begin[k]) = project_cone(x.segment<3>(row_begin[k]), friction[k]);
    else
      x[row_begin[k]] = std::max(0.0, x[row_begin[k]]);
}

Solved ConeProgram::solve(Impulses start, const Budget& budget, int patience,
                          const std::function<void(const ConeRequest&, RoundAnswer&)>& convex) {
  // A warm start gives the first s; a cold start has s = 0.
  shift_.reset(operator_);
  Eigen::VectorXd u;
  operator_.velocity(start, u);
  if (start.squaredNorm() > 0.0) shift_.follow(operator_, u);
  // A round: the last impulses give the linear term, `convex` solves with s held, and the
  // velocities of its answer give the next s.
  Impulses r;
  const auto round = [&](const RoundRequest& request, RoundAnswer& answer) {
    Eigen::VectorXd x = request.last(row_).cwiseQuotient(scale_);
    // q plus s, plus the product of W's skew part with x, which the symmetric part leaves out.
    Eigen::VectorXd term = q + w_as_is_ * x - w * x;
    // scale_ is unit D here, so that this is D s / unit: s is a velocity like q.
    for (int k = 0; k < contact_count(); ++k)
      term[row_begin[k]] += shift_[moving_.contact[k]] * scale_[row_begin[k]] / (unit_ * unit_);
    project(x);
    convex({term, x, budget.aim() / velocity_unit_, request.left}, answer);
    const Eigen::VectorXd solved = std::move(answer.x);
    // An empty answer tells the rounds that this one failed.
    answer.x.resize(0);
    if (solved.size() != row_count() || !solved.allFinite()) return;
    answer.x.setZero(moving_.row_count());
    answer.x(row_) = scale_.cwiseProduct(solved);
    moving_.scatter(answer.x, r);
    operator_.velocity(r, u);
    shift_.improve(operator_, u);
  };
  return solve_in_rounds(moving_, std::move(start), budget, patience, round);
}

}  // namespace ballast
