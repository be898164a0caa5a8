#pragma once
// The exact solution of one contact: given W (3 x 3, symmetric positive definite) and q, find r with u = W r + q and
// Coulomb's law.

#include <cmath>

#include <Eigen/Dense>

namespace ballast {

enum class ContactStatus { open, stick, slip };

/// W of one contact in the coordinates in which it is diagonal. With c = W_TN / W_NN, the Schur complement
/// S = W_TT - c W_TN^T, the tangents turned to the principal axes of S, and y = r_N + c . r_T in place of r_N:
///
///   u_N = W_NN y + q_N,     u_T - c u_N = S r_T + b,   S = diag(s1, s2),   b = q_T - c q_N
///
/// Coulomb's law does not notice the turned tangents. Singular W is taken for the nearest regular one (relative
/// rounding).
struct PrincipalContact {
  double inverse_normal = 0.0;  ///< 1 / W_NN [kg]; 0: no impulse moves the contact along its normal, it is always open
  double s1 = 0.0, s2 = 0.0;    ///< 0 < s1 <= s2 [1/kg]
  double inverse_s1 = 0.0, inverse_s2 = 0.0;
  double c1 = 0.0, c2 = 0.0;
  double mu = 0.0;
};

/// The turn from the given tangents to the principal ones.
struct TangentTurn {
  double cosine = 1.0, sine = 0.0;

  void to_principal(double& t1, double& t2) const {
    const double first = cosine * t1 + sine * t2;
    t2 = cosine * t2 - sine * t1;
    t1 = first;
  }
  void from_principal(double& t1, double& t2) const {
    const double first = cosine * t1 - sine * t2;
    t2 = sine * t1 + cosine * t2;
    t1 = first;
  }
};

/// `w` symmetric positive semidefinite; a one-row contact has W_NN alone.
void make_principal(const Eigen::Matrix3d& w, double mu, PrincipalContact& contact, TangentTurn& turn);

/// The slip branch: from the stick solution (y, t1, t2) outside the cone to |r_T| = mu r_N, y unchanged. `x` = s1 +
/// lambda: in, a guess (0: none); out, the root.
void slide(const PrincipalContact& contact, double y, double& t1, double& t2, double& x);

/// The three cases, in order. In: the impulse (y, r_T) that would stop all motion; out: the solution. Inlined into the
/// sweeps.
inline ContactStatus apply_coulomb(const PrincipalContact& contact, double& y, double& t1, double& t2, double& x) {
  if (y <= 0.0) {  // q_N >= 0: leaves by itself
    y = t1 = t2 = 0.0;
    return ContactStatus::open;
  }
  const double limit = contact.mu * (y - contact.c1 * t1 - contact.c2 * t2);
  if (limit >= 0.0 && t1 * t1 + t2 * t2 <= limit * limit) return ContactStatus::stick;
  slide(contact, y, t1, t2, x);
  return ContactStatus::slip;
}

/// Take-off, stick, or slip by a bracketed one-dimensional root; see one_contact.cpp for the bracket's proof.
///   open : q_N >= 0                        -> r = 0
///   stick: r = -W^-1 q lies in K_mu        -> u = 0
///   slip : u_N = 0, u_T = -lambda r_T, |r_T| = mu r_N, lambda > 0
/// `lambda` in: a guess (0: none), out: the slip root [1/kg]. The scaled natural map is at most 1e-12 (|q| +
/// lambda_max(W) |r|), for every SPD W and mu >= 0: u = W r + q itself cannot be evaluated more closely than the
/// rounding of its largest term.
ContactStatus solve_one_contact(const Eigen::Matrix3d& w, const Eigen::Vector3d& q, double mu, Eigen::Vector3d& r,
                                double& lambda);

}  // namespace ballast
