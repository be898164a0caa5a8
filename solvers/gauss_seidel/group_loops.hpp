#pragma once
// The loops of group_kernels.hpp for one instruction set: V, its lanes. Included by the sources
// group_kernels_*.cpp alone, after the lanes.

#include <type_traits>

#include "solvers/gauss_seidel/body_lanes.hpp"
#include "solvers/gauss_seidel/group_kernels.hpp"
#include "solvers/gauss_seidel/law_lanes.hpp"

namespace ballast {

template <typename V>
BALLAST_INLINE V dot(const typename V::Number (*row)[group_lanes], int lane, const V* w) {
  return (V::load(row[0] + lane) * w[0] + V::load(row[1] + lane) * w[1]) +
         V::load(row[2] + lane) * w[2];
}

/// Row `i` of the contacts' velocities from those of their bodies, bias included.
template <typename V, typename Group>
BALLAST_INLINE V velocity(const Group& k, int i, int lane, const V* a, const V* b) {
  const V apart[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return dot(k.line[i], lane, apart) +
         (dot(k.turn[0][i], lane, a + 3) + dot(k.turn[1][i], lane, b + 3)) +
         V::load(k.bias[i] + lane);
}

/// The bodies feel the impulses e.
template <typename V, typename Group>
BALLAST_INLINE void push(const Group& k, int lane, const V* e, V* a, V* b) {
  constexpr int rows = Group::rows;
  const auto sum = [ lane, e ](const auto& numbers, int j) __attribute__((always_inline)) {
    V result = V::load(numbers[0][j] + lane) * e[0];
    for (int i = 1; i < rows; ++i) result = result + V::load(numbers[i][j] + lane) * e[i];
    return result;
  };
  const V mass_a = V::load(k.inverse_mass[0] + lane), mass_b = V::load(k.inverse_mass[1] + lane);
  for (int j = 0; j < 3; ++j) {
    const V along = sum(k.line, j);
    a[j] = a[j] - mass_a * along;
    b[j] = b[j] + mass_b * along;
    a[3 + j] = a[3 + j] + sum(k.turn[0], j);
    b[3 + j] = b[3 + j] + sum(k.turn[1], j);
  }
}

/// Impulses as the sweep finds them: moved along the search, if there is one.
template <bool Search, typename V, typename Impulses, typename GroupSearch>
BALLAST_INLINE void load_impulses(const Impulses& impulses, GroupSearch* search, SearchStep step,
                                  int lane, V* r) {
  constexpr int rows = std::extent_v<decltype(Impulses::y)>;
  for (int i = 0; i < rows; ++i) {
    r[i] = V::load(impulses.y[i] + lane);
    if constexpr (Search) {
      const V change = V::load(search->change[i] + lane);
      const V along =
          V::all(step.beta) * V::load(search->direction[i] + lane) + V::all(step.ahead) * change;
      r[i] = r[i] + along;
      (along + V::all(step.gain) * change).store(search->direction[i] + lane);
    }
  }
}

/// A sum for each lane of a group, so that its order does not depend on the width of registers.
template <typename V>
struct LaneSums {
  V part[group_lanes / V::width];

  BALLAST_INLINE LaneSums() {
    for (V& p : part) p = V::all(0.0);
  }
  BALLAST_INLINE void add(int lane, V value) {
    part[lane / V::width] = part[lane / V::width] + value;
  }
  BALLAST_INLINE double total() const {
    alignas(64) typename V::Number numbers[group_lanes];
    for (int lane = 0; lane < group_lanes; lane += V::width)
      part[lane / V::width].store(numbers + lane);
    double sum = 0.0;
    for (const auto number : numbers) sum += number;
    return sum;
  }
};

/// K vectors of a group with friction from `lane` on: velocities in, the candidates of the law out.
template <typename V, int K>
struct FrictionBlock {
  V a[K][6], b[K][6], r[K][3];
  LawLanes<V> law[K];

  template <bool Search, typename Impulses, typename GroupSearch>
  BALLAST_INLINE void load(const FrictionGroup<typename V::Number>& k, const Impulses& impulses,
                           GroupSearch* search, SearchStep step, int lane, const void* bodies,
                           int v) {
    load_impulses<Search>(impulses, search, step, lane, r[v]);
    gather_bodies(bodies, k.body[0] + lane, a[v]);
    gather_bodies(bodies, k.body[1] + lane, b[v]);
    law[v].s2 = V::load(k.s2 + lane);
    law[v].c1 = V::load(k.c1 + lane);
    law[v].c2 = V::load(k.c2 + lane);
    law[v].mu = V::load(k.mu + lane);
    law[v].inverse_mu = V::load(k.inverse_mu + lane);
    law[v].miss = V::load(impulses.miss + lane);
    law[v].y = r[v][0] - velocity(k, 0, lane, a[v], b[v]);
    law[v].t1 = r[v][1] - velocity(k, 1, lane, a[v], b[v]);
    law[v].t2 = r[v][2] - velocity(k, 2, lane, a[v], b[v]) * V::load(k.inverse_s2 + lane);
  }

  template <bool Search, typename Impulses, typename GroupSearch>
  BALLAST_INLINE void store(const FrictionGroup<typename V::Number>& k, Impulses& impulses,
                            GroupSearch* search, LaneSums<V>& sums, int lane, void* bodies, int v) {
    const V after[3] = {law[v].y, law[v].t1, law[v].t2};
    law[v].miss.store(impulses.miss + lane);
    V e[3];
    for (int i = 0; i < 3; ++i) {
      after[i].store(impulses.y[i] + lane);
      e[i] = after[i] - r[v][i];
      if constexpr (Search) e[i].store(search->change[i] + lane);
    }
    if constexpr (Search) sums.add(lane, e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    // Open before and after: nothing moves.
    const V zero = V::all(0.0);
    if (!any(static_cast<typename V::Mask>(differs(e[0], zero) | differs(e[1], zero) |
                                           differs(e[2], zero))))
      return;
    push(k, lane, e, a[v], b[v]);
    scatter_bodies(bodies, k.body[0] + lane, a[v]);
    scatter_bodies(bodies, k.body[1] + lane, b[v]);
  }
};

template <typename V, int K, bool Search, typename Impulses, typename GroupSearch>
BALLAST_INLINE double sweep_loop(const FrictionGroup<typename V::Number>* groups,
                                 Impulses* impulses, GroupSearch* search, SearchStep step,
                                 int count, BodyRow<typename V::Number>* bodies) {
  LaneSums<V> sums;
  for (int g = 0; g < count; ++g) {
#pragma GCC unroll 4
    for (int lane = 0; lane < group_lanes; lane += K * V::width) {
      FrictionBlock<V, K> block;
      for (int v = 0; v < K; ++v) {
        block.template load<Search>(groups[g], impulses[g], search + g, step, lane + v * V::width,
                                    bodies, v);
        open_or_stick(block.law[v]);
      }
      typename V::Mask slips = block.law[0].slips;
      for (int v = 1; v < K; ++v) slips = static_cast<typename V::Mask>(slips | block.law[v].slips);
      if (any(slips)) slide<V, K>(block.law);
      for (int v = 0; v < K; ++v)
        block.template store<Search>(groups[g], impulses[g], search + g, sums, lane + v * V::width,
                                     bodies, v);
    }
  }
  return Search ? sums.total() : 0.0;
}

template <typename V, int K, bool Search, typename Impulses, typename GroupSearch>
BALLAST_INLINE double sweep_loop(const OneRowGroup<typename V::Number>* groups, Impulses* impulses,
                                 GroupSearch* search, SearchStep step, int count,
                                 BodyRow<typename V::Number>* bodies) {
  LaneSums<V> sums;
  for (int g = 0; g < count; ++g)
    for (int lane = 0; lane < group_lanes; lane += V::width) {
      const auto& k = groups[g];
      V a[6], b[6], r;
      load_impulses<Search>(impulses[g], search + g, step, lane, &r);
      gather_bodies(bodies, k.body[0] + lane, a);
      gather_bodies(bodies, k.body[1] + lane, b);
      const V candidate = r - velocity(k, 0, lane, a, b);
      const V y = keep(static_cast<typename V::Mask>(~at_most(candidate, V::all(0.0))), candidate);
      const V e = y - r;
      y.store(impulses[g].y[0] + lane);
      if constexpr (Search) {
        e.store(search[g].change[0] + lane);
        sums.add(lane, e * e);
      }
      push(k, lane, &e, a, b);
      scatter_bodies(bodies, k.body[0] + lane, a);
      scatter_bodies(bodies, k.body[1] + lane, b);
    }
  return Search ? sums.total() : 0.0;
}

/// The grains' side in lanes. What the wall adds comes in the order of the lanes.
template <typename V, int K, bool Search, typename Impulses, typename GroupSearch>
BALLAST_INLINE double sweep_loop(const WallGroup<typename V::Number>* groups, Impulses* impulses,
                                 GroupSearch* search, SearchStep step, int count,
                                 BodyRow<typename V::Number>* bodies) {
  using Number = typename V::Number;
  double sum = 0.0;
  for (int g = 0; g < count; ++g) {
    const auto& k = groups[g];
    Number& w = *reinterpret_cast<Number*>(at_offset(static_cast<void*>(bodies), k.wall_body));
    for (int lane = 0; lane < group_lanes; lane += V::width) {
      V a[6], b[6], r;
      load_impulses<Search>(impulses[g], search + g, step, lane, &r);
      gather_bodies(bodies, k.body[0] + lane, a);
      gather_bodies(bodies, k.body[1] + lane, b);
      alignas(64) Number without_wall[V::width], before[V::width], after[V::width],
          change[V::width];
      (r - velocity(k, 0, lane, a, b)).store(without_wall);
      r.store(before);
      for (int i = 0; i < V::width; ++i) {
        const Number at = k.wall[lane + i], candidate = without_wall[i] - at * w;
        after[i] = candidate <= 0 ? 0 : candidate;
        change[i] = after[i] - before[i];
        w += at * change[i];
        if constexpr (Search) sum += change[i] * change[i];
      }
      const V e = V::load(change);
      V::load(after).store(impulses[g].y[0] + lane);
      if constexpr (Search) e.store(search[g].change[0] + lane);
      push(k, lane, &e, a, b);
      scatter_bodies(bodies, k.body[0] + lane, a);
      scatter_bodies(bodies, k.body[1] + lane, b);
    }
  }
  return sum;
}

template <typename V, typename Group, typename Impulses>
BALLAST_INLINE void push_loop(const Group* groups, const Impulses* impulses, int count,
                              BodyRow<typename V::Number>* bodies) {
  using Number = typename V::Number;
  for (int g = 0; g < count; ++g)
    for (int lane = 0; lane < group_lanes; lane += V::width) {
      const Group& k = groups[g];
      V a[6], b[6], r[Group::rows];
      for (int i = 0; i < Group::rows; ++i) r[i] = V::load(impulses[g].y[i] + lane);
      gather_bodies(bodies, k.body[0] + lane, a);
      gather_bodies(bodies, k.body[1] + lane, b);
      push(k, lane, r, a, b);
      scatter_bodies(bodies, k.body[0] + lane, a);
      scatter_bodies(bodies, k.body[1] + lane, b);
      if constexpr (requires { k.wall; }) {
        Number& w = *reinterpret_cast<Number*>(at_offset(static_cast<void*>(bodies), k.wall_body));
        for (int i = lane; i < lane + V::width; ++i) w += k.wall[i] * impulses[g].y[0][i];
      }
    }
}

/// A plain loop over the bodies' numbers: each compiler flag makes its own registers of it. V tells
/// the instruction sets' functions apart.
template <typename V, typename Number>
BALLAST_INLINE void move_bodies_loop(int count, SearchStep step, Number* __restrict w,
                                     Number* __restrict before, Number* __restrict direction) {
  const Number beta = static_cast<Number>(step.beta), gain = static_cast<Number>(step.gain),
               ahead = static_cast<Number>(step.ahead);
  for (int i = 0; i < 8 * count; ++i) {
    const Number change = w[i] - before[i], along = beta * direction[i] + ahead * change,
                 moved = w[i] + along;
    direction[i] = along + gain * change;
    w[i] = moved;
    before[i] = moved;
  }
}

}  // namespace ballast
