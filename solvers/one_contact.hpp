#pragma once
// The exact solution of one contact: given W (3 x 3, symmetric positive definite) and q, find r with u = W r + q and Coulomb's law.

#include <Eigen/Dense>

namespace ballast {

enum class ContactStatus { open, stick, slip };

/// Take-off, stick, or slip by a bracketed one-dimensional root; see one_contact.cpp for the bracket's proof.
///   open : q_N >= 0                        -> r = 0
///   stick: r = -W^-1 q lies in K_mu        -> u = 0
///   slip : u_N = 0, u_T = -lambda r_T, |r_T| = mu r_N, lambda > 0
/// `lambda` in: a guess (0: none), out: the slip root [1/kg]. Natural map <= 1e-12 relative for every SPD W and mu >= 0.
ContactStatus solve_one_contact(const Eigen::Matrix3d& w, const Eigen::Vector3d& q, double mu, Eigen::Vector3d& r,
                                double& lambda);

}  // namespace ballast
