#include "problems/algebra/contact_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "platform/for_each_cpu.hpp"
#include "problems/algebra/delassus.hpp"

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

/// The three rows of a column of H side by side; the fourth place holds anything.
using Rows = double __attribute__((vector_size(32)));

/// What one contact adds up, column by column of its two blocks.
struct RowSums {
  Rows q, u;
  Rows squares = {};  // nn, tt, ss
  Rows mixed = {};    // tn, st, sn
};

/// Three rows on two rigid bodies whose mass is diagonal. The last contact's rows end with H, and a
/// column of four would not.
bool is_usual(const FrictionProblem& problem, const std::vector<MassRoot>& roots, int c) {
  const DynamicsForm& dynamics = problem.dynamics;
  const auto is_grain = [&](int body) {
    return body < 0 || (roots[body].diagonal && roots[body].dofs == MassRoot::max_dofs);
  };
  return problem.contact_rows(c) == 3 && is_grain(dynamics.body_a[c]) &&
         is_grain(dynamics.body_b[c]) && dynamics.h_begin[c + 1] < dynamics.h_begin.back();
}

/// In every row the operations of one contact's functions in their order. Always inline: a vector
/// wider than the processor's is then no argument of a call.
[[gnu::always_inline]] inline void add_side(const double* block, const double* v_free,
                                            const double* v, const double* inverse, RowSums& sums) {
#pragma GCC unroll 6
  for (int k = 0; k < MassRoot::max_dofs; ++k) {
    Rows column;
    std::memcpy(&column, block + 3 * k, sizeof column);
    sums.q += column * v_free[k];
    sums.u += column * v[k];
    // G = H L^-T, and W_cc = G G^T: each row with itself, and with the row after it.
    const Rows g = column * inverse[k];
    sums.squares += g * g;
    sums.mixed += g * __builtin_shufflevector(g, g, 1, 2, 0, 3);
  }
}

BALLAST_FOR_EACH_CPU void look_at_usual(const FrictionProblem& problem, const MassRoot* roots,
                                        const double* v, int c, double* q, double* u,
                                        JudgeBlock& to, int k) {
  const DynamicsForm& dynamics = problem.dynamics;
  const double* bias = dynamics.bias.data() + problem.row_begin[c];
  RowSums sums;
  sums.q = sums.u = Rows{bias[0], bias[1], bias[2], 0.0};
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
    if (body < 0) continue;
    const int first = dynamics.dof_begin[body];
    add_side(block, dynamics.v_free.data() + first, v + first, roots[body].inverse, sums);
    block += 3 * MassRoot::max_dofs;
  }
  for (int i = 0; i < 3; ++i) {
    q[i] = sums.q[i];
    u[i] = sums.u[i];
  }
  to.nn[k] = sums.squares[0];
  to.tt[k] = sums.squares[1];
  to.ss[k] = sums.squares[2];
  to.tn[k] = sums.mixed[0];
  to.st[k] = sums.mixed[1];
  to.sn[k] = sums.mixed[2];
}

/// Of contacts begin <= c < end: their rows of q = bias + H v_free and u = bias + H v [m/s], which
/// have their sizes, and W_cc in the first places of the block, in one pass over the rows H.
/// `roots`: of the masses. The same bits as by body_to_contact_velocity() and delassus_block().
void look_at_rows(const FrictionProblem& problem, const std::vector<MassRoot>& roots,
                  const Eigen::VectorXd& v, int begin, int end, Eigen::VectorXd& q,
                  Eigen::VectorXd& u, JudgeBlock& block) {
  const DynamicsForm& dynamics = problem.dynamics;
  for (int c = begin; c < end; ++c) {
    const int first = problem.row_begin[c];
    if (is_usual(problem, roots, c)) {
      look_at_usual(problem, roots.data(), v.data(), c, q.data() + first, u.data() + first, block,
                    c - begin);
      continue;
    }
    body_to_contact_velocity(dynamics, problem.row_begin, dynamics.v_free, c, c + 1, q);
    body_to_contact_velocity(dynamics, problem.row_begin, v, c, c + 1, u);
    block.take(c - begin, delassus_block(problem, roots, c));
  }
}

}  // namespace

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

