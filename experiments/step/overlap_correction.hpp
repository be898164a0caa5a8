#pragma once
// Overlap correction by displacements: overlapping grains are moved apart after the step;
// velocities and walls are untouched (docs/theory/method.md). A few Gauss-Seidel sweeps from d = 0
// solve roughly
//
//   min 1/2 d^T M d   subject to, at each contact c,
//   g_c + H_N,c d  >=  -slop - (1 - fraction) * max(0, -g_c - slop),   g_c = gap_c + h u_N,c,
//
// for small displacements d of the grains. The change of the potential energy is recorded.

#include <span>
#include <vector>

#include "platform/worker_team.hpp"
#include "problems/mechanics/assemble.hpp"

namespace ballast {

class OverlapCorrection {
 public:
  OverlapCorrection(const MechanicalSystem& system, const CorrectionSpec& spec);

  /// Finds how far the bodies of each contact must be moved apart. `contacts` and `assembler` are
  /// of this step, `v` holds the unknowns at its end, `h` is its length. The team shares the work.
  void find_targets(WorkerTeam* team, const ProblemAssembler& assembler,
                    std::span<const ContactPoint> contacts, const Eigen::VectorXd& v, double h);
  /// Displaces the poses of `state` as find_targets() asks. Returns the change of potential energy
  /// by the displacements [J] (negative: they lowered it).
  double apply(const ProblemAssembler& assembler, MotionState& state);

 private:
  double stiffness_of(const FrictionProblem& problem, int c) const;

  const MechanicalSystem& system_;
  CorrectionSpec spec_;
  std::vector<double> inverse_mass_;  // per unknown; 0 for driven walls
  Eigen::VectorXd displacement_;
  std::vector<char> is_displaced_;  // per body of the problem
  /// One row per contact of the problem; no rows where nothing overlaps by more than the slop.
  struct Row {
    double target;     // least H_N d that is asked for [m]
    double stiffness;  // 1 / (H_N M^-1 H_N^T); negative: not yet computed
    double push;       // accumulated multiplier [kg m]
  };
  std::vector<Row> rows_;
};

}  // namespace ballast
