#pragma once
// The inner loops of the wide sweep (group_record.hpp), for each instruction set. All give the same
// bits.

#include <vector>

#include "solvers/gauss_seidel/group_record.hpp"
#include "solvers/gauss_seidel/search_step.hpp"

namespace ballast {

/// Groups that follow each other, their impulses and, for a search, its numbers.
template <typename Group>
struct GroupRun {
  const Group* groups;
  GroupImpulses<typename Group::Number, Group::rows>* impulses;
  GroupSearch<typename Group::Number, Group::rows>* search;
  const int* awake;  ///< those that are swept, ascending; null: the first `count`
  int count;         ///< of those that are swept

  int group(int i) const { return awake ? awake[i] : i; }
};

/// The loops over groups of one kind. All take the groups in order.
template <typename Group>
struct GroupLoops {
  using Number = typename Group::Number;
  using Impulses = GroupImpulses<Number, Group::rows>;
  using Search = GroupSearch<Number, Group::rows>;
  using Body = BodyRow<Number>;
  using Run = GroupRun<Group>;

  /// Every contact once. The two runs share no body; they may be swept side by side, which hides
  /// one's divisions behind the other's and leaves the same bits.
  void (*sweep)(const Run (&runs)[2], Body* bodies);
  /// The same; each impulse first takes the step of the search (search_step.hpp). The bodies must
  /// have taken it before. `squares`: the sum over each run's contacts of |change|^2.
  void (*search)(const Run (&runs)[2], SearchStep step, Body* bodies, double (&squares)[2]);
  /// All impulses push their bodies once.
  void (*push)(const Group* groups, const Impulses* impulses, int count, Body* bodies);
};

/// What is done in double alone.
template <typename Group>
struct ExactLoops : GroupLoops<Group> {
  /// The same kind of group with numbers of 32 bits.
  using Single = typename Group::template Of<float>;

  /// From rows and bias as given, and mu in the frames, to the group's coordinates.
  void (*make_principal)(Group* groups, GroupFrame* frames, int count);
  /// The sum over contacts of the judge's scaled natural map squared [m^2/s^2]. The contacts'
  /// velocities become the biases of `single`, where that is not null.
  double (*error)(const Group* groups, const typename GroupLoops<Group>::Impulses* impulses,
                  const GroupFrame* frames, int count, const BodyRow<double>* bodies,
                  Single* single);
};

/// `count` bodies that follow each other take the step of the search.
template <typename Number>
using MoveBodies = void (*)(int count, SearchStep step, BodyRow<Number>* w, BodyRow<Number>* before,
                            BodyRow<Number>* direction);

/// All loops of one kind of numbers.
struct ExactKernels {
  ExactLoops<FrictionGroup<double>> friction;
  ExactLoops<OneRowGroup<double>> one_row;
  ExactLoops<WallGroup<double>> wall;
  MoveBodies<double> move_bodies;
};
struct SingleKernels {
  GroupLoops<FrictionGroup<float>> friction;
  GroupLoops<OneRowGroup<float>> one_row;
  GroupLoops<WallGroup<float>> wall;
  MoveBodies<float> move_bodies;
};

struct GroupKernels {
  const char* instruction_set;
  ExactKernels exact;
  SingleKernels single;
};

/// Of the best instruction set that this processor has.
const GroupKernels& group_kernels();
/// Of all that it has, the best first.
const std::vector<const GroupKernels*>& all_group_kernels();

}  // namespace ballast
