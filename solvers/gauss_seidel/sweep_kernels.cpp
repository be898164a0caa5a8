#include "solvers/gauss_seidel/sweep_kernels.hpp"

#include <algorithm>

#include "problems/algebra/contact_error.hpp"

// Vectors are returned by inlined functions only, so GCC's note about their calling convention does
// not apply.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace ballast {
namespace {

// GCC's vector extensions: the same element-wise operations in the same order on every instruction
// set, hence the same bits (-ffp-contract=off keeps multiplications and additions apart).
using Vector8 = double __attribute__((vector_size(64)));
using Vector4 = double __attribute__((vector_size(32)));

#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define BALLAST_FOR_EACH_CPU __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define BALLAST_FOR_EACH_CPU
#endif

#define BALLAST_INLINE inline __attribute__((always_inline))

using Loose8 = double __attribute__((vector_size(64), aligned(8), may_alias));
using Loose4 = double __attribute__((vector_size(32), aligned(8), may_alias));
using Lanes4 = double __attribute__((vector_size(32), may_alias));
using Loose2 = double __attribute__((vector_size(16), aligned(8), may_alias));

BALLAST_INLINE Vector8 load8(const double* x) { return *reinterpret_cast<const Vector8*>(x); }
/// A row, and the two numbers that follow it.
BALLAST_INLINE Vector8 load_row(const double* x) { return *reinterpret_cast<const Loose8*>(x); }
/// Zero in place of what follows a row.
BALLAST_INLINE Vector8 only_row(const Vector8& x) {
  using Bits = long long __attribute__((vector_size(64)));
  constexpr Bits keep = {-1, -1, -1, -1, -1, -1, 0, 0};
  return (Vector8)((Bits)x & keep);
}
BALLAST_INLINE void store_row(double* x, const Vector8& value) {
  *reinterpret_cast<Loose4*>(x) = __builtin_shufflevector(value, value, 0, 1, 2, 3);
  *reinterpret_cast<Loose2*>(x + 4) = __builtin_shufflevector(value, value, 4, 5);
}
BALLAST_INLINE void store8(double* x, const Vector8& value) {
  *reinterpret_cast<Vector8*>(x) = value;
}

BALLAST_INLINE Vector4 halves(const Vector8& x) {
  return __builtin_shufflevector(x, x, 0, 1, 2, 3) + __builtin_shufflevector(x, x, 4, 5, 6, 7);
}

/// The sums of three vectors' entries.
BALLAST_INLINE Vector4 three_sums(const Vector8& x, const Vector8& y, const Vector8& z) {
  const Vector4 p = halves(x), q = halves(y), s = halves(z);
  const Vector4 pq =
      __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7);
  const Vector4 ss =
      __builtin_shufflevector(s, s, 0, 0, 2, 2) + __builtin_shufflevector(s, s, 1, 1, 3, 3);
  return __builtin_shufflevector(pq, ss, 0, 1, 4, 5) + __builtin_shufflevector(pq, ss, 2, 3, 6, 7);
}

/// G w over both sides.
BALLAST_INLINE Vector4 relative_velocity(const FrictionRecord& k, const Vector8& wa,
                                         const Vector8& wb) {
  return three_sums(load_row(k.rows[0][0]) * wa + load_row(k.rows[1][0]) * wb,
                    load_row(k.rows[0][1]) * wa + load_row(k.rows[1][1]) * wb,
                    load_row(k.rows[0][2]) * wa + load_row(k.rows[1][2]) * wb);
}

/// Row i times row j, lane by lane, over both sides.
BALLAST_INLINE Vector8 row_product(const FrictionRecord& k, int i, int j) {
  return only_row(load_row(k.rows[0][i]) * load_row(k.rows[0][j]) +
                  load_row(k.rows[1][i]) * load_row(k.rows[1][j]));
}

}  // namespace

