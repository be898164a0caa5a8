// Compiled with -fno-trapping-math (problems/CMakeLists.txt): both sides of every choice are
// computed, and the loops become vector instructions. No bit depends on it.

#include "problems/algebra/contact_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "platform/for_each_cpu.hpp"
#include "problems/algebra/delassus.hpp"

namespace ballast {

/// The judge's numbers for up to `size` contacts side by side, number k of every array for contact
/// k. A block is a share of the work and stays in the first cache between the passes.
struct JudgeBlock {
  static constexpr int size = 64;
  /// The number of places computed for so many contacts: a multiple of eight.
  static int places(int contacts) { return (contacts + 7) / 8 * 8; }

  // Input. Rows that a contact lacks and places without a contact hold zeros.
  alignas(64) double r[3][size];        ///< [N s]
  double u[3][size], q[3][size];        ///< [m/s]
  double nn[size], tn[size], sn[size];  ///< W_cc [1/kg]
  double tt[size], st[size], ss[size];
  double mu[size];

  /// Stores the lower triangle of W_cc in place k.
  void take(int k, const Eigen::Matrix3d& w) {
    nn[k] = w(0, 0);
    tn[k] = w(1, 0);
    sn[k] = w(2, 0);
    tt[k] = w(1, 1);
    st[k] = w(2, 1);
    ss[k] = w(2, 2);
  }
  /// Fills place k with zeros.
  void clear(int k) {
    for (int i = 0; i < 3; ++i) r[i][k] = u[i][k] = q[i][k] = 0.0;
    mu[k] = nn[k] = tn[k] = sn[k] = tt[k] = st[k] = ss[k] = 0.0;
  }

