#pragma once
// One Gauss-Seidel sweep on the dynamics form, matrix-free: contacts push bodies, bodies carry the motion to other
// contacts.
//
// Bodies in the variables w = L^T v (M = L L^T, unit mass), contacts in the coordinates of PrincipalContact:
//   (u_N, u_T - c u_N) = sum over sides G w + bias,   w += G^T (dy, dr_T),   G = A H L^-T
// so that each side is one block, read once, for both directions.

#include <vector>

#include "problems/friction_problem.hpp"
#include "problems/mass_root.hpp"
#include "solvers/one_contact.hpp"

namespace ballast {

/// A body's or a row's unknowns, padded to one cache line; unused entries are zero.
constexpr int body_width = 8;

/// L^T v of one body, padded.
struct alignas(64) BodyVelocity {
  double w[body_width];
};

/// All a sweep needs of a contact with friction: eight cache lines, read in order.
struct alignas(64) FrictionRecord {
  double rows[2][3][body_width];  ///< G for body a, then b
  double bias[3];                 ///< in the coordinates of the rows
  double y[3];                    ///< (y, r_T): the impulse
  PrincipalContact local;
  double slip;  ///< the last slip root, first guess of the next
  int body[2];  ///< a and b in the velocities

  void impulse(const TangentTurn& turn, double* r) const;  ///< r in the given contact frame
};
static_assert(sizeof(FrictionRecord) == 8 * 64);

struct alignas(64) OneRowRecord {
  double rows[2][body_width];
  double bias, y, inverse_normal;
  int body[2];
};

class BodySweep {
 public:
  /// Records, masses, 1/rho: everything that does not depend on the impulses. `problem` has the dynamics form.
  void prepare(const FrictionProblem& problem);
  /// Takes the impulses and the body velocities that they give.
  void load(const FrictionProblem& problem, const Impulses& r);
  void store(const FrictionProblem& problem, Impulses& r) const;

  /// Every contact once, in the given order.
  void sweep();
  /// The judge's scaled natural map at the current iterate, rms over contacts [m/s].
  double error() const;

 private:
  /// Consecutive contacts of one kind, so that no contact branches on its kind.
  struct Run {
    bool one_row;
    int first_contact, first_record, count;
  };

  void prepare_bodies(const DynamicsForm& dynamics);
  void prepare_friction(const FrictionProblem& problem, int c, int record);
  void prepare_one_row(const FrictionProblem& problem, int c, int record);

  std::vector<MassRoot> roots_;
  std::vector<BodyVelocity> free_velocity_;  ///< L^T v_free; the last body never moves
  std::vector<BodyVelocity> velocity_;
  std::vector<FrictionRecord> friction_;
  std::vector<OneRowRecord> one_row_;
  std::vector<Run> runs_;
  std::vector<TangentTurn> turn_;   ///< per friction record
  std::vector<double> lambda_max_;  ///< per friction record, of W_cc [1/kg]
  std::vector<double> one_row_lambda_max_;
};

}  // namespace ballast