namespace {

/// Solves one contact and moves its bodies.
BALLAST_INLINE void relax(const FrictionRecord& k, FrictionImpulse& r, BodyVelocity* velocity) {
  double* va = velocity[k.body[0]].w;
  double* vb = velocity[k.body[1]].w;
  const Vector8 wa = load8(va), wb = load8(vb);
  const Vector4 u = relative_velocity(k, wa, wb);
  double y = r.y[0] - (u[0] + k.bias[0]) * k.local.inverse_normal;
  double t1 = r.y[1] - (u[1] + k.bias[1]) * k.local.inverse_s1;
  double t2 = r.y[2] - (u[2] + k.bias[2]) * k.local.inverse_s2;
  apply_coulomb(k.local, y, t1, t2, r.slip);
  const double dy = y - r.y[0], d1 = t1 - r.y[1], d2 = t2 - r.y[2];
  r.y[0] = y;
  r.y[1] = t1;
  r.y[2] = t2;
  store8(va, wa + only_row(load_row(k.rows[0][0]) * dy + load_row(k.rows[0][1]) * d1 +
                           load_row(k.rows[0][2]) * d2));
  store8(vb, wb + only_row(load_row(k.rows[1][0]) * dy + load_row(k.rows[1][1]) * d1 +
                           load_row(k.rows[1][2]) * d2));
}

BALLAST_INLINE void relax(const OneRowRecord& k, double& r, BodyVelocity* velocity) {
  double* va = velocity[k.body[0]].w;
  double* vb = velocity[k.body[1]].w;
  const Vector8 wa = load8(va), wb = load8(vb);
  const Vector4 p = halves(load_row(k.rows[0]) * wa + load_row(k.rows[1]) * wb);
  const double candidate = r - ((p[0] + p[1]) + (p[2] + p[3]) + k.bias) * k.inverse_normal;
  const double y = candidate <= 0.0 ? 0.0 : candidate;
  const double dy = y - r;
  r = y;
  store8(va, wa + only_row(load_row(k.rows[0]) * dy));
  store8(vb, wb + only_row(load_row(k.rows[1]) * dy));
}

/// Where the bodies of a record are the processor cannot know; records come in a row, but faster
/// than it fetches by itself. A packing larger than the last cache is swept in 0.6 of the time, one
/// within it in the same.
template <typename Record>
BALLAST_INLINE void fetch(const Record* records, int now, int count, const BodyVelocity* velocity) {
  constexpr int bodies_ahead = 8, record_ahead = 16;
  if (now + record_ahead < count) {
    const char* lines = reinterpret_cast<const char*>(records + now + record_ahead);
    for (size_t line = 0; line < sizeof(Record); line += 64) __builtin_prefetch(lines + line);
  }
  if (now + bodies_ahead < count)
    for (const int body : records[now + bodies_ahead].body) __builtin_prefetch(&velocity[body], 1);
}

/// y, and the slip root in lane 3 left alone. Everything in the lanes at once: off the chain of
/// velocities it costs nothing.
BALLAST_INLINE void move_along(const SearchStep& step, FrictionImpulse& r, ImpulseSearch& search) {
  const Vector4 x = *reinterpret_cast<const Lanes4*>(r.y),
                before = *reinterpret_cast<const Lanes4*>(search.before);
  const Vector4 p = step.beta * *reinterpret_cast<const Lanes4*>(search.direction);
  using Bits = long long __attribute__((vector_size(32)));
  constexpr Bits three = {-1, -1, -1, 0};
  const Vector4 moved = x + p;
  *reinterpret_cast<Lanes4*>(search.direction) =
      (Vector4)((Bits)(p + step.gain * (x - before)) & three);
  *reinterpret_cast<Lanes4*>(search.before) = (Vector4)((Bits)moved & three);
  for (int i = 0; i < 3; ++i) r.y[i] = moved[i];
}

BALLAST_INLINE double change_square(const FrictionImpulse& r, const ImpulseSearch& search) {
  const double d0 = r.y[0] - search.before[0], d1 = r.y[1] - search.before[1],
               d2 = r.y[2] - search.before[2];
  return d0 * d0 + d1 * d1 + d2 * d2;
}

}  // namespace

