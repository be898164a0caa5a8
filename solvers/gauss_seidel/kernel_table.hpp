#pragma once
// The table of kernels of one instruction set, and the loops of group_kernels.hpp that make records
// and the judge's error. Only the sources group_kernels_*.cpp include this.

#include "solvers/gauss_seidel/group_sweep.hpp"

namespace ballast {

/// Returns entry (i, j) of W_cc, computed from the rows as given.
template <typename V, typename Group>
BALLAST_INLINE V block_entry(const Group& k, int lane, int i, int j) {
  const auto product = [lane](const auto& x, const auto& y) __attribute__((always_inline)) {
    return (V::load(x[0] + lane) * V::load(y[0] + lane) +
            V::load(x[1] + lane) * V::load(y[1] + lane)) +
           V::load(x[2] + lane) * V::load(y[2] + lane);
  };
  const V mass = V::load(k.inverse_mass[0] + lane) + V::load(k.inverse_mass[1] + lane);
  return product(k.line[i], k.line[j]) * mass +
         (product(k.turn[0][i], k.turn[0][j]) + product(k.turn[1][i], k.turn[1][j]));
}

/// Returns 1 / x; 1 where x is not positive (a lane without a contact: its zero rows stay zero).
template <typename V>
BALLAST_INLINE V inverse_or_one(V x) {
  const V one = V::all(1.0);
  return select(less(V::all(0.0), x), one / x, one);
}

template <typename V>
BALLAST_INLINE void times(double* numbers, V factor) {
  (V::load(numbers) * factor).store(numbers);
}

/// Returns the largest eigenvalue of symmetric 3 x 3 blocks, as largest_eigenvalue() finds it.
template <typename V>
BALLAST_INLINE V largest_eigenvalue_lanes(V nn, V tn, V sn, V tt, V st, V ss) {
  const V zero = V::all(0.0), one = V::all(1.0);
  const V off = tn * tn + sn * sn + st * st, mean = (nn + (tt + ss)) * V::all(1.0 / 3.0);
  const V x = nn - mean, y = tt - mean, z = ss - mean;
  const V square = (x * x + y * y + z * z + 2.0 * off) * V::all(1.0 / 6.0);
  const V spread = square_root(square);
  const V determinant = x * (y * z - st * st) - tn * (tn * z - st * sn) + sn * (tn * st - y * sn);
  const V cosine = V::all(0.5) + 0.25 * determinant / (square * spread);
  const V not_below = keep(less(zero, cosine), cosine);
  const V s = square_root(select(less(one, not_below), one, not_below));
  V w = V::all(0.57729) + s * (V::all(-0.10927) + s * (V::all(0.04318) - 0.01123 * s));
  for (int step = 0; step < 2; ++step)
    w = w - (w * w * (V::all(3.0) + 2.0 * s * w) - one) / (6.0 * w * (one + s * w));
  // A (nearly) diagonal block needs its own case: with equal entries the fractions above are 0 / 0.
  const V two = select(less(nn, tt), tt, nn), three = select(less(two, ss), ss, two);
  const auto turned =
      static_cast<typename V::Mask>(less(zero, off) & differs(square * spread, zero));
  return select(turned, mean + spread * (one + 2.0 * s * w), three);
}

/// make_principal() of solvers/parts/one_contact.cpp for the lanes of a register.
template <typename V>
BALLAST_INLINE void make_principal_lanes(FrictionGroup<double>& k, GroupFrame& f, int lane) {
  const V zero = V::all(0.0), one = V::all(1.0), half = V::all(0.5), rounding = V::all(0x1p-52);
  const V w00 = block_entry<V>(k, lane, 0, 0), w10 = block_entry<V>(k, lane, 1, 0),
          w20 = block_entry<V>(k, lane, 2, 0), w11 = block_entry<V>(k, lane, 1, 1),
          w21 = block_entry<V>(k, lane, 2, 1), w22 = block_entry<V>(k, lane, 2, 2);
  const V inverse = inverse_or_one(w00), given_c1 = w10 * inverse, given_c2 = w20 * inverse;
  const V p = w11 - given_c1 * w10, q = w21 - given_c1 * w20, r = w22 - given_c2 * w20;
  // The eigenvectors of S, by the form that does not cancel.
  const V middle = half * (p + r), delta = half * (p - r), h = square_root(delta * delta + q * q);
  const auto turned = less(zero, h), second = less(delta, zero);
  const V inverse_h = inverse_or_one(h), size = select(second, zero - delta, delta);
  const V large = square_root(half + half * size * inverse_h), small = half * q * inverse_h / large;
  const V cosine = select(turned, select(second, large, small), one),
          sine = select(turned, select(second, zero - small, zero - large), zero);
  const V trace = w00 + w11 + w22;
  const V least = rounding * trace, low = middle - h, high = middle + h;
  const V s1 = select(less(low, least), least, low), s2 = select(less(high, least), least, high);
  const V c1 = cosine * given_c1 + sine * given_c2, c2 = cosine * given_c2 - sine * given_c1;

  // A lane without a contact: n = t = s2 = 1.
  const auto there = less(zero, w00);
  // 0 tells make_group() that nothing moves the contact along its normal, up to rounding.
  keep(less(V::all(0.25) * rounding * trace, w00),
       largest_eigenvalue_lanes(w00, w10, w20, w11, w21, w22))
      .store(f.lambda_max + lane);
  const V n = square_root(select(there, w00, one)), t = square_root(select(there, s1, one));
  const V over_n = one / n, over_t = one / t;
  const V mu = V::load(f.mu + lane), scaled_mu = mu * t * over_n;
  n.store(f.normal + lane);
  over_n.store(f.inverse_normal + lane);
  t.store(f.tangent + lane);
  over_t.store(f.inverse_tangent + lane);
  cosine.store(f.cosine + lane);
  sine.store(f.sine + lane);
  const V ratio = select(there, s2 / s1, one);
  ratio.store(k.s2 + lane);
  (one / ratio).store(k.inverse_s2 + lane);
  (c1 * n * over_t).store(k.c1 + lane);
  (c2 * n * over_t).store(k.c2 + lane);
  scaled_mu.store(k.mu + lane);
  inverse_or_one(scaled_mu).store(k.inverse_mu + lane);

  // The normal row over n; the tangent rows turned, minus c times the normal row, over t.
  const auto change = [&](double* normal, double* first, double* second_row)
      __attribute__((always_inline)) {
    const V x = V::load(normal), y = V::load(first), z = V::load(second_row);
    (x * over_n).store(normal);
    ((cosine * y + sine * z - c1 * x) * over_t).store(first);
    ((cosine * z - sine * y - c2 * x) * over_t).store(second_row);
  };
  change(f.bias[0] + lane, f.bias[1] + lane, f.bias[2] + lane);
  for (int j = 0; j < 3; ++j) {
    change(k.line[0][j] + lane, k.line[1][j] + lane, k.line[2][j] + lane);
    for (auto& turn : k.turn) change(turn[0][j] + lane, turn[1][j] + lane, turn[2][j] + lane);
  }
}

/// The same for one-row contacts, where W_cc is a number.
template <typename V, typename Group>
BALLAST_INLINE void make_principal_lanes(Group& k, GroupFrame& f, int lane) {
  V w = block_entry<V>(k, lane, 0, 0);
  if constexpr (requires { k.wall; }) {
    const V wall = V::load(k.wall + lane);
    w = w + wall * wall;
  }
  const V n = square_root(select(less(V::all(0.0), w), w, V::all(1.0))), over_n = V::all(1.0) / n;
  n.store(f.normal + lane);
  over_n.store(f.inverse_normal + lane);
  w.store(f.lambda_max + lane);
  times(f.bias[0] + lane, over_n);
  for (int j = 0; j < 3; ++j) {
    times(k.line[0][j] + lane, over_n);
    for (auto& turn : k.turn) times(turn[0][j] + lane, over_n);
  }
  if constexpr (requires { k.wall; }) times(k.wall + lane, over_n);
}

/// ExactLoops::make_principal
template <typename V, typename Group>
void make_principal_loop(Group& group, GroupFrame& frame) {
  for (int lane = 0; lane < group_lanes; lane += V::width)
    make_principal_lanes<V>(group, frame, lane);
}

/// Returns the square of the judge's scaled natural map |r - P_K(r - rho (u + mu |u_T| n))| / rho
/// (see problems/algebra/friction_cone.hpp).
template <typename V, typename Number>
BALLAST_INLINE V natural_map_square(const FrictionGroup<Number>& k, const GroupFrame& f, int lane,
                                    const V* r, const V* moved) {
  const V zero = V::all(0.0), c1 = V::load(k.c1 + lane), c2 = V::load(k.c2 + lane),
          t = V::load(f.tangent + lane), over_t = V::load(f.inverse_tangent + lane),
          mu = V::load(f.mu + lane), lambda = V::load(f.lambda_max + lane);
  // Impulse and velocity in the problem's units, along the principal tangents.
  const V rn = (r[0] - c1 * r[1] - c2 * r[2]) * V::load(f.inverse_normal + lane),
          r1 = r[1] * over_t, r2 = r[2] * over_t;
  const V un = moved[0] * V::load(f.normal + lane), u1 = (moved[1] + c1 * moved[0]) * t,
          u2 = (moved[2] + c2 * moved[0]) * t;
  const V rho = inverse_or_one(lambda);
  const V xn = rn - rho * (un + mu * square_root(u1 * u1 + u2 * u2)), x1 = r1 - rho * u1,
          x2 = r2 - rho * u2;
  // The projection onto the cone.
  const V tangential = square_root(x1 * x1 + x2 * x2);
  const auto polar = at_most(mu * tangential, zero - xn), inside = at_most(tangential, mu * xn);
  const V n = (mu * tangential + xn) / (V::all(1.0) + mu * mu),
          scale = mu * n / select(less(zero, tangential), tangential, V::all(1.0));
  const auto projected = [&](V inner, V outer) __attribute__((always_inline)) {
    return select(polar, zero, select(inside, inner, outer));
  };
  const V en = rn - projected(xn, n), e1 = r1 - projected(x1, scale * x1),
          e2 = r2 - projected(x2, scale * x2);
  return (en * en + e1 * e1 + e2 * e2) * (lambda * lambda);
}

/// The same for one-row contacts: the square of n |y' - max(0, y' - u')|.
template <typename V, typename Group>
requires(Group::rows == 1) BALLAST_INLINE V
    natural_map_square(const Group&, const GroupFrame& f, int lane, const V* r, const V* moved) {
  const V candidate = r[0] - moved[0];
  const V e = (r[0] - select(less(candidate, V::all(0.0)), V::all(0.0), candidate)) *
              V::load(f.normal + lane);
  return select(less(V::all(0.0), V::load(f.lambda_max + lane)), e * e, V::all(0.0));
}

/// Computes the contacts' velocities, including a wall's part. In double with the contacts' own
/// bias, in single precision with that of the sweeps.
template <typename V, typename Group>
BALLAST_INLINE void contact_velocities(const Group& k, const GroupFrame& f, int lane,
                                       const BodyRow<typename V::Number>* bodies, V* moved) {
  constexpr int scale = offset_scale<typename V::Number, Group>;
  V a[6], b[6];
  gather_bodies<scale>(bodies, k.body[0] + lane, a);
  gather_bodies<scale>(bodies, k.body[1] + lane, b);
  for (int i = 0; i < Group::rows; ++i)
    if constexpr (V::is_double)
      moved[i] = velocity(k, f.bias, i, lane, a, b);
    else
      moved[i] = velocity(k, k.bias, i, lane, a, b);
  if constexpr (requires { k.wall; })
    moved[0] = moved[0] + wall_velocity(k, bodies) * V::load(k.wall + lane);
}

/// GroupLoops::error, GroupLoops::rough_error
template <typename V, typename Group>
double error_loop(const Group* groups, const typename GroupLoops<Group>::Impulses* impulses,
                  const GroupFrame* frames, int count, const BodyRow<typename V::Number>* bodies,
                  GroupVelocities<Group::rows>* out) {
  constexpr int rows = Group::rows;
  LaneSums<V> sums;
  for (int g = 0; g < count; ++g) {
    const Group& k = groups[g];
    alignas(64) typename V::Number all_moved[rows][group_lanes];
    for (int lane = 0; lane < group_lanes; lane += V::width) {
      V r[rows], moved[rows];
      contact_velocities(k, frames[g], lane, bodies, moved);
      for (int i = 0; i < rows; ++i) {
        r[i] = V::load(impulses[g].y[i] + lane);
        moved[i].store(all_moved[i] + lane);
      }
      sums.add(lane, natural_map_square(k, frames[g], lane, r, moved));
    }
    if (!out) continue;
    for (int i = 0; i < rows; ++i)
      for (int lane = 0; lane < group_lanes; ++lane)
        out[g].u[i][lane] = static_cast<float>(all_moved[i][lane]);
  }
  return sums.total();
}

/// `D`, `V`: registers of doubles and of the group's numbers, K of which are solved side by side.
template <typename V, typename D, int K, typename Group>
constexpr GroupLoops<Group> group_loops{sweep_loop<V, K, Group>, push_loop<D, Group>,
                                        error_loop<D, Group>, error_loop<V, Group>};
template <typename D, int K, typename Group>
constexpr ExactLoops<Group> exact_loops{group_loops<D, D, K, Group>, make_principal_loop<D, Group>};

/// The kernels for registers of `Bytes` bytes that solve so many vectors of each type side by side.
template <int Bytes, int DoubleVectors, int SingleVectors>
constexpr GroupKernels kernels_of(const char* instruction_set) {
  using D = Lanes<double, Bytes>;
  using S = Lanes<float, Bytes>;
  constexpr int d = DoubleVectors, s = SingleVectors;
  return {instruction_set,
          {{exact_loops<D, d, FrictionGroup<double>>, exact_loops<D, d, OneRowGroup<double>>,
            exact_loops<D, d, WallGroup<double>>},
           move_bodies<D>},
          {{group_loops<S, D, s, FrictionGroup<float>>, group_loops<S, D, s, OneRowGroup<float>>,
            group_loops<S, D, s, WallGroup<float>>},
           move_bodies<S>}};
}

}  // namespace ballast
