#pragma once
// The one judge: every error figure in the project comes from here, from the returned impulses
// only.

#include <limits>

#include "platform/worker_team.hpp"
#include "problems/algebra/friction_cone.hpp"
#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// All measures of one answer r, in double, from u = W r + q recomputed.
struct ContactError {
  /// |r - P_K(r - rho (u + mu|u_T|n))| / rho with rho = 1 / lambda_max(W_cc): a velocity [m/s].
  /// Root mean square and maximum over the contacts; contacts with W_cc = 0 are left out of it.
  double natural_map_rms = 0.0;
  double natural_map_max = 0.0;
  int worst_contact = -1;  ///< the contact of natural_map_max; -1 without contacts

  /// What Siconos' fc3d_compute_error prints: natural map with rho = 1 divided by max(|q|, |r|,
  /// |u|). Depends on units.
  double fclib = 0.0;

  /// The law's three parts, each as a velocity and rms over all contacts [m/s], those that no
  /// impulse moves included. Where mu <= sqrt(15) and rounding is small none is above bound_factor
  /// natural_map_rms; with more friction, or impulses in which u drowns, they see what it does not
  /// (docs/theory/method.md).
  double approach_rms = 0.0;         ///< max(0, -u_N): what sinks in
  double cone_rms = 0.0;             ///< lambda_max(W_cc) |r - P_K(r)|
  double complementarity_rms = 0.0;  ///< |r . (u + mu|u_T|n)| / (|r| + rho |u + mu|u_T|n|)
  /// Largest -u_N of a contact with W_cc = 0 [m/s]: above 0 no impulse answers the problem.
  double immovable_approach = 0.0;
  /// |r|_max over the largest |q_c| / lambda_max(W_cc), what one contact alone would need; beyond
  /// 1e6 also over |M v_free| of a body with impulses, what would stop it. Grows without bound
  /// where a solver finds no solution.
  double growth = 0.0;

  double cone_violation = 0.0;       ///< max over contacts of |r - P_K(r)| [N s]
  double min_normal_velocity = 0.0;  ///< min u_N [m/s]; >= 0 when nothing sinks in
  double complementarity = 0.0;      ///< max |r . (u + mu|u_T|n)| [J]
  /// r . (u - bias) summed [J]: of the impulses on the end-of-step velocity; bias = 0 without
  /// dynamics.
  double power = 0.0;
  double momentum_residual = 0.0;  ///< |M (v - v_free) - H^T r|_inf, v recomputed (dynamics) [N s]
  double velocity_scale = 0.0;     ///< |q| rms over rows [m/s]: stored problems' relative errors
  bool finite = true;  ///< false: r, u or a measure holds NaN or infinity; the measures are then
                       ///< infinite, worst_contact is -1 and velocity_scale 0

  /// The other parts of the law may be this much above the tolerance of the natural map.
  static constexpr double bound_factor = 4.0;
  /// The one meaning of "solved": the natural map is within the tolerance [m/s], and each part of
  /// the law within bound_factor tolerances.
  bool within(double tolerance) const {
    const double bound = bound_factor * tolerance;
    return finite && natural_map_rms <= tolerance && approach_rms <= bound && cone_rms <= bound &&
           complementarity_rms <= bound;
  }
};

struct JudgeBlock;

/// Judges with its own workspace, so that a run can call it every step without allocating.
class ContactJudge {
 public:
  /// `masses_are_known`: the problem has been validated with masses(), and is as it was then.
  ContactError judge(const FrictionProblem& problem, const Impulses& r,
                     bool masses_are_known = false);

  /// ContactError::fclib alone: what a solver's look needs. `free_norm`: |q|, for the problem at
  /// hand found where it is negative, and kept. The same as judge()'s but for rounding.
  double fclib(const FrictionProblem& problem, const Impulses& r, double& free_norm);

  /// v = v_free + M^-1 H^T r of the answer judged last (dynamics form): what the step goes on with.
  /// Valid until the next call.
  const Eigen::VectorXd& body_velocity() const { return v_; }
  /// H^T r of the same.
  const Eigen::VectorXd& body_impulse() const { return hr_; }

  /// Those of the problems judged until now: whoever validates these need not look at them again.
  KnownMasses& masses() { return masses_; }

  /// Shares the work from now on; null: alone. The same bits either way. `team` outlives the judge.
  void use_team(WorkerTeam* team) { team_ = team; }

  /// The scaled natural map of one contact [m/s]: the summand of natural_map_rms. `lambda_max` of
  /// W_cc, > 0. A one-row contact is padded with zeros.
  static double scaled_natural_map(const Eigen::Vector3d& r, const Eigen::Vector3d& u, double mu,
                                   double lambda_max) {
    return natural_map(r, u, mu, 1.0 / lambda_max).norm() * lambda_max;
  }

 private:
  /// What some neighbouring contacts add to the measures: to a root mean square the squares' sum.
  struct Share : ContactError {
    int counted = 0;  ///< contacts in natural_map_rms
    double largest_impulse = 0.0, impulse_scale = 0.0;
    double free_square = 0.0, impulse_square = 0.0, velocity_square = 0.0;  ///< |q|^2, |r|^2, |u|^2
  };

  void recompute_body_velocities(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                                 const Impulses& r, bool masses_are_known);
  void look_at(const FrictionProblem& problem, int c, int k, JudgeBlock& block);
  Share judge_contacts(const FrictionProblem& problem, const Impulses& r, int begin, int end);
  Share gather(int contacts) const;

  WorkerTeam* team_ = nullptr;
  Eigen::VectorXd u_, q_, v_, hr_;
  KnownMasses masses_;
  std::vector<Eigen::Matrix3d> diagonal_;  // of a stored W
  std::vector<Share> shares_;
};

/// Largest eigenvalue of a symmetric block by its lower triangle, in closed form: 1/rho of the
/// scaled natural map.
///
/// Smith 1961: with B = (W - mean I) / spread, spread^2 = |W - mean I|^2 / 6, the eigenvalues of B
/// are 2 cos(...), the largest 1 + 2 s w where s^2 = (1 + det B / 2) / 2 and w in [1/2, 1/sqrt(3)]
/// is the root of w^2 (3 + 2 s w) = 1. That equation is well conditioned for every s in [0, 1]:
/// from a cubic fit (error 6e-5) two Newton steps reach rounding, without an arc cosine. Where the
/// two largest eigenvalues coincide (s = 0) the determinant's own rounding leaves 1e-8, relative:
/// enough for a scale.
double largest_eigenvalue(const Eigen::Matrix3d& w);

/// Judge once, for tests and tools.
ContactError contact_error(const FrictionProblem& problem, const Impulses& r);

/// The judge's scaled natural map of every contact [m/s]: what natural_map_rms is the root mean
/// square of. 0 where W_cc = 0; infinite where r or u is not finite. Throws InvalidProblem when r
/// has the wrong size.
std::vector<double> errors_by_contact(const FrictionProblem& problem, const Impulses& r);

}  // namespace ballast
