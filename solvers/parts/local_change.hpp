#pragma once
// LMGC90's rule for stopping sweeps, norm "QM/16", so that results can be compared with those
// computed under it. It follows LMGC90's nlgs (prep_check, solve, comp_check); LMGC90's scripts for
// polyhedra ask for 500 sweeps between two looks and a tolerance of 1.666e-4.
//
// At an iterate r, with the velocities u that it gives, each contact is solved once more while all
// others are held: r' and u' = u + W_cc (r' - r). With
//
//   d = u - u',   m = (r + r') / 2,   e = (r . W_cc r + r' . W_cc r') / 2,
//   w^2 = (|W_cc r|^2 + |W_cc r'|^2) / 2
//
// and means < > over the contacts that carry an impulse (m not zero), ChangeNorms has the numbers.
// They tell how much one more sweep would change, not how far the solution is: slowly converging
// sweeps satisfy them early.

#include <memory>

#include "solvers/parts/contact_operator.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// All are relative, and zero where no contact carries an impulse.
struct ChangeNorms {
  double velocity_mean = 0.0;  ///< sqrt(<|d|^2> / <w^2>)
  double velocity_max = 0.0;   ///< max |d| / sqrt(<w^2>)
  double energy_mean = 0.0;    ///< sqrt(<|d|^2 |m|^2>) / <e>
  double energy_max = 0.0;     ///< max |d| |m| / <e>
  double drift = 0.0;          ///< <m . d> / <e>: signed, whether contacts open or close as a whole

  /// Whether the means and |drift| are below the tolerance, and the maxima below 16.666 of it.
  bool within(double tolerance) const;
};

/// The norms at the impulses r. `w` has been prepared for the problem.
ChangeNorms local_change(ContactOperator& w, const Impulses& r);

struct ChangeRule {
  double tolerance = 1.666e-4;
  int every = 500;  ///< iterations from one look to the next
};

/// Runs the backend in bursts of `rule.every` iterations until the rule is met after one; the
/// budget's tolerance is ignored. An answer that meets the rule is returned as `stalled`, since it
/// may be far from a solution. Acceleration begins anew with every burst.
std::unique_ptr<Solver> make_change_stopped(std::unique_ptr<Solver> backend,
                                            const ChangeRule& rule);

}  // namespace ballast
