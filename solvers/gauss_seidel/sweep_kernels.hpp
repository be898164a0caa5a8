#pragma once
// The inner loops of the Gauss-Seidel sweep over bodies, and the records that they read in order.
//
// Bodies in the variables w = L^T v (M = L L^T, unit mass), contacts in the coordinates of
// PrincipalContact:
//   (u_N, u_T - c u_N) = sum over sides G w + bias,   w += G^T (y, r_T) changes,   G = A H L^-T
// so that each side is one block, read once, for both directions. Rows and velocities are padded to
// one cache line.

#include "solvers/gauss_seidel/sweep_variant.hpp"
#include "solvers/parts/one_contact.hpp"

namespace ballast {

constexpr int body_width = 8;
constexpr int row_width = 6;

/// L^T v of one body; unused entries are zero.
struct alignas(64) BodyVelocity {
  double w[body_width];
};

/// What a sweep reads of a contact with friction: six cache lines. Rows are six wide and read eight
/// at a time: what follows a row is finite, and meets the two entries of a body's velocity that are
/// zero.
struct alignas(64) FrictionRecord {
  double rows[2][3][row_width];  ///< G for body a, then b
  double bias[3];                ///< in the coordinates of the rows
  PrincipalContact local;
  int body[2];  ///< a and b in the velocities
};
static_assert(sizeof(FrictionRecord) == 6 * 64);

/// What a sweep writes of it, apart: methods that combine iterates pass over these alone.
struct alignas(32) FrictionImpulse {
  double y[3];  ///< (y, r_T)
  double slip;  ///< the last slip root, first guess of the next
};

/// Of a search that combines sweeps: where the last sweep began, and the direction. Lane 3 is zero.
struct alignas(64) ImpulseSearch {
  double before[4], direction[4];
};
struct OneRowSearch {
  double before = 0.0, direction = 0.0;
};

/// With x the impulse that the last sweep left: p := beta p + gain (x - before), x += beta p (the
/// old p), before := x.
struct SearchStep {
  double beta = 0.0, gain = 0.0;
};

struct alignas(64) OneRowRecord {
  double rows[2][row_width];
  double bias, inverse_normal;
  int body[2];
};

/// Every record once, in order.
void sweep_friction(const FrictionRecord* records, FrictionImpulse* impulses, int count,
                    BodyVelocity* velocity);
void sweep_one_row(const OneRowRecord* records, double* impulses, int count,
                   BodyVelocity* velocity);

/// The same; each impulse first moves along its search direction. The velocities must have moved
/// before: all of them, by the same step. Returns the sum over contacts of |impulse after - impulse
/// moved|^2.
double sweep_friction(const FrictionRecord* records, FrictionImpulse* impulses,
                      ImpulseSearch* search, SearchStep step, int count, BodyVelocity* velocity);
double sweep_one_row(const OneRowRecord* records, double* impulses, OneRowSearch* search,
                     SearchStep step, int count, BodyVelocity* velocity);

/// One record another way (sweep_variant.hpp).
void resolve_by_variant(const SweepVariant& variant, const FrictionRecord& record,
                        FrictionImpulse& impulse, double lambda_max, BodyVelocity* velocity);
void resolve_by_variant(const SweepVariant& variant, const OneRowRecord& record, double& impulse,
                        BodyVelocity* velocity);

/// From H L^-T and the given bias in the record to its principal coordinates; also
/// lambda_max(W_cc).
void make_principal(FrictionRecord& record, double mu, TangentTurn& turn, double& lambda_max);
void make_principal(OneRowRecord& record, double& lambda_max);

/// w += G^T (y, r_T) for impulses that start a solve; those that move nothing along the normal are
/// dropped. `r`: in the given frame.
void load_impulse(const FrictionRecord& record, const TangentTurn& turn, const double* r,
                  FrictionImpulse& impulse, BodyVelocity* velocity);
void load_impulse(const OneRowRecord& record, const double* r, double& impulse,
                  BodyVelocity* velocity);
/// The impulse in the given contact frame.
void store_impulse(const FrictionRecord& record, const TangentTurn& turn,
                   const FrictionImpulse& impulse, double* r);

/// The judge's scaled natural map at the current iterate [m/s].
double natural_map(const FrictionRecord& record, const FrictionImpulse& impulse, double lambda_max,
                   const BodyVelocity* velocity);
double natural_map(const OneRowRecord& record, double impulse, double lambda_max,
                   const BodyVelocity* velocity);

}  // namespace ballast
