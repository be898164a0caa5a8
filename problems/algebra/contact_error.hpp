#pragma once
// The one judge: every error figure in the project comes from here, from the returned impulses
// only.

#include <limits>

#include "platform/worker_team.hpp"
#include "problems/algebra/friction_cone.hpp"
#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// All measures of one answer r, in double precision, from a recomputed u = W r + q.
struct ContactError {
  /// |r - P_K(r - rho (u + mu|u_T|n))| / rho with rho = 1 / lambda_max(W_cc): a velocity [m/s].
  /// Root mean square and maximum over the contacts; contacts with W_cc = 0 are left out.
  double natural_map_rms = 0.0;
  double natural_map_max = 0.0;
  int worst_contact = -1;  ///< the contact of natural_map_max; -1 without contacts

  /// The error that Siconos' fc3d_compute_error prints: the natural map with rho = 1, divided by
  /// max(|q|, |r|, |u|). Depends on units.
  double fclib = 0.0;

  /// The three parts of the law, each as a velocity, rms over all contacts [m/s], also those that
  /// no impulse moves. Where mu <= sqrt(15) and rounding is small, none exceeds bound_factor
  /// natural_map_rms. With more friction, or impulses so large that u is lost in rounding, they
  /// show errors that the natural map hides (docs/theory/method.md).
  double approach_rms = 0.0;         ///< max(0, -u_N): speed of sinking in
  double cone_rms = 0.0;             ///< lambda_max(W_cc) |r - P_K(r)|
  double complementarity_rms = 0.0;  ///< |r . (u + mu|u_T|n)| / (|r| + rho |u + mu|u_T|n|)
  /// Largest -u_N of a contact with W_cc = 0 [m/s]; above 0, no impulses solve the problem.
  double immovable_approach = 0.0;
  /// |r|_max over the largest |q_c| / lambda_max(W_cc), the impulse that one contact alone would
  /// need; beyond 1e6 also over the largest |M v_free| of a body with impulses, which would stop
  /// it. Grows without bound where a solver finds no solution.
  double growth = 0.0;

  double cone_violation = 0.0;       ///< max over contacts of |r - P_K(r)| [N s]
  double min_normal_velocity = 0.0;  ///< min u_N [m/s]; >= 0 when nothing sinks in
  double complementarity = 0.0;      ///< max |r . (u + mu|u_T|n)| [J]
  /// Sum of r . (u - bias) [J]: impulses times end-of-step velocities; bias = 0 without dynamics.
  double power = 0.0;
  double velocity_scale = 0.0;  ///< |q| rms over rows [m/s]: scales errors of stored problems
  bool finite = true;  ///< false: r, u or a measure holds NaN or infinity; the measures are then
                       ///< infinite, worst_contact is -1 and velocity_scale 0

  /// The three parts of the law may exceed the tolerance of the natural map by this factor.
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
  /// `masses_are_known`: the problem has been validated with masses(), and has not changed since.
  ContactError judge(const FrictionProblem& problem, const Impulses& r,
                     bool masses_are_known = false);

  /// Returns ContactError::fclib alone, for a solver that looks at its error; equal to judge()'s up
  /// to rounding. `free_norm` is |q|: where it is negative, it is computed and kept.
  double fclib(const FrictionProblem& problem, const Impulses& r, double& free_norm);

  /// v = v_free + M^-1 H^T r of the answer judged last (dynamics form), with which the step goes
  /// on. Valid until the next call.
  const Eigen::VectorXd& body_velocity() const { return v_; }
  /// H^T r of the same answer.
  const Eigen::VectorXd& body_impulse() const { return hr_; }

  /// The masses that were validated last: validate() does not check the same ones again.
  KnownMasses& masses() { return masses_; }

  /// Shares the work from now on; null: one thread. No bit depends on it. `team` outlives the
  /// judge.
  void use_team(WorkerTeam* team) { team_ = team; }

  /// The scaled natural map of one contact [m/s], whose rms is natural_map_rms. `lambda_max` is
  /// that of W_cc and > 0. A one-row contact is padded with zeros.
  static double scaled_natural_map(const Eigen::Vector3d& r, const Eigen::Vector3d& u, double mu,
                                   double lambda_max) {
    return natural_map(r, u, mu, 1.0 / lambda_max).norm() * lambda_max;
  }

 private:
  /// The part of consecutive contacts in the measures; in a root mean square, the sum of squares.
  struct Share : ContactError {
    int counted = 0;  ///< contacts in natural_map_rms
    double largest_impulse = 0.0, impulse_scale = 0.0;
    double free_square = 0.0, impulse_square = 0.0, velocity_square = 0.0;  ///< |q|^2, |r|^2, |u|^2
  };

  void recompute_body_velocities(const FrictionProblem& problem, const Impulses& r,
                                 bool masses_are_known);
  void look_at(const FrictionProblem& problem, int c, int k, JudgeBlock& block);
  Share judge_contacts(const FrictionProblem& problem, const Impulses& r, int begin, int end);
  Share gather(int contacts) const;

  WorkerTeam* team_ = nullptr;
  Eigen::VectorXd u_, q_, v_, hr_;
  KnownMasses masses_;
  std::vector<Eigen::Matrix3d> diagonal_;  // blocks W_cc of a stored W
  std::vector<Share> shares_;
};

/// Largest eigenvalue of a symmetric block, from its lower triangle, in closed form. It is 1/rho of
/// the scaled natural map.
///
/// Smith 1961: with B = (W - mean I) / spread, spread^2 = |W - mean I|^2 / 6, the eigenvalues of B
/// are 2 cos(...), the largest 1 + 2 s w where s^2 = (1 + det B / 2) / 2 and w in [1/2, 1/sqrt(3)]
/// is the root of w^2 (3 + 2 s w) = 1. That equation is well conditioned for every s in [0, 1]:
/// from a cubic fit (error 6e-5) two Newton steps reach rounding, without an arc cosine. Where the
/// two largest eigenvalues coincide (s = 0) rounding of the determinant leaves a relative error of
/// 1e-8, small enough for a scale.
double largest_eigenvalue(const Eigen::Matrix3d& w);

/// Judges once, for tests and tools.
ContactError contact_error(const FrictionProblem& problem, const Impulses& r);

/// The scaled natural map of every contact [m/s], whose root mean square is natural_map_rms. 0
/// where W_cc = 0; infinite where r or u is not finite. Throws InvalidProblem when r has the wrong
/// size.
std::vector<double> errors_by_contact(const FrictionProblem& problem, const Impulses& r);

}  // namespace ballast
