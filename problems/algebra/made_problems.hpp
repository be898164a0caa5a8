#pragma once
// Made problems of which no solution is known: piles of any size and difficulty, and small ones
// that break contact solvers. Units: kg, m, s; gravity 9.81, steps of 1 ms.

#include <cstdint>
#include <string>
#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// g h [m/s]: the velocity that a falling body gains in a step.
constexpr double made_gravity_step = 9.81e-3;

// Synthetic piles of rigid bodies with chosen difficulty: a family of any size, some members of
// which serve to tune a solver and others to test it.
//
//   bodies near the points of a lattice, the ground below    x  x  x
//   pairs of neighbours touch in one or several points        x  x  x
//   all fall by g h, and are pressed together and stirred    ---------
//
// Every problem has a solution: bodies at rest satisfy every contact (Acary, Bremond 2008).

/// The code that reads settings from a user checks their ranges.
struct PileSettings {
  int contacts = 100;       ///< points, each with three rows
  double redundancy = 0.3;  ///< 1 - rank(W)/rows, in [0, 1); the number of bodies meets it roughly
  double mass_ratio = 1.0;  ///< masses log-uniform in [1, mass_ratio] mass units
  double friction_min = 0.3, friction_max = 0.3;
  double active = 0.8;       ///< share of the pairs that are closed; the others stay open
  double slenderness = 1.0;  ///< height over width of the lattice: how far a load has to travel
  double shear = 0.5;        ///< speed of the stirring over that of the pressing: how much slides
  double mass_unit = 1.0;    ///< [kg]; scales 1 / W, and Siconos' measure depends on it
  bool is_stored = false;    ///< W and q alone, as in many files
  std::uint64_t seed = 1;
};

FrictionProblem make_pile(const PileSettings& settings);

/// A member of the family, all settings drawn from `seed`: 2 to `most_contacts` contacts
/// (log-uniform), redundancy 0 to 0.8, mass ratio 1 to 1e4, slenderness 1 to 30, friction 0.1 to 1,
/// active 0.4 to 1, three in four stored.
PileSettings random_pile(std::uint64_t seed, int most_contacts);

// Small problems that break contact solvers, with the known parts of their solutions.

struct StressProblem {
  std::string name;
  std::string family;  ///< "stacks", "odd input", ...
  FrictionProblem problem;
  /// Relative velocities u [m/s] of every solution, one entry per row; empty where they are not
  /// unique, so that the judge alone decides.
  Eigen::VectorXd u;
  /// Body velocities of every solution; empty as above.
  Eigen::VectorXd v;
};

/// A stack of boxes of the given masses [kg], from below, at rest. With 1 of `rows` per contact
/// only heights move; with 3 boxes also move sideways, and friction is 0.5. With masses 1 and R
/// (the heavy one on top) a Gauss-Seidel sweep from the ground up contracts by R / (1 + R), with n
/// equal masses by cos^2(pi / 2n): the square of the largest eigenvalue of Jacobi's iteration.
StressProblem mass_stack(const std::vector<double>& masses, int rows);

/// Painleve's rod slides on its lower end at 1 m/s, at an angle theta to the ground, tan theta = 2,
/// mass 1, half length 1. For mu > 4/3, p = 1 + 3 cos theta (cos theta - mu sin theta) < 0, and no
/// slip with r_N > 0 and u_N = 0 exists. `approach` [m/s] is -u_N before; if it is negative, r = 0
/// is one of several solutions.
StressProblem painleve_rod(double mu, double approach);

/// A table on four legs with `copies` contacts each, pushed to `speed` [m/s]. Velocities are
/// unique, single forces are not. It stops for speed <= mu g h and slides on with speed - mu g h
/// otherwise.
StressProblem four_legged_table(double mu, double speed, int copies);

/// A block that slides at 1 m/s in direction `heading` [rad] to the first tangent. Coulomb's law
/// gives u_N = 0 and |u_T| = 1 - mu g h, the convex relaxation u_N = mu |u_T|.
StressProblem sliding_block(double mu, double heading);

/// n equal grains in a row between a fixed wall and one that is pressed on with `force` [N]:
/// nothing moves, and every contact carries force times h.
StressProblem jammed_chain(int grains, double force);

/// All of these, odd input and manufactured problems, of at most 60 contacts each.
std::vector<StressProblem> stress_problems();

}  // namespace ballast
