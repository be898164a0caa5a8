#pragma once
// Piles of rigid bodies made from numbers, with the difficulty that is asked for: a family of any
// size on which a solver can be tuned, and another of its members on which it can be tried.
//
//   bodies near the points of a lattice, the ground below    x  x  x
//   pairs of neighbours touch in one or several points        x  x  x
//   all fall by g h, and are pressed together and stirred    ---------
//
// Every problem has a solution: all bodies at rest obey every contact (Acary, Bremond 2008).

#include <cstdint>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

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

}  // namespace ballast
