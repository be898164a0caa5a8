#pragma once
// What the wide sweep keeps of contacts and bodies, in the order in which it is read, and its inner
// loops for each instruction set. All give the same bits.
//
// A group has sixteen contacts of which no two share a body. The same number of all its contacts
// stands side by side, one in each lane:
//
//   line[0][0] | c0 c1 c2 ... c15 |    first number of the normal row's linear part
//   line[0][1] | c0 c1 c2 ... c15 |    ...
//
// so that one load takes it for as many contacts as a register holds.
//
// Bodies keep (v, L_r^T omega, 0, 0) with M = diag(m, m, m, L_r L_r^T): v in m/s as it is, because
// the two sides of a contact see it with opposite signs and a contact needs only the difference.
//
// Contacts are in the coordinates of PrincipalContact, scaled so that W_NN = 1 and S = diag(1, s2):
//   N' = N / n,  T' = (T - c N) / t,  y' = n y,  r_T' = t r_T,   n = sqrt(W_NN), t = sqrt(s1)
//   mu' = mu t / n,  c' = c n / t,  s2' = s2 / s1
// The impulse that stops a contact is then its impulse minus its velocity, and Coulomb's law keeps
// its form.

#include <vector>

// Sources for several instruction sets include this: nothing that would be emitted for each.
namespace ballast {

constexpr int group_lanes = 16;

/// A lane that holds no contact has zero rows, leans on a velocity that stays zero, and is open.
template <typename Number_, int Rows>
struct alignas(64) RowGroup {
  using Number = Number_;
  static constexpr int rows = Rows;
  Number line[Rows][3][group_lanes];     ///< linear part of the rows for body b; for a, minus that
  Number turn[2][Rows][3][group_lanes];  ///< angular part of the rows, for a and for b
  Number inverse_mass[2][group_lanes];   ///< of a and b; 0: does not move
  Number bias[Rows][group_lanes];
  int body[2][group_lanes];  ///< a and b: distance of the row of their velocity, in bytes
};

template <typename Number>
struct FrictionGroup : RowGroup<Number, 3> {
  Number s2[group_lanes], inverse_s2[group_lanes], c1[group_lanes], c2[group_lanes],
      mu[group_lanes], inverse_mu[group_lanes];
};

template <typename Number>
struct OneRowGroup : RowGroup<Number, 1> {};

/// Contacts of grains with one and the same body that has one unknown, the driven wall. Its side
/// is a number a contact, and the lanes see its velocity one after the other.
template <typename Number>
struct WallGroup : RowGroup<Number, 1> {
  Number wall[group_lanes];  ///< the row's entry for the wall's unknown L^T v
  int wall_body;             ///< distance of its velocity in bytes
};

/// One thing for each kind of group.
template <template <typename> class Of, typename Number>
struct Kinds {
  Of<FrictionGroup<Number>> friction;
  Of<OneRowGroup<Number>> one_row;
  Of<WallGroup<Number>> wall;
};

/// The impulses y' of a group's contacts.
template <typename Number, int Rows>
struct alignas(64) GroupImpulses {
  Number y[Rows][group_lanes];
  Number miss[group_lanes];  ///< by how much the closed form missed the last slip root (friction)
};

/// The velocities u' of a group's contacts at a look.
template <int Rows>
struct alignas(64) GroupVelocities {
  float u[Rows][group_lanes];
};

/// Of a search that combines sweeps: what the last sweep changed, and the direction.
template <typename Number, int Rows>
struct alignas(64) GroupSearch {
  Number change[Rows][group_lanes], direction[Rows][group_lanes];
};

/// From a group's coordinates to those of the problem. One-row contacts have no tangents.
struct alignas(64) GroupFrame {
  double normal[group_lanes], inverse_normal[group_lanes];    ///< n [kg^-1/2], 1/n
  double tangent[group_lanes], inverse_tangent[group_lanes];  ///< t, 1/t
  double cosine[group_lanes], sine[group_lanes];              ///< of the turn to principal tangents
  double mu[group_lanes];
  double lambda_max[group_lanes];  ///< of W_cc [1/kg]; 0: no contact in this lane
  int contact[group_lanes];        ///< its number in the problem; -1: none
};

template <typename Number>
struct alignas(8 * sizeof(Number)) BodyRow {
  Number w[8];
};

/// The step of a search that combines sweeps. With x the iterate that the last sweep left, `before`
/// the one that it began from and d = x - before: the iterate moves by m = beta p + ahead d. Then
/// p := m + gain d, x += m, before := x.
struct SearchStep {
  double beta = 0.0, gain = 0.0, ahead = 0.0;

  /// Moves numbers `x` that the last sweep changed by `change`. `direction`: their p.
  template <typename Numbers>
  [[gnu::always_inline]] void move(const Numbers& change, Numbers& direction, Numbers& x) const {
    const Numbers along = beta * direction + ahead * change;
    direction = along + gain * change;
    x = x + along;
  }
};

/// Groups that follow each other, their impulses and, for a search, its numbers.
template <typename Group>
struct GroupRun {
  const Group* groups;
  GroupImpulses<typename Group::Number, Group::rows>* impulses;
  GroupSearch<typename Group::Number, Group::rows>* search;
  const int* awake;     ///< those that are swept, ascending; null: the first `count`
  int count;            ///< of those that are swept
  bool is_far = false;  ///< not in a core's cache: a group is fetched while that before it is swept

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
  /// one's divisions behind the other's and leaves the same bits. With a `step` each impulse first
  /// takes it, as the bodies must have before; and `squares` is the sum over each run's contacts of
  /// |change|^2.
  void (*sweep)(const Run (&runs)[2], const SearchStep* step, Body* bodies, double (&squares)[2]);
  /// All impulses push their bodies once.
  void (*push)(const Group* groups, const Impulses* impulses, int count, Body* bodies);
  /// The sum over contacts of the judge's scaled natural map squared [m^2/s^2]. `out` may be null.
  double (*error)(const Group* groups, const Impulses* impulses, const GroupFrame* frames,
                  int count, const Body* bodies, GroupVelocities<Group::rows>* out);
};

/// What is done in double alone.
template <typename Group>
struct ExactLoops : GroupLoops<Group> {
  /// From rows and bias as given, and mu in the frames, to the group's coordinates.
  void (*make_principal)(Group* groups, GroupFrame* frames, int count);
};

/// `count` bodies that follow each other take the step of the search.
template <typename Number>
using MoveBodies = void (*)(int count, SearchStep step, BodyRow<Number>* w, BodyRow<Number>* before,
                            BodyRow<Number>* direction);

/// All loops of one kind of numbers.
template <template <typename> class Loops, typename Number>
struct KernelsOf : Kinds<Loops, Number> {
  MoveBodies<Number> move_bodies;
};

struct GroupKernels {
  const char* instruction_set;
  KernelsOf<ExactLoops, double> exact;
  KernelsOf<GroupLoops, float> single;
};

/// Of the best instruction set that this processor has.
const GroupKernels& group_kernels();
/// Of all that it has, the best first.
const std::vector<const GroupKernels*>& all_group_kernels();

/// The slip root of one contact in a group's coordinates: x = 1 + lambda from the stick solution
/// (y, t1, t2) outside the cone; 0: no tangential impulse. With a proven bracket, for the few
/// contacts that two Newton steps do not serve.
double slip_root(double s2, double c1, double c2, double mu, double y, double t1, double t2);

}  // namespace ballast
