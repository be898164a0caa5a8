#pragma once
// The loops of group_kernels.hpp for one instruction set: V, its lanes. Included by the sources
// group_kernels_*.cpp alone, after the lanes.

#include "solvers/gauss_seidel/body_lanes.hpp"
#include "solvers/gauss_seidel/group_kernels.hpp"

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
