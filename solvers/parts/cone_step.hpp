#pragma once
// One step of a primal-dual interior point on the contacts' cones: Nesterov-Todd scaling,
// Mehrotra's predictor and corrector, one sparse factorisation. The s of slip_shift.hpp is held.
//
// Each contact is a pair in Lorentz's cone, x = (mu r_N, r_T) and z = (g_N / mu, g_T), where g is
// the dual variable that becomes u + s n; without friction a pair on the half-line, x = r_N, z =
// g_N, and r_T = 0. With S = diag(mu, 1, 1), F the scaling (F x = F^-1 z = lambda) and the residual
// e = u + s n - g, a step solves
//
//   (W + P) dr = -e + S F (lambda \ c),   P = S F^2 S,   dg = S (F (lambda \ c) - F^2 S dr)
//
// first with c = -lambda o lambda (predictor), then with c = sigma nu 1 - lambda o lambda
// - (F dx) o (F^-1 dz) (corrector), nu the mean of x.z. o and \ are the Jordan product and its
// inverse.

#include <vector>

#include "solvers/parts/shifted_delassus.hpp"
#include "solvers/parts/slip_shift.hpp"

/// Lorentz's cone L = {x : x_0 >= |x_1..|} of three rows, or the half-line of one: Nesterov-Todd
/// scaling and the Jordan algebra that an interior point needs. Nesterov, Todd 1997; formulas of
/// Vandenberghe 2010, "The CVXOPT linear and quadratic cone program solvers".
namespace ballast::lorentz {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

/// Half-lines are padded: x_1 = x_2 = 0, and every formula below stays right for x_0 alone.

/// x_0 - |x_1..|: > 0 inside.
double depth(const Vector& x);
/// Jordan product (x.y, x_0 y_1.. + y_0 x_1..).
Vector product(const Vector& x, const Vector& y);
/// y with product(x, y) = z, x inside.
Vector divide(const Vector& x, const Vector& z);
/// The largest step t in [0, most] with x + t d in the cone, x inside.
double longest_step(const Vector& x, const Vector& d, double most);

/// F symmetric positive definite, maps L onto itself, F x = F^-1 z = lambda.
struct Scaling {
  Matrix f = Matrix::Identity(), f_inverse = Matrix::Identity();
  Vector lambda = Vector::Zero();
  /// F^2 = sum of eigenvalue_i a_i a_i^T, a_i the columns of `axes`: each eigenvalue exact to
  /// rounding, however far apart.
  Vector eigenvalues = Vector::Ones();
  Matrix axes = Matrix::Identity();

  /// axes f(eigenvalue) axes^T.
  template <typename Function>
  Matrix of_square(const Function& function) const {
    return axes *
           Vector(function(eigenvalues[0]), function(eigenvalues[1]), function(eigenvalues[2]))
               .asDiagonal() *
           axes.transpose();
  }
};
/// x and z inside; `half_line`: only entry 0 of each. False: one of them is not inside by rounding.
bool scale(const Vector& x, const Vector& z, bool half_line, Scaling& scaling);

}  // namespace ballast::lorentz

namespace ballast {

struct ConeStepSettings {
  double to_boundary = 0.99;   ///< of the longest step inside the cones
  int refinements = 1;         ///< of each linear solve, against the scaling's huge range
  double least_shift = 1e-12;  ///< the scaling's eigenvalues stay above this, below its inverse,
                               ///< times lambda_max(W_cc)
};

/// A point inside the cones, one entry per row.
struct ConePoint {
  Eigen::VectorXd r;  ///< impulses [N s]
  Eigen::VectorXd g;  ///< dual variable [m/s]
};

class ConeStep {
 public:
  explicit ConeStep(const ConeStepSettings& settings = {}) : settings_(settings) {}

  /// `w` must stay prepared for the same problem. Throws what sparse factors throw.
  void prepare(ContactOperator& w);
  /// FrontLu::use_team
  void use_team(WorkerTeam* team) { system_.use_team(team); }

  /// Scales the cones at `point` and factors. False: the point is not inside by rounding, or the
  /// matrix not definite; then advance() must not be called.
  bool factor(const ConePoint& point);
  /// nu: the mean of x.z over the contacts that move [J], at the point of factor().
  double barrier() const;
  /// Moves the point of factor() by predictor and corrector; `u` are the velocities that its
  /// impulses give. False: the new point is not finite.
  bool advance(const SlipShift& shift, const Eigen::VectorXd& u, ConePoint& point);

  /// The impulse at the head of x, x_0 [N s], summed over the contacts that move, and their number.
  double head_impulses(const Eigen::VectorXd& r) const;
  int moving_contacts() const;

 private:
  using Vector = lorentz::Vector;

  bool moves(int c) const { return w_->rho()[c] > 0.0; }
  bool half_line(int c) const { return !(w_->friction(c) > 0.0); }
  Vector to_cone(const Eigen::VectorXd& r, int c) const;
  Vector to_dual(const Eigen::VectorXd& g, int c) const;
  Vector from_dual(const Vector& z, int c) const;

  bool scale_contact(const ConePoint& point, int c);
  void solve_newton(const SlipShift& shift, const Eigen::VectorXd& u, const ConePoint& point);
  double longest(const ConePoint& point, double part) const;

  ConeStepSettings settings_;
  ContactOperator* w_ = nullptr;
  ShiftedDelassus system_;
  std::vector<lorentz::Scaling> scaling_;
  std::vector<Eigen::Matrix3d> sigma_, shift_blocks_;  ///< P^-1, P
  std::vector<Vector> target_;                         ///< c above
  Eigen::VectorXd right_, dr_, dg_;
};

}  // namespace ballast
