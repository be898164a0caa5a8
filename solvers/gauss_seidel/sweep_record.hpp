#pragma once
// What the Gauss-Seidel sweep over bodies keeps of each contact and body, in the order in which it
// is read.
//
// Bodies in the variables w = L^T v (M = L L^T, unit mass), contacts in the coordinates of
// PrincipalContact:
//   (u_N, u_T - c u_N) = sum over sides G w + bias,   w += G^T (y, r_T) changes,   G = A H L^-T
// so that each side is one block, read once, for both directions. Rows and velocities are padded to
// one cache line.

#include "solvers/parts/one_contact.hpp"

namespace ballast {

constexpr int body_width = 8;
constexpr int row_width = 6;

/// L^T v of one body; unused entries are zero.
struct alignas(64) BodyVelocity {
  double w[body_width];
};

/// What a sweep reads of a contact with friction: six cache lines.
///
/// A row has six numbers, but a lane of eight is loaded where it begins. The two that come along
/// belong to what follows in memory: the next row, or after the last row the bias. A record of one
/// row is read in the same way.
///
///   memory    | g0 g1 g2 g3 g4 g5 | h0 h1 h2 h3 h4 h5 | ...       row g, then the next row h
///   loaded      g0 g1 g2 g3 g4 g5   h0 h1                         eight from the row's beginning
///   velocity    w0 w1 w2 w3 w4 w5   0  0                          a body's, padded with zeros
///
/// In a product with a velocity the two are multiplied by zero. They must therefore be finite, and
/// are: rows and bias of a valid problem. Where they would be added to something they are masked
/// (only_row in sweep_lanes.hpp).
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

struct alignas(64) OneRowRecord {
  double rows[2][row_width];
  double bias, inverse_normal;
  int body[2];
};

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
