#pragma once
// A problem's contacts in variables in which every body has the unit mass. With M = L L^T:
//
//   x = L^T v,   G = H L^-T,   x = x_free + G^T r,   u = G x + bias,   W = G G^T
//
// Every body is given six unknowns; those that it lacks meet only zeros. Every contact is given
// three rows in the same way. So all blocks are 3 x 6, and nothing asks for sizes.

#include <functional>
#include <vector>

#include <Eigen/Dense>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// Impulses, or contact velocities, of all contacts: one column each (N, T1, T2).
using ContactColumns = Eigen::Matrix3Xd;

class UnitMassContacts {
 public:
  static constexpr int width = 6;  ///< unknowns of a body
  struct Contact {
    int body[2];  ///< a, b; body_count() for what does not move
    /// No tangential impulse: one row, or no friction.
    bool half_line;
    double friction;
    double lambda_max;  ///< of W_cc [1/kg]; 0: nothing moves here, and the impulse is zero
    Eigen::Vector3d bias;
    Eigen::Matrix<double, 3, width> g[2];
  };

  /// `problem` has the dynamics form. Throws InvalidProblem for a mass that is not positive
  /// definite.
  void prepare(const FrictionProblem& problem);

  int body_count() const { return body_count_; }
  int contact_count() const { return static_cast<int>(contacts_.size()); }
  const Contact& operator[](int c) const { return contacts_[c]; }
  /// Entries of x: six per body, and six zeros for what does not move.
  int unknown_count() const { return width * (body_count_ + 1); }

  /// Each impulse to the nearest point of its cone, zero where nothing moves.
  void from_impulses(const Impulses& r, ContactColumns& columns) const;
  void to_impulses(const ContactColumns& columns, Impulses& r) const;
  void project(ContactColumns& r) const;

  /// x of the impulses r.
  void body_velocity(const ContactColumns& r, Eigen::VectorXd& x) const;
  /// G x of one contact.
  Eigen::Vector3d relative(const Eigen::VectorXd& x, int c) const {
    const Contact& k = contacts_[c];
    return k.g[0] * x.segment<width>(width * k.body[0]) +
           k.g[1] * x.segment<width>(width * k.body[1]);
  }
  /// x += G^T impulse, of one contact.
  void push(Eigen::VectorXd& x, int c, const Eigen::Vector3d& impulse) const {
    const Contact& k = contacts_[c];
    for (int s = 0; s < 2; ++s)
      x.segment<width>(width * k.body[s]).noalias() += k.g[s].transpose() * impulse;
  }
  /// G x + bias of one contact [m/s].
  Eigen::Vector3d velocity(const Eigen::VectorXd& x, int c) const {
    return relative(x, c) + contacts_[c].bias;
  }
  /// The judge's measure of r with the velocity u(c) at contact c [m/s]: scaled natural map, rms
  /// over the contacts that move.
  double error(const ContactColumns& r, const std::function<Eigen::Vector3d(int)>& u) const;

 private:
  int body_count_ = 0;
  std::vector<int> row_begin_;
  std::vector<Contact> contacts_;
  Eigen::VectorXd free_;  ///< x without impulses
};

}  // namespace ballast
