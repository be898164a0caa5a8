#include "experiments/step/overlap_correction.hpp"

#include <algorithm>

namespace ballast {

OverlapCorrection::OverlapCorrection(const MechanicalSystem& system, const CorrectionSpec& spec)
    : system_(system), spec_(spec) {
  for (const RigidBody& body : system.bodies) {
    const Freedom& freedom = body.freedom;
    for (int d = 0; d < freedom.translations; ++d)
      inverse_mass_.push_back(body.is_wall() ? 0.0 : 1.0 / body.mass);
    if (freedom.rotation)
      for (int d = 0; d < 3; ++d) inverse_mass_.push_back(1.0 / body.inertia[d]);
  }
  displacement_.setZero(static_cast<Eigen::Index>(inverse_mass_.size()));
}

/// 1 / (H_N M^-1 H_N^T) of a contact; zero where neither of its bodies can be displaced.
double OverlapCorrection::stiffness_of(const FrictionProblem& problem, int c) const {
  double compliance = 0.0;
  for_normal_row(problem, c,
                 [&](int dof, double row) { compliance += row * row * inverse_mass_[dof]; });
  return compliance > 0.0 ? 1.0 / compliance : 0.0;
}

void OverlapCorrection::find_targets(WorkerTeam* team, const ProblemAssembler& assembler,
                                     std::span<const ContactPoint> contacts,
                                     const Eigen::VectorXd& v, double h) {
  const FrictionProblem& problem = assembler.problem();
  rows_.clear();
  const double tolerated = -spec_.slop;
  const auto overlaps = [&](const ContactPoint& c) { return c.gap < tolerated; };
  if (!spec_.enabled || std::ranges::none_of(contacts, overlaps)) return;
  rows_.resize(problem.contact_count());
  const Eigen::VectorXd& imposed = assembler.imposed();
  run_ranges(team, problem.contact_count(), /*together=*/128, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      const ContactPoint& contact = contacts[assembler.detected()[c]];
      const double walls = imposed.size() > 0 ? imposed[problem.row_begin[c]] : 0.0;
      double velocity = 0.0;  // of the bodies
      for_normal_row(problem, c, [&](int dof, double row) { velocity += row * v[dof]; });
      const double next_gap = contact.gap + h * (velocity + walls);
      // A fraction of the overlap is removed. A point that is open or within the slop may close to
      // the slop, no further.
      const double wanted =
          tolerated + (1.0 - spec_.fraction) * std::min(0.0, next_gap - tolerated);
      rows_[c] = {wanted - next_gap, -1.0, 0.0};
    }
  });
}

double OverlapCorrection::apply(const ProblemAssembler& assembler, MotionState& state) {
  if (rows_.empty()) return 0.0;
  const FrictionProblem& problem = assembler.problem();
  // Projected Gauss-Seidel on displacements: pushes are never negative, and heavy bodies move less.
  displacement_.setZero();
  is_displaced_.assign(problem.dynamics.body_count(), 0);
  const auto displaced = [this](int body) { return body >= 0 && is_displaced_[body]; };
  for (int sweep = 0; sweep < spec_.sweeps; ++sweep) {
    for (int c = 0; c < problem.contact_count(); ++c) {
      Row& row = rows_[c];
      // Most points are skipped: nothing is asked of them and neither of their bodies is displaced.
      const int a = problem.dynamics.body_a[c], b = problem.dynamics.body_b[c];
      if (row.target <= 0.0 && !displaced(a) && !displaced(b)) continue;
      if (row.stiffness < 0.0) row.stiffness = stiffness_of(problem, c);
      double moved = 0.0;
      for_normal_row(problem, c, [&](int dof, double coefficient) {
        moved += coefficient * displacement_[dof];
      });
      // The push that moves this row exactly to its target while the other pushes are held.
      const double push = std::max(0.0, row.push + (row.target - moved) * row.stiffness);
      const double change = push - row.push;
      if (change == 0.0) continue;
      row.push = push;
      for (const int body : {a, b})
        if (body >= 0) is_displaced_[body] = 1;
      for_normal_row(problem, c, [&](int dof, double coefficient) {
        displacement_[dof] += inverse_mass_[dof] * coefficient * change;
      });
    }
  }

  // Moves the poses. Lifting a body against gravity adds energy, which the energy balance needs.
  double potential = 0.0;
  for (size_t b = 0; b < system_.bodies.size(); ++b) {
    const int first = assembler.first_dof(static_cast<int>(b));
    const RigidBody& body = system_.bodies[b];
    if (first < 0 || body.is_wall()) continue;
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();
    for (int d = 0; d < body.freedom.translations; ++d)
      shift += body.freedom.axes.col(d) * displacement_[first + d];
    if (body.freedom.rotation) turn = displacement_.segment<3>(first + body.freedom.translations);
    if (shift.isZero(0.0) && turn.isZero(0.0)) continue;
    state.pose[b] = moved(state.pose[b], shift, turn, 1.0);
    potential -= body.mass * system_.gravity.dot(shift);
  }
  return potential;
}

}  // namespace ballast
