#include "solvers/gauss_seidel/slip_root.hpp"

#include "solvers/parts/one_contact.hpp"

namespace ballast {

double slip_root(double s2, double c1, double c2, double mu, double y, double t1, double t2) {
  PrincipalContact contact;
  contact.inverse_normal = contact.s1 = contact.inverse_s1 = 1.0;
  contact.s2 = s2;
  contact.inverse_s2 = 1.0 / s2;
  contact.c1 = c1;
  contact.c2 = c2;
  contact.mu = mu;
  double x = 0.0;
  slide(contact, y, t1, t2, x);
  return x;
}

}  // namespace ballast
