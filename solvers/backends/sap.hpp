#pragma once
// Drake's SAP: the convex relaxation of contact as an unconstrained problem in the bodies'
// velocities. Castro, Permenter, Han 2022, "An unconstrained convex formulation of compliant
// contact".
//
//   min over v  1/2 (v - v_free).M (v - v_free) + sum_c epsilon_c / 2 |gamma_c|^2,
//   gamma_c = P_K(r_c - u_c / epsilon_c),  u = H v + bias,  epsilon_c = regularisation
//   lambda_max(W_cc)
//
// by Newton with an exact line search. Departures: the regularisation is the same along normal and
// tangents; around r = 0 it is SAP's, and `proximal` moves r to gamma and solves again, so that no
// regularisation is left in the end. Where only W is known the velocities are those of impulses
// lambda, v = v_free + M^-1 H^T lambda, and Newton's unknowns are these: W must then be symmetric.
// The law is the relaxation either way: u_N = mu |u_T| where a contact slides.

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

struct SapSettings {
  double regularisation = 1e-3;  ///< Drake's sigma
  bool proximal = true;          ///< false: one problem, regularised for good
};

std::unique_ptr<Solver> make_sap(const SapSettings& settings = {});

}  // namespace ballast
