#pragma once
// The inner loops of the Gauss-Seidel sweep over bodies, and the records that they read in order.
//
// Bodies in the variables w = L^T v (M = L L^T, unit mass), contacts in the coordinates of PrincipalContact:
//   (u_N, u_T - c u_N) = sum over sides G w + bias,   w += G^T (y, r_T) changes,   G = A H L^-T
// so that each side is one block, read once, for both directions. Rows and velocities are padded to one cache line.

#include "solvers/one_contact.hpp"
#include "solvers/sweep_variant.hpp"

namespace ballast {

constexpr int body_width = 8;

/// L^T v of one body; unused entries are zero.
struct alignas(64) BodyVelocity {
  double w[body_width];
};

/// All a sweep needs of a contact with friction: eight cache lines.
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

/// Every record once, in order.
void sweep_friction(FrictionRecord* records, int count, BodyVelocity* velocity);
void sweep_one_row(OneRowRecord* records, int count, BodyVelocity* velocity);

/// One record another way (sweep_variant.hpp).
void resolve_by_variant(const SweepVariant& variant, FrictionRecord& record, double lambda_max, BodyVelocity* velocity);
void resolve_by_variant(const SweepVariant& variant, OneRowRecord& record, double lambda_max, BodyVelocity* velocity);

/// From H L^-T and the given bias in the record to its principal coordinates; also lambda_max(W_cc).
void make_principal(FrictionRecord& record, double mu, TangentTurn& turn, double& lambda_max);
void make_principal(OneRowRecord& record, double& lambda_max);

/// w += G^T (y, r_T) for impulses that start a solve; those that move nothing along the normal are dropped.
void load_impulse(FrictionRecord& record, const TangentTurn& turn, const double* r, BodyVelocity* velocity);
void load_impulse(OneRowRecord& record, const double* r, BodyVelocity* velocity);

/// The judge's scaled natural map at the current iterate [m/s].
double natural_map(const FrictionRecord& record, double lambda_max, const BodyVelocity* velocity);
double natural_map(const OneRowRecord& record, double lambda_max, const BodyVelocity* velocity);

}  // namespace ballast
