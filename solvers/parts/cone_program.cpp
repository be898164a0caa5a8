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
  std::vector<int> here(moving_.row_count(), -1);
  std::vector<double> scale;
  double largest_lambda = 0.0;
  for (int k = 0; k < moving_.contact_count(); ++k) {
    const int rows = friction[k] > 0.0 ? 3 : 1;
    for (int i = 0; i < rows; ++i) {
      here[moving_.row_begin[k] + i] = static_cast<int>(row_.size());
      row_.push_back(moving_.row_begin[k] + i);
      scale.push_back(1.0 / std::sqrt(moving_.lambda_max[k]));
    }
    row_begin.push_back(row_begin.back() + rows);
    largest_lambda = std::max(largest_lambda, moving_.lambda_max[k]);
  }
  scale_ = Eigen::Map<const Eigen::VectorXd>(scale.data(), static_cast<Eigen::Index>(scale.size()));
  q.resize(row_count());
  for (int i = 0; i < row_count(); ++i) q[i] = scale_[i] * moving_.q[row_[i]];
  unit_ = q.size() > 0 ? q.lpNorm<Eigen::Infinity>() : 0.0;
  if (!(unit_ > 0.0)) unit_ = 1.0;
  q /= unit_;
  // The largest velocity [m/s] that an entry of size one can stand for.
  velocity_unit_ = unit_ * std::sqrt(largest_lambda);

  // W between the rows that are left, its blocks scaled on both sides.
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < row_count(); ++i)
    for (SparseRows::InnerIterator entry(moving_.w, row_[i]); entry; ++entry) {
      const int j = here[entry.col()];
      if (j < 0) continue;
      entries.emplace_back(i, j, scale_[i] * scale_[j] * entry.value());
    }
  w_as_is.resize(row_count(), row_count());
  w_as_is.setFromTriplets(entries.begin(), entries.end());
  const SparseRows transposed = w_as_is.transpose();
  w = 0.5 * (w_as_is + transposed);
  scale_ *= unit_;  // from here on: impulse = scale * x
}

Eigen::VectorXd ConeProgram::to_rows(const Eigen::VectorXd& x) const {
  Eigen::VectorXd r = Eigen::VectorXd::Zero(moving_.row_count());
  for (int i = 0; i < row_count(); ++i) r[row_[i]] = scale_[i] * x[i];
  return r;
}

Eigen::VectorXd ConeProgram::from_rows(const Eigen::VectorXd& r) const {
  Eigen::VectorXd x(row_count());
  for (int i = 0; i < row_count(); ++i) x[i] = r[row_[i]] / scale_[i];
  return x;
}

Eigen::VectorXd ConeProgram::from_polar(const Eigen::VectorXd& y) const {
  Eigen::VectorXd x = y;
  for (int k = 0; k < contact_count(); ++k)
    if (has_friction(k)) x.segment<2>(row_begin[k] + 1) *= friction[k] * y[row_begin[k]];
  return x;
}

Eigen::VectorXd ConeProgram::polar_gradient(const Eigen::VectorXd& y,
                                            const Eigen::VectorXd& g) const {
  // By the chain rule for x_T = mu x_N d: dx_T / dx_N = mu d and dx_T / dd = mu x_N.
  Eigen::VectorXd gradient = g;
  for (int k = 0; k < contact_count(); ++k) {
    if (!has_friction(k)) continue;
    const int at = row_begin[k];
    gradient[at] += friction[k] * y.segment<2>(at + 1).dot(g.segment<2>(at + 1));
    gradient.segment<2>(at + 1) *= friction[k] * y[at];
  }
  return gradient;
}

Eigen::VectorXd ConeProgram::to_polar(const Eigen::VectorXd& x, const Eigen::VectorXd& u,
                                      double floor, double longest) const {
  Eigen::VectorXd y(row_count());
  for (int k = 0; k < contact_count(); ++k) {
    const int at = row_begin[k];
    y[at] = std::max(floor, x[at]);
    if (!has_friction(k)) continue;
    // Where the impulse is zero it has no direction. Halfway to the disc's edge, against the
    // sliding, is what friction will most likely ask for.
    Eigen::Vector2d d = x.segment<2>(at + 1) / (friction[k] * y[at]);
    const Eigen::Vector2d sliding = u.segment<2>(at + 1);
    if (!(x[at] > 0.0) && sliding.norm() > 0.0) d = -0.5 * sliding.normalized();
    y.segment<2>(at + 1) = d * std::min(1.0, longest / std::max(longest, d.norm()));
  }
  return y;
}

void ConeProgram::project(Eigen::VectorXd& x) const {
  for (int k = 0; k < contact_count(); ++k)
    if (has_friction(k))
      x.segment<3>(row_begin[k]) = project_cone(x.segment<3>(row_begin[k]), friction[k]);
    else
      x[row_begin[k]] = std::max(0.0, x[row_begin[k]]);
}

/// q with s, and with what the symmetric part of W leaves out.
Eigen::VectorXd ConeProgram::linear_term(const Eigen::VectorXd& x) const {
  Eigen::VectorXd term = q + w_as_is * x - w * x;
  // scale_ is unit D by now, so that this is D s / unit: s is a velocity like q.
  for (int k = 0; k < contact_count(); ++k)
    term[row_begin[k]] += shift_[moving_.contact[k]] * scale_[row_begin[k]] / (unit_ * unit_);
  return term;
}

Solved ConeProgram::solve(const FrictionProblem& problem, Impulses start, const Budget& budget,
                          int patience,
                          const std::function<void(const ConeRequest&, RoundAnswer&)>& convex) {
  // A warm start says what s may be; a cold one has s = 0.
  shift_.reset(operator_);
  Eigen::VectorXd u;
  operator_.velocity(start, u);
  if (start.squaredNorm() > 0.0) shift_.follow(operator_, u);
  // A round: the last impulses give the linear term, `convex` solves with s held, and the
  // velocities of its answer say the next s.
  Impulses r;
  return solve_in_rounds(problem, moving_, std::move(start), budget, patience,
                         [&](const RoundRequest& request, RoundAnswer& answer) {
                           Eigen::VectorXd x = from_rows(request.last);
                           const Eigen::VectorXd term = linear_term(x);
                           project(x);
                           convex({term, x, budget.aim() / velocity_unit_, request.left}, answer);
                           // An empty answer tells the rounds that this one failed.
                           if (answer.x.size() != row_count() || !answer.x.allFinite()) {
                             answer.x.resize(0);
                             return;
                           }
                           answer.x = to_rows(answer.x);
                           moving_.scatter(problem, answer.x, r);
                           operator_.velocity(r, u);
                           shift_.improve(operator_, u);
                         });
}

}  // namespace ballast
