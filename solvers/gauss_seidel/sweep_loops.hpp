#pragma once
// The sweeps over groups for one instruction set: V, its lanes. Included by the sources
// group_kernels_*.cpp alone, after the lanes.
//
// One vector's solution is a chain of divisions that leaves most of a processor idle. So the
// vectors of a group are solved in step, and where registers are as wide as a group, a group of
// each of two runs without a common body.

#include <algorithm>
#include <type_traits>

#include "solvers/gauss_seidel/group_loops.hpp"
#include "solvers/gauss_seidel/law_lanes.hpp"

namespace ballast {

/// Impulses as the sweep finds them: moved along the search, if there is one.
template <bool Search, typename V, typename Run>
BALLAST_INLINE void load_impulses(const Run& run, int g, SearchStep step, int lane, V* r) {
  constexpr int rows = std::extent_v<decltype(run.impulses->y)>;
  for (int i = 0; i < rows; ++i) {
    r[i] = V::load(run.impulses[g].y[i] + lane);
    if constexpr (Search) {
      auto& search = run.search[g];
      const V change = V::load(search.change[i] + lane);
      const V along =
          V::all(step.beta) * V::load(search.direction[i] + lane) + V::all(step.ahead) * change;
      r[i] = r[i] + along;
      (along + V::all(step.gain) * change).store(search.direction[i] + lane);
    }
  }
}

/// A vector of a group with friction: velocities in, the candidates of the law out.
template <typename V>
struct FrictionVector {
  using Run = GroupRun<FrictionGroup<typename V::Number>>;
  V a[6], b[6], r[3];

  template <bool Search>
  BALLAST_INLINE LawLanes<V> load(const Run& run, int g, SearchStep step, int lane,
                                  const void* bodies) {
    const auto& k = run.groups[g];
    load_impulses<Search>(run, g, step, lane, r);
    gather_bodies(bodies, k.body[0] + lane, a);
    gather_bodies(bodies, k.body[1] + lane, b);
    LawLanes<V> law;
    law.s2 = V::load(k.s2 + lane);
    law.c1 = V::load(k.c1 + lane);
    law.c2 = V::load(k.c2 + lane);
    law.mu = V::load(k.mu + lane);
    law.inverse_mu = V::load(k.inverse_mu + lane);
    law.miss = V::load(run.impulses[g].miss + lane);
    law.y = r[0] - velocity(k, 0, lane, a, b);
    law.t1 = r[1] - velocity(k, 1, lane, a, b);
    law.t2 = r[2] - velocity(k, 2, lane, a, b) * V::load(k.inverse_s2 + lane);
    return law;
  }

