#pragma once
// Lorentz's cone L = {x : x_0 >= |x_1..|} of three rows, or the half-line of one: Nesterov-Todd
// scaling and the Jordan algebra that an interior point needs. Nesterov, Todd 1997; formulas of
// Vandenberghe 2010, "The CVXOPT linear and quadratic cone program solvers".
//
// Half-lines are padded: x_1 = x_2 = 0, and every formula below stays right for x_0 alone.

#include <Eigen/Dense>

namespace ballast::lorentz {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

/// x_0 - |x_1..|: > 0 inside.
double depth(const Vector& x);
/// Jordan product (x.y, x_0 y_1.. + y_0 x_1..).
Vector product(const Vector& x, const Vector& y);
/// y with product(x, y) = z, x inside.
Vector divide(const Vector& x, const Vector& z);
/// The largest step t in [0, most] with x + t d in the cone, x inside.
double longest_step(const Vector& x, const Vector& d, double most);

/// F is symmetric positive definite and maps L onto itself; F x = F^-1 z = lambda.
struct Scaling {
  Matrix f = Matrix::Identity(), f_inverse = Matrix::Identity();
  Vector lambda = Vector::Zero();
  /// F^2 = sum of eigenvalue_i a_i a_i^T with a_i the columns of `axes`; each eigenvalue is exact
  /// to rounding, however far apart they are.
  Vector eigenvalues = Vector::Ones();
  Matrix axes = Matrix::Identity();

  /// axes diag(f(eigenvalues)) axes^T.
  template <typename Function>
  Matrix of_square(const Function& function) const {
    return axes *
           Vector(function(eigenvalues[0]), function(eigenvalues[1]), function(eigenvalues[2]))
               .asDiagonal() *
           axes.transpose();
  }
};
/// x and z are inside; `half_line`: only entry 0 of each counts. False: by rounding one is not.
bool scale(const Vector& x, const Vector& z, bool half_line, Scaling& scaling);

}  // namespace ballast::lorentz
