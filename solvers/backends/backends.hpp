#pragma once
// The door to all backends: one maker each, with where the algorithm comes from. solver_list.cpp
// gives them names.

#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "solvers/parts/contact_equation.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// The backend that we recommend. Sweeps with momentum come first, and are left where the rest of
/// their way promises to cost more than a dozen Newton steps. Then comes Newton: with bursts of
/// sweeps over bodies, by proximal steps where W alone is known or iterations are scarce. What is
/// then still unsolved is for turns of sweeps, an interior point and Newton, each from the best
/// iterate, for as much work as the others', and twice that in the next turn, until two turns in a
/// row gain nothing.
///
/// Work is counted from sizes, never clocked: the same problem takes the same turns and gives the
/// same bits on every machine. One iteration is a sweep or a factorisation.
std::unique_ptr<Solver> make_auto();

/// Projected (nonsmooth) Gauss-Seidel: contact after contact, each solved exactly (Jean 1999;
/// Siconos' NSGS).
std::unique_ptr<Solver> make_gauss_seidel();

/// Sweeps with Nesterov's momentum, which begins anew when a sweep changes more than the least of
/// its search did. Nesterov 1983, "A method of solving a convex programming problem with
/// convergence rate O(1/k^2)"; O'Donoghue, Candes 2015, "Adaptive restart for accelerated gradient
/// schemes". `returns_best`: where a limit ends it, of the iterates that were looked at the best,
/// swept once more; else the last, from which a method goes on whose sweeps are one part of it.
std::unique_ptr<Solver> make_nesterov_pgs(bool returns_best = true);

/// Nonsmooth nonlinear conjugate gradients: sweeps taken for a gradient, Fletcher-Reeves for the
/// rest. Silcowitz-Hansen, Niebe, Erleben 2010, "A nonsmooth nonlinear conjugate gradient method
/// for interactive contact force problems".
std::unique_ptr<Solver> make_nncg();

/// For Budget::gives_up of sweeps, of which `step` cost as much as a Newton step: where two looks
/// in a row promise that the rest of the way to budget.aim() costs more than the dozen steps that
/// mostly bring Newton home. Sweeps get 8 steps' worth before that, or `at_most`, whichever is
/// less; but no more than 500 where the error is far from the aim. `budget` outlives it.
class SlowSweeps {
 public:
  SlowSweeps(double step, double at_most, const Budget& budget);
  bool operator()(int sweeps, double error);

 private:
  double left(int sweeps, double error);

  static constexpr double near = 30.0;  ///< times budget.aim()

  const Budget& budget_;
  int least_near_, least_far_, refusals_ = 0;
  double most_;
  std::vector<std::pair<int, double>> looks_;  ///< sweeps, error
};

/// Sweeps over bodies that cost as much as a step of Newton's method. Measured on packings of 80 to
/// 8000 contacts.
double sweeps_of_step(int contacts);

/// Accelerated projected gradient descent with adaptive restart. Mazhar, Heyn, Negrut, Tasora 2015,
/// "Using Nesterov's method to accelerate multibody dynamics with friction and contact"; restart
/// after O'Donoghue, Candes 2015. Departures: diagonal scaling by 1 / lambda_max(W_cc); the
/// s-update (slip_shift.hpp), so that Coulomb's law is reached and not its convex relaxation; one
/// product with W an iteration, backtracking included.
std::unique_ptr<Solver> make_apgd();

/// Alternating directions with over-relaxation and adaptive penalty. Boyd et al. 2011; for contact:
/// Acary, Bremond, Huber 2018 (ADMM in Siconos). One sparse factorisation serves all iterations
/// with one penalty; the s-update makes the law Coulomb's.
std::unique_ptr<Solver> make_admm();

/// Primal-dual interior point for the second-order cone problem of contact: Nesterov-Todd scaling,
/// Mehrotra's predictor and corrector, one sparse factorisation a step. Acary, Armand, Nguyen,
/// Shpakovych 2023, "Second-order cone programming for frictional contact mechanics using interior
/// point algorithm". The s-update makes the law Coulomb's: an inner problem with s held, then a new
/// s, from an iterate that is still well inside. From an error of 1e-4 of q on, or where this
/// stalls (the scaling's range ends at rounding), proximal Newton goes the rest of the way.
std::unique_ptr<Solver> make_interior_point();