  // Output.
  double lambda[size];      ///< largest eigenvalue of W_cc [1/kg]
  double scaled_map[size];  ///< scaled natural map [m/s]; meaningless where lambda = 0
  double map_square[size];  ///< square of the natural map with rho = 1
  double impulse[size];     ///< |r| [N s]
  double needed[size];      ///< |q| / lambda [N s]; 0 where lambda = 0
  double approach[size];    ///< max(0, -u_N) [m/s]
  double outside[size];     ///< |r - P_K(r)| [N s]
  double work[size];        ///< |r . (u + mu|u_T|n)| [J]
  double unbalanced[size];  ///< the same as a velocity [m/s]
  double free_square[size], impulse_square[size], velocity_square[size];  ///< |q|^2, |r|^2, |u|^2
  double power[size];                                                     ///< r . u [J]
};

namespace {

// The measures of a block. Operations and their order are those of the functions for one contact
// (friction_cone.hpp), so that the bits are the same.

struct Triple {
  double n, t, s;
};
BALLAST_IN_LOOP double dot(const Triple& x, const Triple& y) {
  return x.n * y.n + x.t * y.t + x.s * y.s;
}
BALLAST_IN_LOOP double norm(const Triple& x) { return std::sqrt(dot(x, x)); }
BALLAST_IN_LOOP double tangential(const Triple& x) { return std::sqrt(x.t * x.t + x.s * x.s); }

/// x - P_K(y)
BALLAST_IN_LOOP Triple less_projected(const Triple& x, const Triple& y, double mu) {
  const double t = tangential(y);
  const bool polar = mu * t <= -y.n, inside = t <= mu * y.n;
  const double n = (mu * t + y.n) / (1.0 + mu * mu);
  const double scale = mu * n / t;
  const auto projected = [=](double own, double side) __attribute__((always_inline)) {
    return polar ? 0.0 : inside ? own : side;
  };
  return {x.n - projected(y.n, n), x.t - projected(y.t, scale * y.t),
          x.s - projected(y.s, scale * y.s)};
}

BALLAST_IN_LOOP Triple natural_map_of_modified(const Triple& r, const Triple& modified, double mu,
                                               double rho) {
  const Triple x{r.n - rho * modified.n, r.t - rho * modified.t, r.s - rho * modified.s};
  return less_projected(r, x, mu);
}

BALLAST_IN_LOOP double eigenvalue(double nn, double tn, double sn, double tt, double st,
                                  double ss) {
  const double off = tn * tn + sn * sn + st * st;
  const double mean = (nn + (tt + ss)) * (1.0 / 3.0);
  const double x = nn - mean, y = tt - mean, z = ss - mean;
  const double square = (x * x + y * y + z * z + 2.0 * off) * (1.0 / 6.0);
  const double spread = std::sqrt(square);
  const double determinant =
      x * (y * z - st * st) - tn * (tn * z - st * sn) + sn * (tn * st - y * sn);
  const double cosine = 0.5 + 0.25 * determinant / (square * spread);
  const double not_below = cosine < 0.0 ? 0.0 : cosine;
  const double s = std::sqrt(not_below > 1.0 ? 1.0 : not_below);
  double w = 0.57729 + s * (-0.10927 + s * (0.04318 - 0.01123 * s));
  for (int step = 0; step < 2; ++step)
    w -= (w * w * (3.0 + 2.0 * s * w) - 1.0) / (6.0 * w * (1.0 + s * w));
  const double full = mean + spread * (1.0 + 2.0 * s * w);
  // A diagonal block, or nearly one: the fractions above are 0 / 0 where its entries are equal.
  const double two = nn < tt ? tt : nn, three = two < ss ? ss : two;
  return off == 0.0 || square * spread == 0.0 ? three : full;
}

BALLAST_FOR_EACH_CPU void find_scales(JudgeBlock& b, int places) {
  for (int k = 0; k < places; ++k)
    b.lambda[k] = eigenvalue(b.nn[k], b.tn[k], b.sn[k], b.tt[k], b.st[k], b.ss[k]);
}

BALLAST_FOR_EACH_CPU void find_measures(JudgeBlock& b, int places) {
  for (int k = 0; k < places; ++k) {
    const auto triple = [k](const auto& x) { return Triple{x[0][k], x[1][k], x[2][k]}; };
    const Triple r = triple(b.r), u = triple(b.u), q = triple(b.q);
    const double mu = b.mu[k], lambda = b.lambda[k];
    const double inverse = 1.0 / lambda, rho = lambda > 0.0 ? inverse : 0.0;
    const Triple modified{u.n + mu * tangential(u), u.t, u.s};
    const double impulse = norm(r), work = std::abs(dot(r, modified));
    // The natural map, scaled and with rho = 1; the size of impulses.
    const Triple map = natural_map_of_modified(r, modified, mu, 1.0);
    b.scaled_map[k] = norm(natural_map_of_modified(r, modified, mu, inverse)) * lambda;
    b.map_square[k] = dot(map, map);
    b.impulse[k] = impulse;
    b.needed[k] = rho * norm(q);
    b.free_square[k] = dot(q, q);
    b.impulse_square[k] = dot(r, r);
    b.velocity_square[k] = dot(u, u);
    b.power[k] = dot(r, u);
    // The parts of the law.
    b.approach[k] = 0.0 < -u.n ? -u.n : 0.0;
    b.outside[k] = norm(less_projected(r, r, mu));
    b.work[k] = work;
    const double against = impulse + rho * norm(modified), ratio = work / against;
    b.unbalanced[k] = against > 0.0 ? ratio : 0.0;
  }
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double rounding = std::numeric_limits<double>::epsilon();

/// Measures that are sums of squares until their roots are taken, and those that are largest
/// values.
constexpr double ContactError::*squares[] = {&ContactError::natural_map_rms, &ContactError::fclib,
                                             &ContactError::approach_rms, &ContactError::cone_rms,
                                             &ContactError::complementarity_rms};
constexpr double ContactError::*largest[] = {&ContactError::cone_violation,
                                             &ContactError::complementarity,
                                             &ContactError::immovable_approach};

ContactError infinite_error() {
  ContactError error;
  for (const auto measure : squares) error.*measure = infinity;
  for (const auto measure : largest) error.*measure = infinity;
  error.natural_map_max = error.growth = error.power = infinity;
  error.min_normal_velocity = -infinity;
  error.finite = false;
  return error;
}

/// The largest |M v_free| of a body that has an impulse, with p = H^T r.
double stopping_impulse(const DynamicsForm& dynamics, const Eigen::VectorXd& p) {
  double most = 0.0;
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const bool is_free = p.segment(dynamics.dof_begin[b], dynamics.body_dofs(b)).isZero(0.0);
    if (!is_free) most = std::max(most, dynamics.momentum(b));
  }
  return most;
}

/// The three rows of a column of H side by side; the fourth place is arbitrary.
using Rows = double __attribute__((vector_size(32)));

/// The sums of one contact over the columns of its two blocks.
struct RowSums {
  Rows q, u;
  Rows squares = {};  // nn, tt, ss
  Rows mixed = {};    // tn, st, sn
};

/// Returns whether the contact has three rows and rigid bodies of diagonal mass. False for the last
/// one: four entries read from its last column of three would reach beyond H.
bool is_vectorisable(const FrictionProblem& problem, const std::vector<MassRoot>& roots, int c) {
  const DynamicsForm& dynamics = problem.dynamics;
  const auto is_grain = [&](int body) {
    return body < 0 || (roots[body].diagonal && roots[body].dofs == MassRoot::max_dofs);
  };
  return problem.contact_rows(c) == 3 && is_grain(dynamics.body_a[c]) &&
         is_grain(dynamics.body_b[c]) && dynamics.h_begin[c + 1] < dynamics.h_begin.back();
}

/// Operations and their order are in every row those of the functions for one contact. Always
/// inlined, so that a vector wider than the processor's is never the argument of a call.
[[gnu::always_inline]] inline void add_side(const double* block, const double* v_free,
                                            const double* v, const double* inverse, RowSums& sums) {
#pragma GCC unroll 6
  for (int k = 0; k < MassRoot::max_dofs; ++k) {
    Rows column;
    std::memcpy(&column, block + 3 * k, sizeof column);
    sums.q += column * v_free[k];
    sums.u += column * v[k];
    // G = H L^-T, and W_cc = G G^T: the products of each row with itself and with the next.
    const Rows g = column * inverse[k];
    sums.squares += g * g;
    sums.mixed += g * __builtin_shufflevector(g, g, 1, 2, 0, 3);
  }
}

BALLAST_FOR_EACH_CPU void look_at_usual(const FrictionProblem& problem, const MassRoot* roots,
                                        const double* v, int c, JudgeBlock& to, int k) {
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
    to.q[i][k] = sums.q[i];
    to.u[i][k] = sums.u[i];
  }
  to.nn[k] = sums.squares[0];
  to.tt[k] = sums.squares[1];
  to.ss[k] = sums.squares[2];
  to.tn[k] = sums.mixed[0];
  to.st[k] = sums.mixed[1];
  to.sn[k] = sums.mixed[2];
}

/// Copies a contact's rows of a vector over all rows to place k; rows that it lacks are zero.
void take_rows(const FrictionProblem& problem, const Eigen::VectorXd& x, int c, int k,
               double (&to)[3][JudgeBlock::size]) {
  const Eigen::Vector3d rows = rows_of_contact(problem, x, c);
  for (int i = 0; i < 3; ++i) to[i][k] = rows[i];
}

}  // namespace

