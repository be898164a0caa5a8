#pragma once
// The s-update: how a solver of the convex cone problem becomes a solver of Coulomb's law.
//
// With s_c = mu |u_T| held, Coulomb's law is the optimality of a convex problem (De Saxce 1998;
// Acary, Cadoux, Lemarechal, Malick 2011):
//   min 1/2 r.W r + r.(q + s n)  over K_mu:   K_mu ∋ r  ⟂  u + s n ∈ K_mu*,  u = W r + q
// and s is right when it is mu |u_T| of its own solution. This fixed-point iteration contracts by
// about 0.75 an outer step, so it is repeated often (every few iterations of a first-order method)
// or accelerated by Anderson mixing (after an inner solve).

#include <vector>

#include "solvers/parts/contact_operator.hpp"

namespace ballast {

/// Anderson acceleration of a fixed point x = G(x). Walker, Ni 2011, "Anderson acceleration for
/// fixed-point iterations" (type II: the combination of past steps whose residuals cancel best).
/// Remembers differences of the last `memory` pairs (G(x), G(x) - x). Storage is kept between uses.
class Anderson {
 public:
  void reset(int memory);
  void forget() {
    count_ = 0;
    primed_ = false;
  }

  /// x := the accelerated next iterate, given x and its image G(x). The first call after forget()
  /// gives x := G(x).
  void step(Eigen::VectorXd& x, const Eigen::VectorXd& image);

 private:
  Eigen::VectorXd combine() const;

  int memory_ = 0, count_ = 0, next_ = 0;
  bool primed_ = false;
  Eigen::VectorXd last_image_, last_residual_, residual_;
  std::vector<Eigen::VectorXd> image_steps_, residual_steps_;
  Eigen::MatrixXd gram_;
};

/// s, one value [m/s] >= 0 per contact; 0 for contacts without friction.
class SlipShift {
 public:
  /// s = 0.
  void reset(const ContactOperator& w);

  double operator[](int c) const { return s_[c]; }
  /// u_c + s_c n: the gradient of the convex problem.
  Eigen::Vector3d shifted(const ContactOperator& w, const Eigen::VectorXd& u, int c) const {
    Eigen::Vector3d g = w.at(u, c);
    g[0] += s_[c];
    return g;
  }

  /// s := mu |u_T|.
  void follow(const ContactOperator& w, const Eigen::VectorXd& u);
  /// Outer step after an inner solve that gave `u`: moves s towards mu |u_T| by Anderson mixing.
  /// Past steps are forgotten where the distance has more than doubled since the last call.
  void improve(const ContactOperator& w, const Eigen::VectorXd& u);
  /// The distance |s - mu |u_T||, rms over contacts [m/s].
  double distance(const ContactOperator& w, const Eigen::VectorXd& u) const;
  /// |r - P_K(r - rho (u + s n))| / rho, rms over the contacts that move: how far r is from solving
  /// the convex problem with s held [m/s].
  double convex_error(const ContactOperator& w, const Impulses& r, const Eigen::VectorXd& u) const;

 private:
  Eigen::VectorXd s_, image_;
  Anderson mixing_;
  double last_distance_ = 0.0;
};

}  // namespace ballast
