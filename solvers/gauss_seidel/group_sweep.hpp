#pragma once
// The sweeps over groups (group_kernels.hpp) for one instruction set: V, its lanes. Only
// kernel_table.hpp includes this.
//
// One vector's solution is a chain of divisions that leaves most of a processor idle. So the
// vectors of a group are solved in step, and where registers are as wide as a group, a group of
// each of two runs without a common body.

#include <algorithm>
#include <type_traits>

#include "solvers/gauss_seidel/group_kernels.hpp"
#include "solvers/gauss_seidel/lanes.hpp"

namespace ballast {

template <typename V, typename Number>
BALLAST_INLINE V dot(const Number (*row)[group_lanes], int lane, const V* w) {
  return (V::load(row[0] + lane) * w[0] + V::load(row[1] + lane) * w[1]) +
         V::load(row[2] + lane) * w[2];
}

/// Row `i` of the contacts' velocities from those of their bodies, and `bias`.
template <typename V, typename Group, typename Number>
BALLAST_INLINE V velocity(const Group& k, const Number (*bias)[group_lanes], int i, int lane,
                          const V* a, const V* b) {
  const V apart[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return dot(k.line[i], lane, apart) +
         (dot(k.turn[0][i], lane, a + 3) + dot(k.turn[1][i], lane, b + 3)) +
         V::load(bias[i] + lane);
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

/// Groups in single precision have the offsets of such bodies. Those in double stand twice as far.
template <typename Number, typename Group>
constexpr int offset_scale = sizeof(Number) / sizeof(typename Group::Number);

/// L^T v of the wall that a group's contacts are on.
template <typename Group, typename Body>
BALLAST_INLINE auto& wall_velocity(const Group& k, Body* bodies) {
  return at_offset(bodies, offset_scale<typename Body::Number, Group> * k.wall_body)->w[0];
}

/// GroupLoops::push
template <typename V, typename Group>
void push_loop(const Group* groups, const typename GroupLoops<Group>::Impulses* impulses, int count,
               BodyRow<double>* bodies) {
  constexpr int scale = offset_scale<typename V::Number, Group>;
  for (int g = 0; g < count; ++g)
    for (int lane = 0; lane < group_lanes; lane += V::width) {
      const Group& k = groups[g];
      V a[6], b[6], r[Group::rows];
      for (int i = 0; i < Group::rows; ++i) r[i] = V::load(impulses[g].y[i] + lane);
      gather_bodies<scale>(bodies, k.body[0] + lane, a);
      gather_bodies<scale>(bodies, k.body[1] + lane, b);
      push(k, lane, r, a, b);
      scatter_bodies<scale>(bodies, k.body[0] + lane, a);
      scatter_bodies<scale>(bodies, k.body[1] + lane, b);
      if constexpr (requires { k.wall; })
        for (int i = lane; i < lane + V::width; ++i)
          wall_velocity(k, bodies) +=
              static_cast<double>(k.wall[i]) * static_cast<double>(impulses[g].y[0][i]);
    }
}

/// Plain loops over the bodies' numbers: each compiler flag makes its own registers of them. V
/// tells the instruction sets' functions apart.
template <typename V, typename Number = typename V::Number>
void move_bodies(int count, SearchStep step, BodyRow<Number>* __restrict bodies,
                 BodyRow<Number>* __restrict befores, BodyRow<Number>* __restrict directions) {
  Number *w = bodies->w, *before = befores->w, *direction = directions->w;
  const Number beta = static_cast<Number>(step.beta);
  if (step.is_conjugate)
    for (int i = 0; i < 8 * count; ++i) {
      const Number along = beta * direction[i];
      direction[i] = along + (w[i] - before[i]);
      before[i] = w[i] = w[i] + along;
    }
  else
    for (int i = 0; i < 8 * count; ++i) {
      direction[i] = beta * (direction[i] + (w[i] - before[i]));
      before[i] = w[i] = w[i] + direction[i];
    }
}

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
  const V chosen = keep(lanes, V::all(1.0));
  for (int i = 0; i < V::width; ++i)
    if (chosen.x[i] != 0)
      x.x[i] = static_cast<typename V::Number>(
          slip_root(k.s2.x[i], k.c1.x[i], k.c2.x[i], k.mu.x[i], k.y.x[i], k.t1.x[i], k.t2.x[i]));
  return x;
}

/// The slip branch for K vectors in step, so that one's divisions hide the other's. With x = 1 +
/// lambda, x2 = x + s2 - 1, e = d / y: the root of mu N = R,
///   N = x x2 - c1 e1 x2 - c2 e2 x,   R^2 = (e1 x2)^2 + (e2 x)^2   (see slide() in
///   one_contact.hpp).
///
/// The guess is the root for s2 = 1 in closed form, and by how much that missed the last root: in
/// nine of ten visits it is within 1e-3. Newton steps follow, without a square root: with P = mu N
/// near R, R - P ~ 2 P (R^2 - P^2) / (3 P^2 + R^2). What a step moves tells how near the root is;
/// its own error is the square of that. So most vectors end with the first one; a lane takes a
/// second where the first moved it by more than `near`. In single precision a first step may miss
/// the root by 1e-4: the next visit starts there. A guess beyond a pole may have left for infinity
/// by then, where nothing is less than its own part.
template <typename V, int K>
BALLAST_INLINE void slide(LawLanes<V>* k) {
  using Mask = typename V::Mask;
  constexpr bool is_double = sizeof(typename V::Number) == 8;
  const V one = V::all(1.0), zero = V::all(0.0), near = V::all(is_double ? 3e-7 : 1e-2),
          enough = V::all(is_double ? 3e-7 : 5e-4);
  V d2[K], spread[K], square1[K], square2[K], coupling1[K], coupling2[K], coupling[K], closed[K],
      x[K];
  Mask good[K] = {};
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
  for (const V& limit : {near, enough}) {
    Mask left{};
    for (int v = 0; v < K; ++v) {
      const V x2 = x[v] + spread[v];
      const V n = (x[v] - coupling1[v]) * x2 - coupling2[v] * x[v];
      const V a1 = square1[v] * x2, a2 = square2[v] * x[v];
      const V r_square = a1 * x2 + a2 * x[v];
      const V slope = (x[v] + x2 - coupling[v]) * r_square - n * (a1 + a2);
      const V pressed = k[v].mu * n, p_square = pressed * pressed;
      const V move = (r_square - p_square) * (r_square * (n + n)) /
                     ((p_square + p_square + p_square + r_square) * slope);
      x[v] = select(good[v], x[v], x[v] + move);
      good[v] =
          static_cast<Mask>(good[v] | (less(move, limit * x[v]) & less(zero - move, limit * x[v]) &
                                       less(one, x[v]) & less(zero, pressed)));
      left = static_cast<Mask>(left | (k[v].slips & ~good[v]));
    }
    if (!any(left)) break;
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

/// Impulses as the sweep starts with them.
template <SearchKind how, typename V, typename Run>
BALLAST_INLINE void load_impulses(const Run& run, int g, SearchStep step, int lane, V* r) {
  constexpr int rows = std::extent_v<decltype(run.impulses->y)>;
  for (int i = 0; i < rows; ++i) {
    r[i] = V::load(run.impulses[g].y[i] + lane);
    if constexpr (how == SearchKind::momentum)
      r[i] = r[i] + step.beta * V::load(run.search[g].change[i] + lane);
    if constexpr (how == SearchKind::conjugate) {
      auto& search = run.search[g];
      V direction = V::load(search.direction[i] + lane);
      step.move(V::load(search.change[i] + lane), direction, r[i]);
      direction.store(search.direction[i] + lane);
    }
  }
}

/// Impulses as the sweep leaves them, and what the search keeps of it. Out: e, what it changed.
/// With momentum x_k - x_k-1 is the sum of both moves, as for the bodies: the difference of the
/// impulses would carry the rounding of each move on to all later ones.
template <SearchKind how, typename V, typename Run>
BALLAST_INLINE void store_impulses(const Run& run, int g, SearchStep step, int lane, const V* r,
                                   const V* after, V* e) {
  constexpr int rows = std::extent_v<decltype(run.impulses->y)>;
  for (int i = 0; i < rows; ++i) {
    e[i] = after[i] - r[i];
    after[i].store(run.impulses[g].y[i] + lane);
    if constexpr (how != SearchKind::none) {
      auto* change = run.search[g].change[i] + lane;
      if constexpr (how == SearchKind::momentum)
        (step.beta * V::load(change) + e[i]).store(change);
      else
        e[i].store(change);
    }
  }
}

/// A vector of a group with friction: velocities in, the candidates of the law out.
template <typename V>
struct FrictionVector {
  using Run = GroupRun<FrictionGroup<typename V::Number>>;
  V a[6], b[6], r[3];

  template <SearchKind how>
  BALLAST_INLINE LawLanes<V> load(const Run& run, int g, SearchStep step, int lane,
                                  const void* bodies) {
    const auto& k = run.groups[g];
    load_impulses<how>(run, g, step, lane, r);
    gather_bodies(bodies, k.body[0] + lane, a);
    gather_bodies(bodies, k.body[1] + lane, b);
    LawLanes<V> law;
    law.s2 = V::load(k.s2 + lane);
    law.c1 = V::load(k.c1 + lane);
    law.c2 = V::load(k.c2 + lane);
    law.mu = V::load(k.mu + lane);
    law.inverse_mu = V::load(k.inverse_mu + lane);
    law.miss = V::load(run.impulses[g].miss + lane);
    law.y = r[0] - velocity(k, k.bias, 0, lane, a, b);
    law.t1 = r[1] - velocity(k, k.bias, 1, lane, a, b);
    law.t2 = r[2] - velocity(k, k.bias, 2, lane, a, b) * V::load(k.inverse_s2 + lane);
    return law;
  }

  template <SearchKind how>
  BALLAST_INLINE void store(const LawLanes<V>& law, const Run& run, int g, SearchStep step,
                            LaneSums<V>& sums, int lane, void* bodies) {
    const V after[3] = {law.y, law.t1, law.t2};
    law.miss.store(run.impulses[g].miss + lane);
    V e[3];
    store_impulses<how>(run, g, step, lane, r, after, e);
    if constexpr (how != SearchKind::none) sums.add(lane, e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
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

template <typename Element>
BALLAST_INLINE void prefetch(const Element& element) {
  const char* bytes = reinterpret_cast<const char*>(&element);
#pragma GCC unroll 96
  for (size_t at = 0; at < sizeof element; at += 64) __builtin_prefetch(bytes + at);
}

/// The i-th group of each of the first `Runs` runs, K vectors of each in step.
template <typename V, int K, int Runs, SearchKind how, bool Far, typename Run>
BALLAST_INLINE void sweep_groups(const Run* runs, int i, SearchStep step, LaneSums<V>* sums,
                                 void* bodies) {
  int g[Runs];
  for (int run = 0; run < Runs; ++run) {
    g[run] = runs[run].group(i);
    if constexpr (Far) {
      const int next = runs[run].group(std::min(i + 1, runs[run].count - 1));
      prefetch(runs[run].groups[next]);
      prefetch(runs[run].impulses[next]);
      if constexpr (how == SearchKind::momentum) prefetch(runs[run].search[next].change);
      if constexpr (how == SearchKind::conjugate) prefetch(runs[run].search[next]);
    }
  }
#pragma GCC unroll 4
  for (int lane = 0; lane < group_lanes; lane += K * V::width) {
    FrictionVector<V> vectors[Runs * K];
    LawLanes<V> law[Runs * K];
    typename V::Mask slips{};
    for (int v = 0; v < Runs * K; ++v) {
      law[v] = vectors[v].template load<how>(runs[v / K], g[v / K], step, lane + v % K * V::width,
                                             bodies);
      open_or_stick(law[v]);
      slips = static_cast<typename V::Mask>(slips | law[v].slips);
    }
    if (any(slips)) slide<V, Runs * K>(law);
    for (int v = 0; v < Runs * K; ++v)
      vectors[v].template store<how>(law[v], runs[v / K], g[v / K], step, sums[v / K],
                                     lane + v % K * V::width, bodies);
  }
}

template <typename V, int K, SearchKind how, bool Far, typename Run>
BALLAST_INLINE void sweep_friction(const Run* runs, SearchStep step, void* bodies,
                                   double* squares) {
  LaneSums<V> sums[2];
  const int both = K * V::width == group_lanes ? std::min(runs[0].count, runs[1].count) : 0;
  for (int i = 0; i < both; ++i) sweep_groups<V, K, 2, how, Far>(runs, i, step, sums, bodies);
  for (int run = 0; run < 2; ++run) {
    for (int i = both; i < runs[run].count; ++i)
      sweep_groups<V, K, 1, how, Far>(runs + run, i, step, sums + run, bodies);
    if constexpr (how != SearchKind::none) squares[run] = sums[run].total();
  }
}

/// The impulses of a vector of contacts on a wall, one after the other. In: `y`, what would stop
/// them if the wall stood still; `r`, the impulses until now. The wall's velocity `w` goes along.
template <typename V, typename Number = typename V::Number>
BALLAST_INLINE V solve_on_wall(const Number* wall, V y, V r, Number& w) {
  alignas(64) Number before[V::width], after[V::width];
  r.store(before);
  y.store(after);
  for (int i = 0; i < V::width; ++i) {
    const Number candidate = after[i] - wall[i] * w;
    after[i] = candidate <= 0 ? 0 : candidate;
    w += wall[i] * (after[i] - before[i]);
  }
  return V::load(after);
}

/// Groups of one row. Of contacts on a wall the grains' side is in lanes; what the wall sees comes
/// in the order of the lanes, and so does the sum.
template <typename V, SearchKind how, typename Group>
BALLAST_INLINE double sweep_run(const GroupRun<Group>& run, SearchStep step,
                                BodyRow<typename V::Number>* bodies) {
  constexpr bool on_wall = requires(Group k) { k.wall; };
  LaneSums<V> sums;
  double sum = 0.0;
  for (int n = 0; n < run.count; ++n) {
    const int g = run.group(n);
    const auto& k = run.groups[g];
    for (int lane = 0; lane < group_lanes; lane += V::width) {
      V a[6], b[6], r;
      load_impulses<how>(run, g, step, lane, &r);
      gather_bodies(bodies, k.body[0] + lane, a);
      gather_bodies(bodies, k.body[1] + lane, b);
      V y = r - velocity(k, k.bias, 0, lane, a, b);
      if constexpr (on_wall)
        y = solve_on_wall(k.wall + lane, y, r, wall_velocity(k, bodies));
      else
        y = keep(static_cast<typename V::Mask>(~at_most(y, V::all(0.0))), y);
      V e;
      store_impulses<how>(run, g, step, lane, &r, &y, &e);
      if constexpr (how != SearchKind::none && !on_wall) sums.add(lane, e * e);
      if constexpr (how != SearchKind::none && on_wall) {
        alignas(64) typename V::Number changes[V::width];
        e.store(changes);
        for (const auto change : changes) sum += change * change;
      }
      push(k, lane, &e, a, b);
      scatter_bodies(bodies, k.body[0] + lane, a);
      scatter_bodies(bodies, k.body[1] + lane, b);
    }
  }
  return on_wall ? sum : sums.total();
}

/// Contacts with friction side by side; of the other kinds one run after the other.
template <typename V, int K, SearchKind how, typename Group>
BALLAST_INLINE void sweep_runs(const GroupRun<Group>* runs, SearchStep step,
                               BodyRow<typename V::Number>* bodies, double* squares) {
  if constexpr (Group::rows == 3)
    runs[0].is_far ? sweep_friction<V, K, how, true>(runs, step, bodies, squares)
                   : sweep_friction<V, K, how, false>(runs, step, bodies, squares);
  else
    for (int run = 0; run < 2; ++run) {
      const double square = sweep_run<V, how>(runs[run], step, bodies);
      if constexpr (how != SearchKind::none) squares[run] = square;
    }
}

/// GroupLoops::sweep
template <typename V, int K, typename Group>
void sweep_loop(const GroupRun<Group> (&runs)[2], const SearchStep* step,
                BodyRow<typename V::Number>* bodies, double (&squares)[2]) {
  if (!step)
    sweep_runs<V, K, SearchKind::none>(runs, {}, bodies, squares);
  else if (step->is_conjugate)
    sweep_runs<V, K, SearchKind::conjugate>(runs, *step, bodies, squares);
  else
    sweep_runs<V, K, SearchKind::momentum>(runs, *step, bodies, squares);
}

}  // namespace ballast
