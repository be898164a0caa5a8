#pragma once
// One maker for each backend, with the source of its algorithm. solver_list.cpp gives them names.

#include <array>
#include <memory>

#include "solvers/parts/contact_equation.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// The recommended backend. Sweeps with momentum come first; they end where the rest of their way
/// promises to cost more than a dozen Newton steps. Then comes Newton's method: newton_burst for
/// problems with bodies, proximal Newton where only W is known or iterations are scarce. Problems
/// still unsolved get turns of sweeps, an interior point and Newton, each from the best iterate and
/// of equal work (newton_burst ends by itself). Each turn has twice the work of the last, until two
/// turns in a row gain nothing.
///
/// Work is computed from sizes, never clocked: the same problem takes the same turns and gives the
/// same bits on every machine. One iteration is a sweep or a factorisation.
std::unique_ptr<Solver> make_auto();

/// Projected (nonsmooth) Gauss-Seidel: contact after contact, each solved exactly (Jean 1999;
/// Siconos' NSGS).
std::unique_ptr<Solver> make_gauss_seidel();

/// Sweeps with Nesterov's momentum, which begins anew when a sweep changes more than the least of
/// its search did (the square, by a factor of 1.3). Nesterov 1983, "A method of solving a convex
/// programming problem with convergence rate O(1/k^2)"; O'Donoghue, Candes 2015, "Adaptive restart
/// for accelerated gradient schemes". `returns_best`: a solve that a limit ends returns the best
/// judged iterate, swept once more; otherwise the last one, from which a method that has sweeps as
/// one part goes on.
std::unique_ptr<Solver> make_nesterov_pgs(bool returns_best = true);

/// Nonsmooth nonlinear conjugate gradients (Fletcher-Reeves) with the change of a sweep for a
/// gradient. Silcowitz-Hansen, Niebe, Erleben 2010, "A nonsmooth nonlinear conjugate gradient
/// method for interactive contact force problems".
std::unique_ptr<Solver> make_nncg();

/// Returns Budget::gives_up for sweeps, `step` of which cost as much as a Newton step. Sweeps end
/// where two looks in a row promise that the rest of the way to budget.aim() costs more than the
/// dozen Newton steps that mostly suffice. Before that they get the cost of 8 steps, or `at_most`
/// if that is less, but no more than 500 sweeps where the error is far from the aim. `budget`
/// outlives it.
decltype(Budget::gives_up) sweep_stop_rule(double step, double at_most, const Budget& budget);

/// The number of sweeps over bodies that cost as much as a Newton step. Measured on packings of 80
/// to 8000 contacts.
double sweeps_of_step(int contacts);

/// Accelerated projected gradient descent with adaptive restart. Mazhar, Heyn, Negrut, Tasora 2015,
/// "Using Nesterov's method to accelerate multibody dynamics with friction and contact"; restart
/// after O'Donoghue, Candes 2015. Departures: diagonal scaling by 1 / lambda_max(W_cc); the
/// s-update (slip_shift.hpp), so that Coulomb's law is reached and not its convex relaxation; one
/// product with W an iteration, backtracking included.
std::unique_ptr<Solver> make_apgd();

/// Alternating directions with over-relaxation and adaptive penalty. Boyd et al. 2011; for contact:
/// Acary, Bremond, Huber 2018 (ADMM in Siconos). One sparse factorisation serves all iterations
/// with the same penalty; the s-update makes the law Coulomb's.
std::unique_ptr<Solver> make_admm();

/// Primal-dual interior point for the second-order cone problem of contact: Nesterov-Todd scaling,
/// Mehrotra's predictor and corrector, one sparse factorisation a step. Acary, Armand, Nguyen,
/// Shpakovych 2023, "Second-order cone programming for frictional contact mechanics using interior
/// point algorithm". The s-update makes the law Coulomb's: after an inner problem with s held, the
/// next s begins at an iterate that is still well inside the cones. From an error of 1e-4 of q on,
/// or where steps stall (the scaling's range ends at rounding), proximal Newton takes over.
std::unique_ptr<Solver> make_interior_point();

/// Drake's SAP: the convex relaxation of contact as an unconstrained problem in the bodies'
/// velocities. Castro, Permenter, Han 2022, "An unconstrained convex formulation of compliant
/// contact". Departures: the regularisation is the same along normal and tangents. It is SAP's
/// around r = 0; proximal steps move r and solve again, so that none is left in the end. A stored W
/// must be symmetric. The law is the relaxation: u_N = mu |u_T| where a contact slides.
std::unique_ptr<Solver> make_sap();

