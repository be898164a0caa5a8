#pragma once
// The table of one instruction set. Included by the sources group_kernels_*.cpp alone.

#include "solvers/gauss_seidel/exact_loops.hpp"

namespace ballast {

template <typename V, int K, typename Group>
struct LoopsOf {
  using Loops = GroupLoops<Group>;
  using Impulses = typename Loops::Impulses;
  using Search = typename Loops::Search;
  using Body = typename Loops::Body;

  static void sweep(const Group* groups, Impulses* impulses, int count, Body* bodies) {
    sweep_loop<V, K, false>(groups, impulses, static_cast<Search*>(nullptr), {}, count, bodies);
  }
  static double search(const Group* groups, Impulses* impulses, Search* search, SearchStep step,
                       int count, Body* bodies) {
    return sweep_loop<V, K, true>(groups, impulses, search, step, count, bodies);
  }
  static void push(const Group* groups, const Impulses* impulses, int count, Body* bodies) {
    push_loop<V>(groups, impulses, count, bodies);
  }
  static void make_principal(Group* groups, GroupFrame* frames, int count) {
    make_principal_loop<V>(groups, frames, count);
  }
  static double error(const Group* groups, const Impulses* impulses, const GroupFrame* frames,
                      int count, const BodyRow<double>* bodies) {
    return error_loop<V>(groups, impulses, frames, count, bodies);
  }
  static constexpr ExactLoops<Group> exact() {
    return {{sweep, search, push}, make_principal, error};
  }
};

template <typename V>
void move_bodies(const int* named, int count, SearchStep step, BodyRow<double>* w,
                 BodyRow<double>* before, BodyRow<double>* direction) {
  move_bodies_loop<V>(named, count, step, w, before, direction);
}

/// K vectors of doubles are solved side by side.
template <typename Doubles, int K>
constexpr GroupKernels kernels_of(const char* instruction_set) {
  return {instruction_set, LoopsOf<Doubles, K, FrictionGroup<double>>::exact(),
          LoopsOf<Doubles, K, OneRowGroup<double>>::exact(),
          LoopsOf<Doubles, K, WallGroup<double>>::exact(), move_bodies<Doubles>};
}

}  // namespace ballast
