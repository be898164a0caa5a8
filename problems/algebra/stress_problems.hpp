#pragma once
// Small problems that break contact solvers, with what is known of their answers. Units: kg, m, s;
// gravity 9.81, steps of 1 ms: what a resting contact would gain in a step is g h = 9.81e-3 m/s.

#include <string>
#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

struct StressProblem {
  std::string name;
  std::string family;  ///< "stacks", "odd input", ...
  FrictionProblem problem;
  /// Relative velocities u [m/s] of every solution, one entry per row; empty: not unique, the judge
  /// alone decides.
  Eigen::VectorXd u;
  /// Body velocities of every solution; empty as above.
  Eigen::VectorXd v;
  /// Not empty: the problem must be refused, and the message must hold this.
  std::string refused;
};

constexpr double stress_gravity_step = 9.81e-3;  ///< g h [m/s]

/// Boxes of the given masses [kg] one on the other, at rest; only heights move. `rows` per
/// contact: 1, or 3 with friction 0.5. With masses 1 and R (the heavy one on top) a Gauss-Seidel
/// sweep from the ground up contracts by R / (1 + R), with n equal masses by cos^2(pi / 2n): the
/// square of the largest eigenvalue of Jacobi's iteration.
StressProblem mass_stack(const std::vector<double>& masses, int rows);

/// Painleve's rod: slides on its lower end at 1 m/s with angle theta to the ground, tan theta =
/// 2, mass 1, half length 1. p = 1 + 3 cos theta (cos theta - mu sin theta) < 0 for mu > 4/3: no
/// slip with r_N > 0 and u_N = 0 then. `approach` [m/s]: -u_N before; negative: r = 0 is one
/// solution of several.
StressProblem painleve_rod(double mu, double approach);

/// A table on four legs, each leg's contact `copies` times; pushed to `speed` [m/s]. Velocities
/// are unique, single forces are not. It stands for speed <= mu g h and slides on with speed - mu g
/// h otherwise.
StressProblem four_legged_table(double mu, double speed, int copies);

/// A block that slides at 1 m/s in direction `heading` [rad] to the first tangent. Coulomb: u_N
/// = 0 and |u_T| = 1 - mu g h; convex relaxation: u_N = mu |u_T|.
StressProblem sliding_block(double mu, double heading);

/// n equal grains in a row between a fixed wall and one that is pressed on with `force` [N]:
/// nothing moves, and every contact carries force times h.
StressProblem jammed_chain(int grains, double force);

/// All of them, odd input and manufactured ones: valid ones of at most 60 contacts, and broken ones
/// that must be refused.
std::vector<StressProblem> stress_problems();

}  // namespace ballast