BALLAST_FOR_EACH_CPU
void sweep_friction(const FrictionRecord* records, FrictionImpulse* impulses, int count,
                    BodyVelocity* velocity) {
  for (int c = 0; c < count; ++c) {
    fetch(records, c, count, velocity);
    relax(records[c], impulses[c], velocity);
  }
}

BALLAST_FOR_EACH_CPU
void sweep_one_row(const OneRowRecord* records, double* impulses, int count,
                   BodyVelocity* velocity) {
  for (int c = 0; c < count; ++c) {
    fetch(records, c, count, velocity);
    relax(records[c], impulses[c], velocity);
  }
}

BALLAST_FOR_EACH_CPU
double sweep_friction(const FrictionRecord* records, FrictionImpulse* impulses,
                      ImpulseSearch* search, SearchStep step, int count, BodyVelocity* velocity) {
  double square = 0.0;
  for (int c = 0; c < count; ++c) {
    fetch(records, c, count, velocity);
    move_along(step, impulses[c], search[c]);
    relax(records[c], impulses[c], velocity);
    square += change_square(impulses[c], search[c]);
  }
  return square;
}

BALLAST_FOR_EACH_CPU
double sweep_one_row(const OneRowRecord* records, double* impulses, OneRowSearch* search,
                     SearchStep step, int count, BodyVelocity* velocity) {
  double square = 0.0;
  for (int c = 0; c < count; ++c) {
    fetch(records, c, count, velocity);
    double &x = impulses[c], &p = search[c].direction;
    const double along = step.beta * p;
    p = along + step.gain * (x - search[c].before);
    x += along;
    search[c].before = x;
    relax(records[c], x, velocity);
    square += (x - search[c].before) * (x - search[c].before);
  }
  return square;
}

void resolve_by_variant(const SweepVariant& variant, const FrictionRecord& k, FrictionImpulse& r,
                        double lambda_max, BodyVelocity* velocity) {
  double* sides[2] = {velocity[k.body[0]].w, velocity[k.body[1]].w};
  double u[3], y[3];
  for (int i = 0; i < 3; ++i) {
    u[i] = k.bias[i];
    y[i] = r.y[i];
    for (int s = 0; s < 2; ++s)
      for (int j = 0; j < row_width; ++j) u[i] += k.rows[s][i][j] * sides[s][j];
  }
  resolve_by_variant(variant, k.local, lambda_max, u, y, r.slip);
  for (int i = 0; i < 3; ++i) {
    const double change = y[i] - r.y[i];
    r.y[i] = y[i];
    for (int s = 0; s < 2; ++s)
      for (int j = 0; j < row_width; ++j) sides[s][j] += k.rows[s][i][j] * change;
  }
}

void resolve_by_variant(const SweepVariant& variant, const OneRowRecord& k, double& r,
                        BodyVelocity* velocity) {
  // Every rule solves one row exactly: what is left is relaxation.
  const double before = r;
  relax(k, r, velocity);
  const double y = std::max(0.0, before + variant.relaxation * (r - before)), change = y - r;
  r = y;
  for (int s = 0; s < 2; ++s)
    for (int j = 0; j < row_width; ++j) velocity[k.body[s]].w[j] += k.rows[s][j] * change;
}

BALLAST_FOR_EACH_CPU
void make_principal(FrictionRecord& k, double mu, TangentTurn& turn, double& lambda_max) {
  const Vector4 first =
      three_sums(row_product(k, 0, 0), row_product(k, 1, 0), row_product(k, 2, 0));
  const Vector4 rest = three_sums(row_product(k, 1, 1), row_product(k, 2, 1), row_product(k, 2, 2));
  Eigen::Matrix3d w;
  w << first[0], first[1], first[2], first[1], rest[0], rest[1], first[2], rest[1], rest[2];
  make_principal(w, mu, k.local, turn);
  lambda_max = largest_eigenvalue(w);

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
  const double weight = k.local.inverse_normal > 0.0 ? 1.0 : 0.0;
  double t1 = weight * r[1], t2 = weight * r[2];
  turn.to_principal(t1, t2);
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
      relative_velocity(k, load8(velocity[k.body[0]].w), load8(velocity[k.body[1]].w));
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
