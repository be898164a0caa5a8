#include "solvers/gauss_seidel/sweep_kernels.hpp"

#include <algorithm>

#include "solvers/gauss_seidel/sweep_lanes.hpp"

namespace ballast {
namespace {

/// Solves one contact and moves its bodies.
BALLAST_INLINE void relax(const FrictionRecord& k, FrictionImpulse& r, BodyVelocity* velocity) {
  double* va = velocity[k.body[0]].w;
  double* vb = velocity[k.body[1]].w;
  const Vector8 wa = load8(va), wb = load8(vb);
  const Vector4 u = relative_velocity(k.rows, wa, wb);
  // The impulse that would stop the contact, then the law.
  double y = r.y[0] - (u[0] + k.bias[0]) * k.local.inverse_normal;
  double t1 = r.y[1] - (u[1] + k.bias[1]) * k.local.inverse_s1;
  double t2 = r.y[2] - (u[2] + k.bias[2]) * k.local.inverse_s2;
  apply_coulomb(k.local, y, t1, t2, r.slip);
  // The bodies feel the change.
  const double dy = y - r.y[0], d1 = t1 - r.y[1], d2 = t2 - r.y[2];
  r.y[0] = y;
  r.y[1] = t1;
  r.y[2] = t2;
  // w += G^T (dy, d1, d2). Of the eight numbers that a row's load brings,
  // two are not the row's: masked.
  store8(va, wa + only_row(load_row(k.rows[0][0]) * dy + load_row(k.rows[0][1]) * d1 +
                           load_row(k.rows[0][2]) * d2));
  store8(vb, wb + only_row(load_row(k.rows[1][0]) * dy + load_row(k.rows[1][1]) * d1 +
                           load_row(k.rows[1][2]) * d2));
}

BALLAST_INLINE void relax(const OneRowRecord& k, double& r, BodyVelocity* velocity) {
  double* va = velocity[k.body[0]].w;
  double* vb = velocity[k.body[1]].w;
  const Vector8 wa = load8(va), wb = load8(vb);
  // Both sides' products stand in eight lanes: halves are added, and then the four that are left.
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
  const Vector4 change = x - before;
  const Vector4 p =
      step.beta * *reinterpret_cast<const Lanes4*>(search.direction) + step.ahead * change;
  using Bits = long long __attribute__((vector_size(32)));
  constexpr Bits three = {-1, -1, -1, 0};
  const Vector4 moved = x + p;
  *reinterpret_cast<Lanes4*>(search.direction) = (Vector4)((Bits)(p + step.gain * change) & three);
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
    const double change = x - search[c].before, along = step.beta * p + step.ahead * change;
    p = along + step.gain * change;
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
  // Velocity from both sides; plain loops, as this way is for comparison.
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

}  // namespace ballast