double largest_eigenvalue(const Eigen::Matrix3d& w) {
  return eigenvalue(w(0, 0), w(1, 0), w(2, 0), w(1, 1), w(2, 1), w(2, 2));
}

void ContactJudge::recompute_body_velocities(const FrictionProblem& problem, const Impulses& r,
                                             bool masses_are_known) {
  const DynamicsForm& dynamics = problem.dynamics;
  if (!masses_are_known && !masses_.has_masses_of(dynamics)) masses_.keep(dynamics);
  const int bodies = dynamics.body_count();
  hr_.resize(dynamics.dof_count());
  v_.resize(hr_.size());
  // Each thread sums the impulses on a share of the bodies, in the order of the contacts.
  run_ranges(team_, bodies, /*together=*/1 + bodies / size_of(team_), [&](int begin, int end) {
    contact_to_body_impulse(dynamics, problem.row_begin, r, begin, end, hr_);
    // v = v_free + M^-1 H^T r
    for (int b = begin; b < end; ++b) {
      const auto rows = Eigen::seqN(dynamics.dof_begin[b], dynamics.body_dofs(b));
      v_(rows) = hr_(rows);
      masses_.roots()[b].solve(v_.data() + dynamics.dof_begin[b]);
      v_(rows) += dynamics.v_free(rows);
    }
  });
}