  template <bool Search>
  BALLAST_INLINE void store(const LawLanes<V>& law, const Run& run, int g, LaneSums<V>& sums,
                            int lane, void* bodies) {
    const V after[3] = {law.y, law.t1, law.t2};
    auto& impulses = run.impulses[g];
    law.miss.store(impulses.miss + lane);
    V e[3];
    for (int i = 0; i < 3; ++i) {
      after[i].store(impulses.y[i] + lane);
      e[i] = after[i] - r[i];
      if constexpr (Search) e[i].store(run.search[g].change[i] + lane);
    }
    if constexpr (Search) sums.add(lane, e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    // Open before and after: nothing moves.
    const V zero = V::all(0.0);
    if (!any(static_cast<typename V::Mask>(differs(e[0], zero) | differs(e[1], zero) |
                                           differs(e[2], zero))))
      return;
    const auto& k = run.groups[g];
    push(k, lane, e, a, b);
    scatter_bodies(bodies, k.body[0] + lane, a);
    scatter_bodies(bodies, k.body[1] + lane, b);
  }
};

/// The i-th group of each of the first `Runs` runs, K vectors of each in step.
template <typename V, int K, int Runs, bool Search, typename Run>
BALLAST_INLINE void sweep_groups(const Run* runs, int i, SearchStep step, LaneSums<V>* sums,
                                 void* bodies) {
  int g[Runs];
  for (int run = 0; run < Runs; ++run) g[run] = runs[run].group(i);
#pragma GCC unroll 4
  for (int lane = 0; lane < group_lanes; lane += K * V::width) {
    FrictionVector<V> vectors[Runs * K];
    LawLanes<V> law[Runs * K];
    typename V::Mask slips{};
    for (int v = 0; v < Runs * K; ++v) {
      law[v] = vectors[v].template load<Search>(runs[v / K], g[v / K], step,
                                                lane + v % K * V::width, bodies);
      open_or_stick(law[v]);
      slips = static_cast<typename V::Mask>(slips | law[v].slips);
    }
    if (any(slips)) slide<V, Runs * K>(law);
    for (int v = 0; v < Runs * K; ++v)
      vectors[v].template store<Search>(law[v], runs[v / K], g[v / K], sums[v / K],
                                        lane + v % K * V::width, bodies);
  }
}

template <typename V, int K, bool Search, typename Run>
BALLAST_INLINE void sweep_friction(const Run* runs, SearchStep step, void* bodies,
                                   double* squares) {
  LaneSums<V> sums[2];
  const int both = K * V::width == group_lanes ? std::min(runs[0].count, runs[1].count) : 0;
  for (int i = 0; i < both; ++i) sweep_groups<V, K, 2, Search>(runs, i, step, sums, bodies);
  for (int run = 0; run < 2; ++run) {
    for (int i = both; i < runs[run].count; ++i)
      sweep_groups<V, K, 1, Search>(runs + run, i, step, sums + run, bodies);
    if constexpr (Search) squares[run] = sums[run].total();
  }
}

template <typename V, int K, bool Search, typename Number>
BALLAST_INLINE double sweep_run(const GroupRun<OneRowGroup<Number>>& run, SearchStep step,
                                BodyRow<Number>* bodies) {
  LaneSums<V> sums;
  for (int i = 0; i < run.count; ++i)
    for (int lane = 0; lane < group_lanes; lane += V::width) {
      const int g = run.group(i);
      const auto& k = run.groups[g];
      V a[6], b[6], r;
      load_impulses<Search>(run, g, step, lane, &r);
      gather_bodies(bodies, k.body[0] + lane, a);
      gather_bodies(bodies, k.body[1] + lane, b);
      const V candidate = r - velocity(k, 0, lane, a, b);
      const V y = keep(static_cast<typename V::Mask>(~at_most(candidate, V::all(0.0))), candidate);
      const V e = y - r;
      y.store(run.impulses[g].y[0] + lane);
      if constexpr (Search) {
        e.store(run.search[g].change[0] + lane);
        sums.add(lane, e * e);
      }
      push(k, lane, &e, a, b);
      scatter_bodies(bodies, k.body[0] + lane, a);
      scatter_bodies(bodies, k.body[1] + lane, b);
    }
  return Search ? sums.total() : 0.0;
}

/// The grains' side in lanes. What the wall adds comes in the order of the lanes.
template <typename V, int K, bool Search, typename Number>
BALLAST_INLINE double sweep_run(const GroupRun<WallGroup<Number>>& run, SearchStep step,
                                BodyRow<Number>* bodies) {
  double sum = 0.0;
  for (int n = 0; n < run.count; ++n) {
    const int g = run.group(n);
    const auto& k = run.groups[g];
    Number& w = *reinterpret_cast<Number*>(at_offset(static_cast<void*>(bodies), k.wall_body));
    for (int lane = 0; lane < group_lanes; lane += V::width) {
      V a[6], b[6], r;
      load_impulses<Search>(run, g, step, lane, &r);
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
      V::load(after).store(run.impulses[g].y[0] + lane);
      if constexpr (Search) e.store(run.search[g].change[0] + lane);
      push(k, lane, &e, a, b);
      scatter_bodies(bodies, k.body[0] + lane, a);
      scatter_bodies(bodies, k.body[1] + lane, b);
    }
  }
  return sum;
}

/// Contacts with friction side by side; of the other kinds one run after the other.
template <typename V, int K, bool Search, typename Group>
BALLAST_INLINE void sweep_loop(const GroupRun<Group>* runs, SearchStep step,
                               BodyRow<typename V::Number>* bodies, double* squares) {
  if constexpr (Group::rows == 3)
    return sweep_friction<V, K, Search>(runs, step, bodies, squares);
  else
    for (int run = 0; run < 2; ++run) {
      const double square = sweep_run<V, K, Search>(runs[run], step, bodies);
      if constexpr (Search) squares[run] = square;
    }
}

}  // namespace ballast
