#pragma once
// Semismooth Newton on Coulomb's law of all contacts, plain or inside proximal-point steps.

#include <array>
#include <memory>

#include "solvers/parts/contact_equation.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// Newton steps with a line search on the equation's residual (Alart, Curnier 1991; Acary, Bremond,
/// Huber 2018). One iteration is one factorisation. Fails where W is rank deficient and contacts
/// stick, as the method does.
std::unique_ptr<Solver> make_newton(ContactEquation equation);

struct ProximalNewtonSettings {
  int start_sweeps = 200;      ///< before the first step
  bool accelerated = false;    ///< sweeps have nesterov_pgs' momentum
  int mending_sweeps = 50;     ///< after a proximal step that failed
  double first_weight = 1e-3;  ///< alpha rho of the first proximal step
  /// rho lambda_max(W_cc): the first, and which one follows after a failed step.
  std::array<double, 3> rho_factors{10.0, 100.0, 1.0};
};

/// r_{k+1} solves the law with u + alpha (r - r_k): regular whatever W's rank, and the same
/// solutions (Acary, Bremond, Huber 2018, section 6). alpha shrinks after easy steps and grows
/// after failed ones. One iteration is one factorisation.
std::unique_ptr<Solver> make_proximal_newton(const ProximalNewtonSettings& settings = {});

}  // namespace ballast