/// Writes a contact's rows of q = bias + H v_free and u = bias + H v [m/s] and its W_cc to place k.
/// For rigid bodies it does so in one pass over the rows of H, with the same bits.
void ContactJudge::look_at(const FrictionProblem& problem, int c, int k, JudgeBlock& block) {
  const DynamicsForm& dynamics = problem.dynamics;
  const std::vector<MassRoot>& roots = masses_.roots();
  if (problem.has_dynamics && is_vectorisable(problem, roots, c))
    return look_at_usual(problem, roots.data(), v_.data(), c, block, k);
  if (problem.has_dynamics) {
    body_to_contact_velocity(dynamics, problem.row_begin, dynamics.v_free, c, c + 1, q_);
    body_to_contact_velocity(dynamics, problem.row_begin, v_, c, c + 1, u_);
  }
  take_rows(problem, q_, c, k, block.q);
  take_rows(problem, u_, c, k, block.u);
  block.take(k, problem.has_dynamics ? delassus_block(problem, roots, c) : diagonal_[c]);
}

ContactJudge::Share ContactJudge::judge_contacts(const FrictionProblem& problem, const Impulses& r,
                                                 int begin, int end) {
  JudgeBlock block;
  const int contacts = end - begin, places = JudgeBlock::places(contacts);
  for (int k = contacts; k < places; ++k) block.clear(k);
  for (int c = begin; c < end; ++c) {
    const int k = c - begin;
    take_rows(problem, r, c, k, block.r);
    block.mu[k] = problem.friction[c];
    look_at(problem, c, k, block);
  }
  find_scales(block, places);
  find_measures(block, places);
  Share share;
  share.min_normal_velocity = infinity;
  for (int k = 0; k < contacts; ++k) {
    const double value = block.scaled_map[k], approach = block.approach[k];
    const double outside = block.lambda[k] * block.outside[k], unbalanced = block.unbalanced[k];
    if (block.lambda[k] > 0.0) {
      share.natural_map_rms += value * value;
      ++share.counted;
      if (share.worst_contact < 0 || value > share.natural_map_max) {
        share.natural_map_max = value;
        share.worst_contact = begin + k;
      }
      share.impulse_scale = std::max(share.impulse_scale, block.needed[k]);
    } else {
      share.immovable_approach = std::max(share.immovable_approach, approach);
    }
    // The parts of the law, each as a velocity.
    share.approach_rms += approach * approach;
    share.cone_rms += outside * outside;
    share.complementarity_rms += unbalanced * unbalanced;
    // Siconos' measure, and the parts of the law in their own units.
    share.fclib += block.map_square[k];
    share.free_square += block.free_square[k];
    share.impulse_square += block.impulse_square[k];
    share.velocity_square += block.velocity_square[k];
    share.power += block.power[k];
    share.largest_impulse = std::max(share.largest_impulse, block.impulse[k]);
    share.cone_violation = std::max(share.cone_violation, block.outside[k]);
    share.min_normal_velocity = std::min(share.min_normal_velocity, block.u[0][k]);
    share.complementarity = std::max(share.complementarity, block.work[k]);
  }
  return share;
}

/// Combines the shares in their order. `fclib` is not yet divided by its scale.
ContactJudge::Share ContactJudge::gather(int contacts) const {
  Share all;
  all.min_normal_velocity = infinity;
  for (const Share& share : shares_) {
    for (const auto sum : squares) all.*sum += share.*sum;
    for (const auto most : largest) all.*most = std::max(all.*most, share.*most);
    for (const auto sum : {&Share::free_square, &Share::impulse_square, &Share::velocity_square})
      all.*sum += share.*sum;
    all.power += share.power;
    all.counted += share.counted;
    if (share.worst_contact >= 0 &&
        (all.worst_contact < 0 || share.natural_map_max > all.natural_map_max)) {
      all.natural_map_max = share.natural_map_max;
      all.worst_contact = share.worst_contact;
    }
    all.min_normal_velocity = std::min(all.min_normal_velocity, share.min_normal_velocity);
    all.largest_impulse = std::max(all.largest_impulse, share.largest_impulse);
    all.impulse_scale = std::max(all.impulse_scale, share.impulse_scale);
  }
  all.natural_map_rms = all.counted > 0 ? std::sqrt(all.natural_map_rms / all.counted) : 0.0;
  all.fclib = std::sqrt(all.fclib);
  for (double* mean : {&all.approach_rms, &all.cone_rms, &all.complementarity_rms})
    *mean = std::sqrt(*mean / contacts);
  return all;
}

