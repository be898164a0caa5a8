#pragma once
// A jump to another place, for a Newton method on statuses that is stuck: interior-point steps on
// Coulomb's law from some impulses, which know no statuses. Now and then one ends near a solution,
// more often its steps shrink to nothing; so jumps are tried one after the other, each from another
// distance to the boundary.

#include "solvers/parts/coulomb_interior.hpp"
#include "solvers/seam/course.hpp"

namespace ballast {

class InteriorJump {
 public:
  /// Both must outlive the use; the system is factored anew in every step.
  void prepare(const UnitMassContacts& contacts, UnitMassSystem& system);
  /// The `number`-th jump from the impulses `r`, within the course's budget. `scale`: a velocity
  /// that is natural to the problem [m/s]; below `near` times it a jump ends. `r` becomes the best
  /// iterate of the jump, its error is returned [m/s].
  double run(Course& course, ContactColumns& r, int number, double scale, double near);

 private:
  const UnitMassContacts* contacts_ = nullptr;
  CoulombInterior point_;
  double mean_lambda_ = 1.0;  ///< geometric, of lambda_max(W_cc) [1/kg]
  ContactColumns rounded_;
  Impulses impulses_;
};

}  // namespace ballast
