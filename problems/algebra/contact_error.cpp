#include "problems/algebra/contact_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/algebra/contact_rows.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/judge_block.hpp"

namespace ballast {
namespace {

ContactError not_finite() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ContactError error;
  error.natural_map_rms = error.natural_map_max = error.fclib = infinity;
  error.cone_violation = error.complementarity = error.power = infinity;
  error.approach_rms = error.cone_rms = error.complementarity_rms = infinity;
  error.immovable_approach = error.growth = infinity;
  error.min_normal_velocity = -infinity;
  error.momentum_residual = infinity;
  error.finite = false;
  return error;
}

/// max |M (v - v_free) - H^T r| with p = H^T r.
double momentum_residual(const DynamicsForm& dynamics, const Eigen::VectorXd& v,
                         const Eigen::VectorXd& p) {
  double worst = 0.0;
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const int dofs = dynamics.body_dofs(b), first = dynamics.dof_begin[b];
    const double* block = dynamics.mass.data() + dynamics.mass_begin[b];
    for (int i = 0; i < dofs; ++i) {
      double sum = -p[first + i];
      for (int k = 0; k < dofs; ++k)
        sum += block[k * dofs + i] * (v[first + k] - dynamics.v_free[first + k]);
      worst = std::max(worst, std::abs(sum));
    }
  }
  return worst;
}

}  // namespace

double largest_eigenvalue(const Eigen::Matrix3d& block) {
  return largest_eigenvalue(block(0, 0), block(1, 0), block(2, 0), block(1, 1), block(2, 1),
                            block(2, 2));
}

void ContactJudge::recompute_body_velocities(const DynamicsForm& dynamics,
                                             const std::vector<int>& row_begin, const Impulses& r) {
  if (!masses_.are_of(dynamics)) {
    masses_ = {};  // factor_masses may throw
    factor_masses(dynamics, roots_);
    masses_.keep(dynamics);
  }
  contact_to_body_impulse(dynamics, row_begin, r, hr_);
  v_ = hr_;
  for (int b = 0; b < dynamics.body_count(); ++b) {
    roots_[b].solve_lower(v_.data() + dynamics.dof_begin[b]);
    roots_[b].solve_upper(v_.data() + dynamics.dof_begin[b]);
  }
  v_ += dynamics.v_free;
}

/// Contacts begin <= c < end as the first places of a block, without W_cc.
void ContactJudge::lay_out(const FrictionProblem& problem, const Impulses& r, int begin, int end,
                           JudgeBlock& block) const {
  for (int c = begin; c < end; ++c) {
    const int k = c - begin, first = problem.row_begin[c], rows = problem.contact_rows(c);
    for (int i = 0; i < 3; ++i) {
      block.r[i][k] = i < rows ? r[first + i] : 0.0;
      block.u[i][k] = i < rows ? u_[first + i] : 0.0;
      block.q[i][k] = i < rows ? q_[first + i] : 0.0;
    }
    block.mu[k] = problem.friction[c];
  }
}

ContactJudge::Share ContactJudge::judge_contacts(const FrictionProblem& problem, const Impulses& r,
                                                 int begin, int end) {
  JudgeBlock block;
  if (end - begin < JudgeBlock::size) block = {};
  if (problem.has_dynamics)
    look_at_rows(problem, roots_, v_, begin, end, q_, u_, block);
  else
    for (int c = begin; c < end; ++c) block.take(c - begin, diagonal_[c]);
  lay_out(problem, r, begin, end, block);
  measure(block);
  Share share;
  share.min_normal_velocity = std::numeric_limits<double>::infinity();
  for (int k = 0; k < end - begin; ++k) {
    const double value = block.scaled_map[k], approach = block.approach[k];
    const double outside = block.lambda[k] * block.outside[k], unbalanced = block.unbalanced[k];
    if (block.lambda[k] > 0.0) {
      share.scaled_square += value * value;
      ++share.counted;
      if (share.worst_contact < 0 || value > share.worst) {
        share.worst = value;
        share.worst_contact = begin + k;
      }
      share.impulse_scale = std::max(share.impulse_scale, block.needed[k]);
    } else {
      share.immovable_approach = std::max(share.immovable_approach, approach);
    }
    // The parts of the law, each as a velocity.
    share.approach_square += approach * approach;
    share.cone_square += outside * outside;
    share.complementarity_square += unbalanced * unbalanced;
    // The same in the file's units, and Siconos' measure.
    share.square += block.map_square[k];
    share.largest_impulse = std::max(share.largest_impulse, block.impulse[k]);
    share.cone_violation = std::max(share.cone_violation, block.outside[k]);
    share.min_normal_velocity = std::min(share.min_normal_velocity, block.u[0][k]);
    share.complementarity = std::max(share.complementarity, block.work[k]);
  }
  return share;
}