/// Drake's SAP: the convex relaxation of contact as an unconstrained problem in the bodies'
/// velocities. Castro, Permenter, Han 2022, "An unconstrained convex formulation of compliant
/// contact". Departures: the regularisation is the same along normal and tangents; around r = 0 it
/// is SAP's, and proximal steps move r and solve again, so that none is left in the end. A stored W
/// must be symmetric. The law is the relaxation: u_N = mu |u_T| where a contact slides.
std::unique_ptr<Solver> make_sap();

/// Semismooth Newton on Coulomb's law of all contacts, with a line search on the equation's
/// residual (Alart, Curnier 1991; Acary, Bremond, Huber 2018). One iteration is one factorisation.
/// Fails where W is rank deficient and contacts stick, as the method does.
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

/// Accelerated sweeps as long as they promise to arrive; then Newton steps on Coulomb's law of all
/// contacts, regularised, with every contact's status guessed and the linear systems solved
/// exactly, and bursts of sweeps between them; then proximal-point steps by Newton alone. So one
/// backend serves loose and tight tolerances.
///
/// What each part is for: a Newton step carries impulses across the whole packing, as far as the
/// statuses that it guessed are right; sweeps put statuses right, contact by contact. From an error
/// of about 1e-4 of the start's, proximal-point steps by Newton alone are the faster.
///
/// Iterations count sweeps and factorisations alike. Needs the dynamics form. Without the sweeps at
/// the beginning it is prepared for Newton at once.
std::unique_ptr<Solver> make_newton_burst(bool begins_with_sweeps = true);

// With libraries that a build may do without: where one is missing, its makers give null
// (missing.cpp).

/// The convex cone program with the s-update around it for Ipopt (Waechter, Biegler 2006): polar
/// coordinates, exact sparse Hessian. An iteration is one of Ipopt's own. (Tried instead on 5
/// problems: mu r_N - |r_T|, mu^2 r_N^2 - |r_T|^2 and mu^2 r_N - |r_T|^2 / r_N: 50 iterations to
/// 500 and no answer, where this takes 30.)
std::unique_ptr<Solver> make_ipopt();

/// The same program by SLSQP (Kraft 1994) of NLopt (Johnson). Contacts at the apex of their cone,
/// as a projected gradient step tells, are left out of a round; the others have |r_T| <= mu r_N.
/// NLopt keeps the Jacobian dense, and SLSQP a factor of the Hessian: larger problems are declined.
/// An iteration is one evaluation of the objective.
std::unique_ptr<Solver> make_nlopt();
inline constexpr int nlopt_limit = 60;  ///< contacts

/// Siconos' numerics (https://nonsmooth.gricad-pages.univ-grenoble-alpes.fr/siconos): the field's
/// reference, solvers of its FrictionContactProblem  u = W r + q, mu. Its own formulas are in
/// Acary, Bremond, Huber 2018, "On solving contact problems with Coulomb friction: formulations and
/// numerical comparisons".
///
/// Siconos cannot be interrupted, and ends the process on some errors: each call runs apart
/// (answer_apart). The clock runs in the library's own driver; processes, W in the library's form
/// and the judge are start-up.
///
/// Where the budget asks for Siconos' own measure its tolerance is what was asked. Otherwise, and
/// where the judge does not agree, its tolerance, which is relative and in mixed units, is
/// tightened in rounds until the judge does, or nothing comes of it any more. An iteration is one
/// of Siconos' own.
enum class SiconosMethod {
  nsgs,       ///< nonsmooth Gauss-Seidel, local Newton with line search and projections
  nsgs_full,  ///< the same; its true error after every sweep, in place of what the sweep moved
  prox,       ///< proximal point around a nonsmooth Newton
  admm,       ///< ADMM, penalty by residual balancing
  nsn_ac      ///< nonsmooth Newton on Alart-Curnier's function
};
std::unique_ptr<Solver> make_siconos(SiconosMethod method);

}  // namespace ballast