/// Semismooth Newton on Coulomb's law of all contacts, with a line search on the equation's
/// residual (Alart, Curnier 1991; Acary, Bremond, Huber 2018). One iteration is one factorisation.
/// As the method does, it fails where W is rank deficient and contacts stick.
std::unique_ptr<Solver> make_newton(ContactEquation equation);

struct ProximalNewtonSettings {
  int start_sweeps = 200;      ///< before the first step
  bool accelerated = false;    ///< sweeps have nesterov_pgs' momentum
  int mending_sweeps = 50;     ///< after a proximal step that failed
  double first_weight = 1e-3;  ///< alpha rho of the first proximal step
  /// rho lambda_max(W_cc): begins with the first; a failed step goes on to the next.
  std::array<double, 3> rho_factors{10.0, 100.0, 1.0};
};

/// Proximal Newton: r_{k+1} solves the law with u + alpha (r - r_k), which is regular whatever W's
/// rank, and leads to the same solutions (Acary, Bremond, Huber 2018, section 6). alpha shrinks
/// after easy steps and grows after failed ones. One iteration is one factorisation.
std::unique_ptr<Solver> make_proximal_newton(const ProximalNewtonSettings& settings = {});

/// Accelerated sweeps as long as they promise to arrive. Then Newton steps on the regularised law
/// of all contacts, which guess every contact's status and solve the linear systems exactly, with
/// bursts of sweeps between them. Then proximal-point steps by Newton alone. So one backend serves
/// loose and tight tolerances.
///
/// A Newton step carries impulses across the whole packing, as far as its guessed statuses are
/// right; sweeps put statuses right, contact by contact. From about 1e-4 of the error without
/// impulses on, proximal-point steps by Newton alone are faster.
///
/// Sweeps and factorisations both count as iterations. Needs the dynamics form. Without the sweeps
/// at the beginning, prepare() prepares Newton's method at once.
std::unique_ptr<Solver> make_newton_burst(bool begins_with_sweeps = true);

// Backends of optional libraries: where a library is missing, its makers give null (missing.cpp).

/// Ipopt (Waechter, Biegler 2006) on the convex cone program, with the s-update around it: polar
/// coordinates, exact sparse Hessian. An iteration is one of Ipopt's own. (With the constraints mu
/// r_N - |r_T|, mu^2 r_N^2 - |r_T|^2 or mu^2 r_N - |r_T|^2 / r_N instead, 5 problems took from 50
/// iterations to 500 without an answer; polar coordinates take 30.)
std::unique_ptr<Solver> make_ipopt();

/// SLSQP (Kraft 1994) of NLopt (Johnson) on the same program. A round leaves out the contacts that
/// a projected gradient step puts at the apex of their cone; the others have |r_T| <= mu r_N.
/// NLopt's Jacobian and SLSQP's factor of the Hessian are dense: larger problems are declined. An
/// iteration is one evaluation of the objective.
std::unique_ptr<Solver> make_nlopt();
inline constexpr int nlopt_limit = 60;  ///< contacts

/// Siconos' numerics (https://nonsmooth.gricad-pages.univ-grenoble-alpes.fr/siconos), the reference
/// of the field: solvers of its FrictionContactProblem  u = W r + q, mu. Its formulas are in Acary,
/// Bremond, Huber 2018, "On solving contact problems with Coulomb friction: formulations and
/// numerical comparisons".
///
/// Siconos cannot be interrupted, and ends the process on some errors, so each call runs in a child
/// process (answer_apart). Only the library's own driver is timed; starting processes, converting W
/// to the library's form and judging are start-up.
///
/// Where the budget asks for Siconos' own measure, Siconos' tolerance is the one asked for.
/// Otherwise, and where the judge does not agree, Siconos' tolerance, which is relative and in
/// mixed units, is tightened in rounds until the judge agrees or rounds gain nothing more. An
/// iteration is one of Siconos' own.
enum class SiconosMethod {
  nsgs,       ///< nonsmooth Gauss-Seidel, local Newton with line search and projections
  nsgs_full,  ///< as nsgs, with its true error after every sweep in place of the sweep's change
  prox,       ///< proximal point around a nonsmooth Newton
  admm,       ///< ADMM, penalty by residual balancing
  nsn_ac      ///< nonsmooth Newton on Alart-Curnier's function
};
std::unique_ptr<Solver> make_siconos(SiconosMethod method);

}  // namespace ballast