std::vector<double> errors_by_contact(const FrictionProblem& problem, const Impulses& r) {
  Eigen::VectorXd u;
  contact_velocity(problem, r, u);
  std::vector<Eigen::Matrix3d> diagonal;
  delassus_diagonal(problem, diagonal);
  std::vector<double> errors;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const double lambda_max = largest_eigenvalue(diagonal[c]);
    const double error = lambda_max > 0.0
                             ? ContactJudge::scaled_natural_map(rows_of_contact(problem, r, c),
                                                                rows_of_contact(problem, u, c),
                                                                problem.friction[c], lambda_max)
                             : 0.0;
    errors.push_back(std::isfinite(error) ? error : std::numeric_limits<double>::infinity());
  }
  return errors;
}

namespace {

double part_of(double difference, double whole) {
  if (difference == 0.0) return 0.0;
  return std::abs(difference / whole);
}

/// What bodies and the wall say: dynamics form only.
void compare_bodies(const FrictionProblem& problem, const Impulses& answer,
                    const Impulses& solution, AnswerDistance& distance) {
  const DynamicsForm& dynamics = problem.dynamics;
  Eigen::VectorXd velocity, exact, impulse, exact_impulse;
  body_velocity(dynamics, problem.row_begin, answer, velocity);
  body_velocity(dynamics, problem.row_begin, solution, exact);
  contact_to_body_impulse(dynamics, problem.row_begin, answer, impulse);
  contact_to_body_impulse(dynamics, problem.row_begin, solution, exact_impulse);
  // dv . M dv = dv . H^T dr
  const double energy = (velocity - exact).dot(impulse - exact_impulse);
  double mass = 0.0;
  for (int b = 0; b < dynamics.body_count(); ++b) mass += dynamics.mass[dynamics.mass_begin[b]];
  distance.velocity = mass > 0.0 ? std::sqrt(std::max(0.0, energy) / mass) : 0.0;
  const int wall = driven_wall(problem);
  if (wall < 0) return;
  const int unknown = dynamics.dof_begin[wall];
  distance.wall_force = part_of(impulse[unknown] - exact_impulse[unknown], exact_impulse[unknown]);
}

/// What r - rho u says, rho = 1 / `lambda_max` of W_cc: open where its normal part is not positive,
/// stick inside Coulomb's cone. The two do not meet where one of r and u is zero to rounding.
ContactStatus contact_status(const Eigen::Vector3d& r, const Eigen::Vector3d& u, double mu,
                             double lambda_max) {
  const Eigen::Vector3d z = lambda_max * r - u;
  if (!(z[0] > 0.0)) return ContactStatus::open;
  return tangential_norm(z) <= mu * z[0] ? ContactStatus::stick : ContactStatus::slip;
}

}  // namespace

int driven_wall(const FrictionProblem& problem) {
  if (!problem.has_dynamics) return -1;
  for (int b = 0; b < problem.dynamics.body_count(); ++b)
    if (problem.dynamics.body_dofs(b) == 1) return b;
  return -1;
}

AnswerDistance answer_distance(const FrictionProblem& problem, const Impulses& answer,
                               const Impulses& solution, double velocity_scale) {
  if (solution.size() == 0 && problem.row_count() > 0) return {};
  Eigen::VectorXd u, exact, q;
  contact_velocity(problem, answer, u);
  contact_velocity(problem, solution, exact);
  free_contact_velocity(problem, q);
  AnswerDistance distance;
  const int contacts = problem.contact_count();
  distance.contact_velocity = (u - exact).norm() / std::sqrt(std::max(1, contacts));
  distance.body_impulse =
      std::sqrt(part_of((answer - solution).dot(u - exact), solution.dot(exact - q)));
  if (problem.has_dynamics) compare_bodies(problem, answer, solution, distance);
  distance.statuses = 0;
  std::vector<Eigen::Matrix3d> blocks;
  delassus_diagonal(problem, blocks);
  for (int c = 0; c < contacts; ++c) {
    const double lambda_max = largest_eigenvalue(blocks[static_cast<size_t>(c)]);
    const auto status = [&](const Impulses& r, const Eigen::VectorXd& at) {
      return contact_status(rows_of_contact(problem, r, c), rows_of_contact(problem, at, c),
                            problem.friction[c], lambda_max);
    };
    if (status(answer, u) != status(solution, exact)) ++distance.statuses;
  }
  distance.velocity /= velocity_scale;
  distance.contact_velocity /= velocity_scale;
  return distance;
}

}  // namespace ballast
