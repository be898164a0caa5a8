#pragma once
// Coulomb's law for several contacts at once, in the coordinates of group_record.hpp: what
// apply_coulomb (solvers/parts/one_contact.hpp) says of one.

#include "solvers/gauss_seidel/lanes.hpp"
#include "solvers/gauss_seidel/slip_root.hpp"

namespace ballast {

/// In: the impulses (y, t1, t2) that would stop the contacts. Out: the solutions.
template <typename V>
struct LawLanes {
  V s2, c1, c2, mu, inverse_mu;
  V y, t1, t2;
  V miss;  ///< by how much the closed form missed the last slip root; 0: not known
  typename V::Mask slips;
};

/// Open and sticking contacts are done; `slips` says which are left.
template <typename V>
BALLAST_INLINE void open_or_stick(LawLanes<V>& k) {
  using Mask = typename V::Mask;
  const V zero = V::all(0.0);
  const V limit = k.mu * (k.y - k.c1 * k.t1 - k.c2 * k.t2);
  const Mask open = at_most(k.y, zero);
  const Mask stick =
      static_cast<Mask>(at_most(zero, limit) & at_most(k.t1 * k.t1 + k.t2 * k.t2, limit * limit));
  const Mask closed = static_cast<Mask>(~open);
  k.y = keep(closed, k.y);
  k.t1 = keep(closed, k.t1);
  k.t2 = keep(closed, k.t2);
  k.slips = static_cast<Mask>(~(open | stick));
}

/// The roots of the lanes that the fixed number of steps did not serve: one by one.
template <typename V>
[[gnu::noinline]] V roots_one_by_one(typename V::Mask lanes, const LawLanes<V>& k, V x) {
  using Number = typename V::Number;
  alignas(64) Number s2[V::width], c1[V::width], c2[V::width], mu[V::width], y[V::width],
      t1[V::width], t2[V::width], root[V::width], chosen[V::width];
  k.s2.store(s2);
  k.c1.store(c1);
  k.c2.store(c2);
  k.mu.store(mu);
  k.y.store(y);
  k.t1.store(t1);
  k.t2.store(t2);
  x.store(root);
  keep(lanes, V::all(1.0)).store(chosen);
  for (int i = 0; i < V::width; ++i)
    if (chosen[i] != 0)
      root[i] = static_cast<Number>(slip_root(s2[i], c1[i], c2[i], mu[i], y[i], t1[i], t2[i]));
  return V::load(root);
}

/// The slip branch for K vectors in step, so that one's divisions hide the other's. With x = 1 +
/// lambda, x2 = x + s2 - 1, e = d / y: the root of mu N = R,
///   N = x x2 - c1 e1 x2 - c2 e2 x,   R^2 = (e1 x2)^2 + (e2 x)^2   (see slide() in
///   one_contact.hpp).
///
/// The guess is the root for s2 = 1 in closed form, and by how much that missed the last root: in
/// nine of ten visits it is within 1e-3. Two Newton steps follow, without a branch and without a
/// square root: with P = mu N near R, R - P ~ 2 P (R^2 - P^2) / (3 P^2 + R^2). What the second one
/// moves tells how near the root is; its own error is the square of that. A guess beyond a pole may
/// have left for infinity by then, where nothing is less than its own part.
template <typename V, int K>
BALLAST_INLINE void slide(LawLanes<V>* k) {
  using Mask = typename V::Mask;
  constexpr bool is_double = sizeof(typename V::Number) == 8;
  const V one = V::all(1.0), zero = V::all(0.0), enough = V::all(is_double ? 3e-7 : 5e-4);
  V d2[K], spread[K], square1[K], square2[K], coupling1[K], coupling2[K], coupling[K], closed[K],
      x[K];
  Mask good[K];
  for (int v = 0; v < K; ++v) {
    d2[v] = k[v].s2 * k[v].t2;
    spread[v] = k[v].s2 - one;
    const V over_y = one / k[v].y, e1 = k[v].t1 * over_y, e2 = d2[v] * over_y;
    square1[v] = e1 * e1;
    square2[v] = e2 * e2;
    coupling1[v] = k[v].c1 * e1;
    coupling2[v] = k[v].c2 * e2;
    coupling[v] = coupling1[v] + coupling2[v];
    const V square = square1[v] + square2[v];
    closed[v] =
        square_root(square) * k[v].inverse_mu + coupling[v] - spread[v] * square2[v] / square;
    x[v] = closed[v] + k[v].miss;
  }
  for (int step = 0; step < 2; ++step)
    for (int v = 0; v < K; ++v) {
      const V x2 = x[v] + spread[v];
      const V n = (x[v] - coupling1[v]) * x2 - coupling2[v] * x[v];
      const V a1 = square1[v] * x2, a2 = square2[v] * x[v];
      const V r_square = a1 * x2 + a2 * x[v];
      const V slope = (x[v] + x2 - coupling[v]) * r_square - n * (a1 + a2);
      const V pressed = k[v].mu * n, p_square = pressed * pressed;
      const V move = (r_square - p_square) * (r_square * (n + n)) /
                     ((p_square + p_square + p_square + r_square) * slope);
      x[v] = x[v] + move;
      if (step == 1)
        good[v] = static_cast<Mask>(less(move, enough * x[v]) & less(zero - move, enough * x[v]) &
                                    less(one, x[v]) & less(zero, pressed));
    }
  for (int v = 0; v < K; ++v) {
    const Mask rest = static_cast<Mask>(k[v].slips & ~good[v]);
    if (any(rest)) [[unlikely]] {
      const LawLanes<V> copy = k[v];  // so that k[v] itself need not be in memory
      x[v] = roots_one_by_one(rest, copy, x[v]);
    }
    // x = 0: nothing holds it
    const V x2 = x[v] + spread[v], scale = one / (x[v] * x2);
    const Mask some = static_cast<Mask>(k[v].slips & less(zero, x[v]));
    k[v].t1 = select(k[v].slips, keep(some, k[v].t1 * x2 * scale), k[v].t1);
    k[v].t2 = select(k[v].slips, keep(some, d2[v] * x[v] * scale), k[v].t2);
    k[v].miss = select(some, x[v] - closed[v], keep(static_cast<Mask>(~k[v].slips), k[v].miss));
  }
}

}  // namespace ballast