ContactError ContactJudge::judge(const FrictionProblem& problem, const Impulses& r,
                                 bool masses_are_known) {
  require_rows(r, problem.row_count());
  const int contacts = problem.contact_count();
  if (problem.has_dynamics) recompute_body_velocities(problem, r, masses_are_known);
  if (contacts == 0) return {};
  // A stored W needs all of u and q. Otherwise they hold the rows of contacts that are not usual.
  if (problem.has_dynamics) {
    q_.resize(problem.row_count());
    u_.resize(problem.row_count());
  } else {
    delassus_diagonal(problem, diagonal_);
    free_contact_velocity(problem, q_);
    contact_velocity(problem, r, u_);
  }
  // The work is cut in the same places for any number of threads.
  shares_.resize((contacts + JudgeBlock::size - 1) / JudgeBlock::size);
  double power = 0.0;
  run_ranges(
      team_, contacts, JudgeBlock::size,
      [&](int begin, int end) {
        shares_[begin / JudgeBlock::size] = judge_contacts(problem, r, begin, end);
      },
      [&] {
        if (problem.has_dynamics) power = hr_.dot(v_);  // r . (u - bias) = r . H v
      });
  Share error = gather(contacts);
  if (problem.has_dynamics) error.power = power;
  constexpr double much = 1e6;  // only beyond this growth do momenta matter
  double needed = error.impulse_scale;
  if (problem.has_dynamics && error.largest_impulse > much * needed)
    needed = std::max(needed, stopping_impulse(problem.dynamics, hr_));
  error.growth = needed > 0.0 ? error.largest_impulse / needed : 0.0;
  // Siconos' measure and the scale of velocities.
  const double free_norm = std::sqrt(error.free_square),
               impulse_norm = std::sqrt(error.impulse_square),
               velocity_norm = std::sqrt(error.velocity_square);
  const double scale = std::max({free_norm, impulse_norm, velocity_norm});
  if (scale > rounding) error.fclib /= scale;
  error.velocity_scale = free_norm / std::sqrt(static_cast<double>(problem.row_count()));
  // Numbers that are not finite, or sums of squares that overflow.
  if (!std::isfinite(error.natural_map_rms + error.approach_rms + error.cone_rms + free_norm +
                     impulse_norm + velocity_norm))
    return infinite_error();
  return error;
}

double ContactJudge::fclib(const FrictionProblem& problem, const Impulses& r, double& free_norm) {
  require_rows(r, problem.row_count());
  const bool is_first = free_norm < 0.0, is_free = r.isZero(0.0);
  if (is_first || is_free) {
    free_contact_velocity(problem, u_);
    free_norm = u_.norm();
  }
  if (problem.has_dynamics && !is_free) {
    recompute_body_velocities(problem, r, /*masses_are_known=*/false);
    body_to_contact_velocity(problem.dynamics, problem.row_begin, v_, u_);
  } else if (!is_free) {
    contact_velocity(problem, r, u_);
  }
  double squares = 0.0;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const auto triple = [&](const Eigen::VectorXd& x) {
      const Eigen::Vector3d rows = rows_of_contact(problem, x, c);
      return Triple{rows[0], rows[1], rows[2]};
    };
    const Triple u = triple(u_), modified{u.n + problem.friction[c] * tangential(u), u.t, u.s};
    const Triple map = natural_map_of_modified(triple(r), modified, problem.friction[c], 1.0);
    squares += dot(map, map);
  }
  const double scale = std::max({free_norm, r.norm(), u_.norm()});
  const double measure = std::sqrt(squares) / (scale > rounding ? scale : 1.0);
  return std::isfinite(measure) ? measure : infinity;
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
    double& error = errors.emplace_back(0.0);
    if (lambda_max > 0.0)
      error = ContactJudge::scaled_natural_map(rows_of_contact(problem, r, c),
                                               rows_of_contact(problem, u, c), problem.friction[c],
                                               lambda_max);
    if (!std::isfinite(error)) error = infinity;
  }
  return errors;
}

}  // namespace ballast