/// The shares together, in their order. `fclib` is not yet divided by its scale.
ContactError ContactJudge::gather(int contacts) const {
  ContactError error;
  double sum = 0.0, unscaled_sum = 0.0, approach = 0.0, cone = 0.0, complementarity = 0.0;
  double largest_impulse = 0.0, impulse_scale = 0.0;
  int counted = 0;
  error.min_normal_velocity = std::numeric_limits<double>::infinity();
  for (const Share& share : shares_) {
    sum += share.scaled_square;
    unscaled_sum += share.square;
    counted += share.counted;
    approach += share.approach_square;
    cone += share.cone_square;
    complementarity += share.complementarity_square;
    if (share.worst_contact >= 0 &&
        (error.worst_contact < 0 || share.worst > error.natural_map_max)) {
      error.natural_map_max = share.worst;
      error.worst_contact = share.worst_contact;
    }
    error.cone_violation = std::max(error.cone_violation, share.cone_violation);
    error.min_normal_velocity = std::min(error.min_normal_velocity, share.min_normal_velocity);
    error.complementarity = std::max(error.complementarity, share.complementarity);
    error.immovable_approach = std::max(error.immovable_approach, share.immovable_approach);
    largest_impulse = std::max(largest_impulse, share.largest_impulse);
    impulse_scale = std::max(impulse_scale, share.impulse_scale);
  }
  error.natural_map_rms = counted > 0 ? std::sqrt(sum / counted) : 0.0;
  error.fclib = std::sqrt(unscaled_sum);
  error.approach_rms = std::sqrt(approach / contacts);
  error.cone_rms = std::sqrt(cone / contacts);
  error.complementarity_rms = std::sqrt(complementarity / contacts);
  error.growth = impulse_scale > 0.0 ? largest_impulse / impulse_scale : 0.0;
  return error;
}

ContactError ContactJudge::judge(const FrictionProblem& problem, const Impulses& r) {
  if (r.size() != problem.row_count())
    throw InvalidProblem("impulses has " + std::to_string(r.size()) +
                         " entries, the contacts have " + std::to_string(problem.row_count()) +
                         " rows");
  const int contacts = problem.contact_count();
  if (problem.has_dynamics) recompute_body_velocities(problem.dynamics, problem.row_begin, r);
  // Workspaces, and for a stored W the whole of u and q.
  if (contacts == 0) return {};
  if (problem.has_dynamics) {
    q_.resize(problem.row_count());
    u_.resize(problem.row_count());
  } else {
    delassus_diagonal(problem, roots_, diagonal_);
    free_contact_velocity(problem, q_);
    contact_velocity(problem, r, u_);
  }
  shares_.resize((contacts + share_contacts - 1) /
                 share_contacts);  // cut in the same places whoever works
  // Every share: for the dynamics form its rows of u and q and its W_cc, then its measures.
  run_parts(team_, static_cast<int>(shares_.size()), [&](int part) {
    const int begin = part * share_contacts, end = std::min(begin + share_contacts, contacts);
    shares_[part] = judge_contacts(problem, r, begin, end);
  });
  if (!r.allFinite() || !u_.allFinite()) return not_finite();

  ContactError error = gather(contacts);
  // Siconos' measure, the scale of velocities, the power.
  const double free_norm = q_.norm(), scale = std::max({free_norm, r.norm(), u_.norm()});
  if (scale > std::numeric_limits<double>::epsilon()) error.fclib /= scale;
  error.velocity_scale = free_norm / std::sqrt(static_cast<double>(q_.size()));
  error.power = r.dot(u_);
  if (problem.has_dynamics) {
    error.power -= r.dot(problem.dynamics.bias);
    error.momentum_residual = momentum_residual(problem.dynamics, v_, hr_);
  }
  // Sums of squares that overflow, or a scale that does.
  if (!std::isfinite(error.natural_map_rms + error.approach_rms + error.cone_rms + scale))
    return not_finite();
  return error;
}

ContactError contact_error(const FrictionProblem& problem, const Impulses& r) {
  return ContactJudge().judge(problem, r);
}

}  // namespace ballast
