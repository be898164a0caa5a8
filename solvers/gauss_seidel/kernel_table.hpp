#pragma once
// The table of one instruction set. Included by the sources group_kernels_*.cpp alone.

#include "solvers/gauss_seidel/exact_loops.hpp"
#include "solvers/gauss_seidel/sweep_loops.hpp"

namespace ballast {

template <typename V, int K, typename Group>
struct LoopsOf {
  using Loops = GroupLoops<Group>;
  using Impulses = typename Loops::Impulses;
  using Run = typename Loops::Run;
  using Body = typename Loops::Body;

  static void sweep(const Run (&runs)[2], Body* bodies) {
    sweep_loop<V, K, false>(runs, {}, bodies, nullptr);
  }
  static void search(const Run (&runs)[2], SearchStep step, Body* bodies, double (&squares)[2]) {
    sweep_loop<V, K, true>(runs, step, bodies, squares);
  }
  static void push(const Group* groups, const Impulses* impulses, int count, Body* bodies) {
    push_loop<V>(groups, impulses, count, bodies);
  }
  static constexpr Loops loops() { return {sweep, search, push}; }
};

template <typename V, int K, typename Group>
struct ExactLoopsOf : LoopsOf<V, K, Group> {
  using Impulses = typename LoopsOf<V, K, Group>::Impulses;
  using Single = typename ExactLoops<Group>::Single;

  static void make_principal(Group* groups, GroupFrame* frames, int count) {
    make_principal_loop<V>(groups, frames, count);
  }
  static double error(const Group* groups, const Impulses* impulses, const GroupFrame* frames,
                      int count, const BodyRow<double>* bodies, Single* single) {
    return error_loop<V>(groups, impulses, frames, count, bodies, single);
  }
  static constexpr ExactLoops<Group> exact() {
    return {LoopsOf<V, K, Group>::loops(), make_principal, error};
  }
};

template <typename V>
void move_bodies(int count, SearchStep step, BodyRow<typename V::Number>* w,
                 BodyRow<typename V::Number>* before, BodyRow<typename V::Number>* direction) {
  move_bodies_loop<V>(count, step, w->w, before->w, direction->w);
}

/// So many vectors of doubles, of singles are solved side by side.
template <typename Doubles, int DoubleVectors, typename Singles, int SingleVectors>
constexpr GroupKernels kernels_of(const char* instruction_set) {
  return {instruction_set,
          {ExactLoopsOf<Doubles, DoubleVectors, FrictionGroup<double>>::exact(),
           ExactLoopsOf<Doubles, DoubleVectors, OneRowGroup<double>>::exact(),
           ExactLoopsOf<Doubles, DoubleVectors, WallGroup<double>>::exact(), move_bodies<Doubles>},
          {LoopsOf<Singles, SingleVectors, FrictionGroup<float>>::loops(),
           LoopsOf<Singles, SingleVectors, OneRowGroup<float>>::loops(),
           LoopsOf<Singles, SingleVectors, WallGroup<float>>::loops(), move_bodies<Singles>}};
}

}  // namespace ballast
