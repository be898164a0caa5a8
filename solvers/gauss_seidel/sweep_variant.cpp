#include "solvers/gauss_seidel/sweep_variant.hpp"

#include "problems/algebra/friction_cone.hpp"

namespace ballast {

using Vector = Eigen::Vector3d;

void resolve_by_variant(const SweepVariant& variant, const PrincipalContact& contact,
                        double lambda_max, const double* u, double* y, double& slip) {
  if (!(contact.inverse_normal > 0.0)) {  // always open
    y[0] = y[1] = y[2] = 0.0;
    return;
  }
  const auto impulse = [&contact](const double* x) {
    return Vector(x[0] - contact.c1 * x[1] - contact.c2 * x[2], x[1], x[2]);
  };
  // From the coordinates of the record to (r, u), where the other rules are written.
  const Vector before = impulse(y),
               velocity(u[0], u[1] + contact.c1 * u[0], u[2] + contact.c2 * u[0]);
  Vector after;
  if (variant.rule == LocalRule::projection) {
    after = project_cone(before - modified_velocity(velocity, contact.mu) / lambda_max, contact.mu);
  } else {
    double exact[3] = {y[0] - u[0] * contact.inverse_normal, y[1] - u[1] * contact.inverse_s1,
                       y[2] - u[2] * contact.inverse_s2};
    apply_coulomb(contact, exact[0], exact[1], exact[2], slip);
    after = impulse(exact);
  }
  // Beyond the solution, or short of it, and back onto the cone.
  if (variant.relaxation != 1.0)
    after = project_cone(before + variant.relaxation * (after - before), contact.mu);
  y[0] = after[0] + contact.c1 * after[1] + contact.c2 * after[2];
  y[1] = after[1];
  y[2] = after[2];
}

}  // namespace ballast
