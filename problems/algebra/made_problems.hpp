#pragma once
// Made problems of which no solution is known: piles of any size and difficulty, and small ones
// that break contact solvers. Units: kg, m, s; gravity 9.81, steps of 1 ms.

#include <cstdint>
#include <string>
#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// g h [m/s]: what falls gains in a step.
constexpr double made_gravity_step = 9.81e-3;

// Piles of rigid bodies made from numbers, with the difficulty that is asked for: a family of any
// size on which a solver can be tuned, and another of its members on which it can be tried.
//
//   bodies near the points of a lattice, the ground below    x  x  x
//   pairs of neighbours touch in one or several points        x  x  x
//   all fall by g h, and are pressed together and stirred    ---------
//
// Every problem has a solution: all bodies at rest obey every contact (Acary, Bremond 2008).

/// What the ranges are is for who reads settings from a user to check.
struct PileSettings {
  int contacts = 100;       ///< points, each with three rows
  double redundancy = 0.3;  ///< 1 - rank(W)/rows, in [0, 1): reached by the number of bodies, about
  double mass_ratio = 1.0;  ///< masses log-uniform in [1, mass_ratio] mass units
  double friction_min = 0.3, friction_max = 0.3;
  double active = 0.8;       ///< share of the pairs that are closed; the others stay apart
  double slenderness = 1.0;  ///< height over width of the lattice: how far a load has to travel
  double shear = 0.5;        ///< speed of the stirring over that of the pressing: how much slides
  double mass_unit = 1.0;    ///< [kg]; W is its inverse: Siconos' measure depends on it
  bool is_stored = false;    ///< W and q alone, as files often have it
  std::uint64_t seed = 1;
};

FrictionProblem make_pile(const PileSettings& settings);

/// A member of the family, all settings drawn from `seed`: 2 to `most_contacts` contacts
/// (log-uniform), redundancy 0 to 0.8, mass ratio 1 to 1e4, slenderness 1 to 30, friction 0.1 to 1,
/// active 0.4 to 1, three in four stored.
PileSettings random_pile(std::uint64_t seed, int most_contacts);

// Small problems that break contact solvers, with what is known of their answers.

struct StressProblem {
  std::string name;
  std::string family;  ///< "stacks", "odd input", ...
  FrictionProblem problem;
  /// Relative velocities u [m/s] of every solution, one entry per row; empty: not unique, the judge
  /// alone decides.
  Eigen::VectorXd u;
  /// Body velocities of every solution; empty as above.
  Eigen::VectorXd v;
};

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

/// All of them, odd input and manufactured ones, of at most 60 contacts.
std::vector<StressProblem> stress_problems();

}  // namespace ballast
