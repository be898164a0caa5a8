#pragma once
// Friction on a pyramid instead of a cone, as a linear complementarity problem, solved exactly by
// Lemke's pivoting. Stewart, Trinkle 1996, "An implicit time-stepping scheme for rigid body
// dynamics with inelastic collisions and Coulomb friction", eq. (15); Anitescu, Potra 1997 (where
// it is shown to be solvable).

#include "solvers/seam/solver.hpp"

namespace ballast {

struct PyramidLemkeSettings {
  /// Directions of friction per contact, even, >= 4; their hull is inside the circle.
  int sides = 8;
  /// Unknowns of the complementarity problem: sides + 2 per contact with friction, 1 without.
  static constexpr int largest = 1000;

  constexpr int unknowns_per_contact() const { return sides + 2; }  ///< with friction
  constexpr SizeLimit limit() const {
    return {largest / unknowns_per_contact(), largest / unknowns_per_contact()};
  }
};

/// Judged on Coulomb's law like every backend: with sliding contacts that do not move along one of
/// the directions it ends as `stalled`, and own_residual [m/s] says how well its own law is met. An
/// iteration is a pivot; before the last one there is no iterate, and a limit returns the start.
std::unique_ptr<Solver> make_pyramid_lemke(const PyramidLemkeSettings& settings = {});

}  // namespace ballast
