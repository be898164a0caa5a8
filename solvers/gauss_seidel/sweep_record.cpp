#include "solvers/gauss_seidel/sweep_record.hpp"

#include "problems/algebra/contact_error.hpp"
#include "solvers/gauss_seidel/sweep_lanes.hpp"

namespace ballast {

BALLAST_FOR_EACH_CPU
void make_principal(FrictionRecord& k, double mu, TangentTurn& turn, double& lambda_max) {
  // W_cc = G G^T from six scalar products of rows, several at once.
  const Vector4 first =
      three_sums(row_product(k.rows, 0, 0), row_product(k.rows, 1, 0), row_product(k.rows, 2, 0));
  const Vector4 rest =
      three_sums(row_product(k.rows, 1, 1), row_product(k.rows, 2, 1), row_product(k.rows, 2, 2));
  Eigen::Matrix3d w;
  w << first[0], first[1], first[2], first[1], rest[0], rest[1], first[2], rest[1], rest[2];
  make_principal(w, mu, k.local, turn);
  lambda_max = largest_eigenvalue(w);

  // Tangents turned, and c times the normal row taken off, as PrincipalContact wants it.
  turn.to_principal(k.bias[1], k.bias[2]);
  k.bias[1] -= k.local.c1 * k.bias[0];
  k.bias[2] -= k.local.c2 * k.bias[0];
  for (auto& rows : k.rows) {
    const Vector8 n = load_row(rows[0]), t1 = load_row(rows[1]), t2 = load_row(rows[2]);
    store_row(rows[1], turn.cosine * t1 + turn.sine * t2 - k.local.c1 * n);
    store_row(rows[2], turn.cosine * t2 - turn.sine * t1 - k.local.c2 * n);
  }
}

void make_principal(OneRowRecord& k, double& lambda_max) {
  const Vector4 p = halves(only_row(load_row(k.rows[0]) * load_row(k.rows[0]) +
                                    load_row(k.rows[1]) * load_row(k.rows[1])));
  lambda_max = (p[0] + p[1]) + (p[2] + p[3]);
  k.inverse_normal = lambda_max > 0.0 ? 1.0 / lambda_max : 0.0;
}

void load_impulse(const FrictionRecord& k, const TangentTurn& turn, const double* r,
                  FrictionImpulse& impulse, BodyVelocity* velocity) {
  // An impulse that moves nothing would stay as it was given.
  const double weight = k.local.inverse_normal > 0.0 ? 1.0 : 0.0;
  double t1 = weight * r[1], t2 = weight * r[2];
  turn.to_principal(t1, t2);
  // PrincipalContact's y = r_N + c . r_T stands in place of r_N.
  impulse.y[0] = weight * r[0] + k.local.c1 * t1 + k.local.c2 * t2;
  impulse.y[1] = t1;
  impulse.y[2] = t2;
  for (int s = 0; s < 2; ++s) {
    double* w = velocity[k.body[s]].w;
    const auto& rows = k.rows[s];
    for (int i = 0; i < row_width; ++i)
      w[i] += rows[0][i] * impulse.y[0] + rows[1][i] * impulse.y[1] + rows[2][i] * impulse.y[2];
  }
}

void load_impulse(const OneRowRecord& k, const double* r, double& impulse, BodyVelocity* velocity) {
  impulse = k.inverse_normal > 0.0 ? r[0] : 0.0;
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < row_width; ++i) velocity[k.body[s]].w[i] += k.rows[s][i] * impulse;
}

void store_impulse(const FrictionRecord& k, const TangentTurn& turn, const FrictionImpulse& impulse,
                   double* r) {
  double t1 = impulse.y[1], t2 = impulse.y[2];
  r[0] = impulse.y[0] - k.local.c1 * t1 - k.local.c2 * t2;
  turn.from_principal(t1, t2);
  r[1] = t1;
  r[2] = t2;
}

/// Arguments in registers: through memory, the vectors that the caller's clone makes of them would
/// not be forwarded.
[[gnu::noinline]] double judged(double rn, double r1, double r2, double un, double u1, double u2,
                                double mu, double lambda_max) {
  return ContactJudge::scaled_natural_map({rn, r1, r2}, {un, u1, u2}, mu, lambda_max);
}

BALLAST_FOR_EACH_CPU
double natural_map(const FrictionRecord& k, const FrictionImpulse& r, double lambda_max,
                   const BodyVelocity* velocity) {
  const Vector4 moved =
      relative_velocity(k.rows, load8(velocity[k.body[0]].w), load8(velocity[k.body[1]].w));
  // From the record's (y, r_T) and (u_N, u_T - c u_N) back to r and u, as the judge wants them.
  const double un = moved[0] + k.bias[0];
  return judged(r.y[0] - k.local.c1 * r.y[1] - k.local.c2 * r.y[2], r.y[1], r.y[2], un,
                moved[1] + k.bias[1] + k.local.c1 * un, moved[2] + k.bias[2] + k.local.c2 * un,
                k.local.mu, lambda_max);
}

double natural_map(const OneRowRecord& k, double r, double lambda_max,
                   const BodyVelocity* velocity) {
  double u = k.bias;
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < row_width; ++i) u += k.rows[s][i] * velocity[k.body[s]].w[i];
  return ContactJudge::scaled_natural_map({r, 0.0, 0.0}, {u, 0.0, 0.0}, 0.0, lambda_max);
}

}  // namespace ballast
