#include "problems/algebra/contact_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/algebra/delassus.hpp"
#include "problems/algebra/friction_cone.hpp"

namespace ballast {
namespace {

/// Rows of one contact as 3-vector, zero-padded: a one-row contact is a frictionless one without
/// tangential motion.
Eigen::Vector3d segment(const Eigen::VectorXd& x, int first, int rows) {
  return rows == 3 ? Eigen::Vector3d(x[first], x[first + 1], x[first + 2])
                   : Eigen::Vector3d(x[first], 0.0, 0.0);
}

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

// Smith 1961: with B = (W - mean I) / spread, spread^2 = |W - mean I|^2 / 6, the eigenvalues of B
// are 2 cos(...), the largest 1 + 2 s w where s^2 = (1 + det B / 2) / 2 and w in [1/2, 1/sqrt(3)]
// is the root of w^2 (3 + 2 s w) = 1. That equation is well conditioned for every s in [0, 1]: from
// a cubic fit (error 6e-5) two Newton steps reach rounding, without an arc cosine. Where the two
// largest eigenvalues coincide (s = 0) the determinant's own rounding leaves 1e-8, relative: enough
// for a scale.
double largest_eigenvalue(const Eigen::Matrix3d& block) {
  const double a = block(1, 0), b = block(2, 0), c = block(2, 1);
  const double off = a * a + b * b + c * c;
  if (off == 0.0) return block.diagonal().maxCoeff();
  const double mean = block.trace() * (1.0 / 3.0);
  const double x = block(0, 0) - mean, y = block(1, 1) - mean, z = block(2, 2) - mean;
  const double square = (x * x + y * y + z * z + 2.0 * off) * (1.0 / 6.0);
  const double spread = std::sqrt(square);
  const double determinant = x * (y * z - c * c) - a * (a * z - c * b) + b * (a * c - y * b);
  const double s = std::sqrt(std::clamp(0.5 + 0.25 * determinant / (square * spread), 0.0, 1.0));
  double w = 0.57729 + s * (-0.10927 + s * (0.04318 - 0.01123 * s));
  for (int step = 0; step < 2; ++step)
    w -= (w * w * (3.0 + 2.0 * s * w) - 1.0) / (6.0 * w * (1.0 + s * w));
  return mean + spread * (1.0 + 2.0 * s * w);
}

void ContactJudge::recompute_body_velocities(const DynamicsForm& dynamics,
                                             const std::vector<int>& row_begin, const Impulses& r) {
  factor_masses(dynamics, roots_);
  contact_to_body_impulse(dynamics, row_begin, r, hr_);
  v_ = hr_;
  for (int b = 0; b < dynamics.body_count(); ++b) {
    roots_[b].solve_lower(v_.data() + dynamics.dof_begin[b]);
    roots_[b].solve_upper(v_.data() + dynamics.dof_begin[b]);
  }
  v_ += dynamics.v_free;
}

void ContactJudge::recompute_contacts(const FrictionProblem& problem, int begin, int end) {
  delassus_diagonal(problem, roots_, begin, end, diagonal_);
  body_to_contact_velocity(problem.dynamics, problem.row_begin, problem.dynamics.v_free, begin, end,
                           q_);
  body_to_contact_velocity(problem.dynamics, problem.row_begin, v_, begin, end, u_);
}

ContactJudge::Share ContactJudge::judge_contacts(const FrictionProblem& problem, const Impulses& r,
                                                 int begin, int end) const {
  Share share;
  share.min_normal_velocity = std::numeric_limits<double>::infinity();
  for (int c = begin; c < end; ++c) {
    const int first = problem.row_begin[c], rows = problem.contact_rows(c);
    const double mu = problem.friction[c];
    const Eigen::Vector3d rc = segment(r, first, rows), uc = segment(u_, first, rows);
    const double lambda_max = largest_eigenvalue(diagonal_[c]);
    const Eigen::Vector3d modified = modified_velocity(uc, mu);
    const double impulse = rc.norm(), approach = std::max(0.0, -uc[0]);
    const double outside = (rc - project_cone(rc, mu)).norm(), work = std::abs(rc.dot(modified));
    double rho = 0.0;
    if (lambda_max > 0.0) {
      rho = 1.0 / lambda_max;
      const double value = scaled_natural_map(rc, uc, mu, lambda_max);
      share.scaled_square += value * value;
      ++share.counted;
      if (share.worst_contact < 0 || value > share.worst) {
        share.worst = value;
        share.worst_contact = c;
      }
      share.impulse_scale = std::max(share.impulse_scale, rho * segment(q_, first, rows).norm());
    } else {
      share.immovable_approach = std::max(share.immovable_approach, approach);
    }
    // The parts of the law, each as a velocity.
    const double against = impulse + rho * modified.norm();
    const double unbalanced = against > 0.0 ? work / against : 0.0;
    share.approach_square += approach * approach;
    share.cone_square += (lambda_max * outside) * (lambda_max * outside);
    share.complementarity_square += unbalanced * unbalanced;
    // The same in the file's units, and Siconos' measure.
    share.square += natural_map(rc, uc, mu, 1.0).squaredNorm();
    share.largest_impulse = std::max(share.largest_impulse, impulse);
    share.cone_violation = std::max(share.cone_violation, outside);
    share.min_normal_velocity = std::min(share.min_normal_velocity, uc[0]);
    share.complementarity = std::max(share.complementarity, work);
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
    diagonal_.resize(contacts);
    q_.resize(problem.row_count());
    u_.resize(problem.row_count());
  } else {
    delassus_diagonal(problem, roots_, diagonal_);
    free_contact_velocity(problem, q_);
    contact_velocity(problem, r, u_);
  }
  shares_.resize((contacts + share_contacts - 1) /
                 share_contacts);  // cut in the same places whoever works
  // Every share: for the dynamics form its rows of u and q, then its measures.
  run_parts(team_, static_cast<int>(shares_.size()), [&](int part) {
    const int begin = part * share_contacts, end = std::min(begin + share_contacts, contacts);
    if (problem.has_dynamics) recompute_contacts(problem, begin, end);
    shares_[part] = judge_contacts(problem, r, begin, end);
  });
  if (!r.allFinite() || !u_.allFinite()) return not_finite();

  ContactError error = gather(contacts);
  // Siconos' measure, the scale of velocities, the power.
  const double scale = std::max({q_.norm(), r.norm(), u_.norm()});
  if (scale > std::numeric_limits<double>::epsilon()) error.fclib /= scale;
  error.velocity_scale = q_.norm() / std::sqrt(static_cast<double>(q_.size()));
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
