#pragma once
// The slip root of one contact in the coordinates of group_record.hpp, found with care.

namespace ballast {

/// x = 1 + lambda from the stick solution (y, t1, t2) outside the cone; 0: no tangential impulse.
/// With a proven bracket, for the few contacts that two Newton steps do not serve.
double slip_root(double s2, double c1, double c2, double mu, double y, double t1, double t2);

}  // namespace ballast
