#pragma once
// The records of contacts and bodies that the wide sweep reads, in the order in which it reads
// them, and its inner loops for each instruction set. All instruction sets give the same bits.
//
// A group has sixteen contacts of which no two share a body. Each number of a contact's record is
// stored for all contacts of the group side by side, one contact in each lane:
//
//   line[0][0] | c0 c1 c2 ... c15 |    first number of the normal row's linear part
//   line[0][1] | c0 c1 c2 ... c15 |    ...
//
// so that one load reads it for as many contacts as a register holds.
//
// Bodies keep (v, L_r^T omega, 0, 0) with M = diag(m, m, m, L_r L_r^T). v stays unscaled [m/s]: the
// two sides of a contact see it with opposite signs, so a contact needs only the difference.
//
// Contacts are in the coordinates of PrincipalContact, scaled so that W_NN = 1 and S = diag(1, s2):
//   N' = N / n,  T' = (T - c N) / t,  y' = n y,  r_T' = t r_T,   n = sqrt(W_NN), t = sqrt(s1)
//   mu' = mu t / n,  c' = c n / t,  s2' = s2 / s1
// In these coordinates the impulse that stops a contact is its present impulse minus its velocity,
// and Coulomb's law keeps its form.

#include <vector>

// Sources for several instruction sets include this: no function here may be emitted for each.
namespace ballast {

constexpr int group_lanes = 16;

/// A lane without a contact has zero rows, refers to a velocity that stays zero, and is open.
template <typename Number_, int Rows>
struct alignas(64) RowGroup {
  using Number = Number_;
  static constexpr int rows = Rows;
  Number line[Rows][3][group_lanes];     ///< linear part of the rows for body b; for a, minus that
  Number turn[2][Rows][3][group_lanes];  ///< angular part of the rows, for a and for b
  Number inverse_mass[2][group_lanes];   ///< of a and b; 0: does not move
  Number bias[Rows][group_lanes];
  int body[2][group_lanes];  ///< a and b: byte offset of their row of velocities
};

template <typename Number>
struct FrictionGroup : RowGroup<Number, 3> {
  Number s2[group_lanes], inverse_s2[group_lanes], c1[group_lanes], c2[group_lanes],
      mu[group_lanes], inverse_mu[group_lanes];
};

template <typename Number>
struct OneRowGroup : RowGroup<Number, 1> {};

/// Contacts of grains with one driven wall, a body with one unknown. The wall's side is one number
/// for each contact. The lanes see the wall's velocity one after the other.
template <typename Number>
struct WallGroup : RowGroup<Number, 1> {
  Number wall[group_lanes];  ///< the row's entry for the wall's unknown L^T v
  int wall_body;             ///< byte offset of the wall's velocity
};

/// One member for each kind of group.
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

/// The velocities u' of a group's contacts when the error was evaluated.
template <int Rows>
struct alignas(64) GroupVelocities {
  float u[Rows][group_lanes];
};

/// What a search keeps of its sweeps (SearchStep). Momentum: x_k - x_k-1 alone, in `change`.
/// Conjugate: the last sweep's d in `change`, p in `direction`.
template <typename Number, int Rows>
struct alignas(64) GroupSearch {
  Number change[Rows][group_lanes], direction[Rows][group_lanes];
};

/// Leads from a group's coordinates to those of the problem. One-row contacts have no tangents.
struct alignas(64) GroupFrame {
  double normal[group_lanes], inverse_normal[group_lanes];    ///< n [kg^-1/2], 1/n
  double tangent[group_lanes], inverse_tangent[group_lanes];  ///< t, 1/t
  double cosine[group_lanes], sine[group_lanes];              ///< of the turn to principal tangents
  double mu[group_lanes];
  double lambda_max[group_lanes];  ///< of W_cc [1/kg]; 0: no contact, or an immovable one
  double bias[3][group_lanes];     ///< of u', without the bodies' motion
  int contact[group_lanes];        ///< its number in the problem; -1: none
};

template <typename Number_>
struct alignas(8 * sizeof(Number_)) BodyRow {
  using Number = Number_;
  Number w[8];
};

/// The step of a search that combines sweeps. Sweep k leaves the iterate x_k, having changed its
/// start by d_k. The next one starts at x_k + m_k:
///   momentum:   m_k = beta (x_k - x_k-1)
///   conjugate:  m_k = beta p_k-1,  p_k = m_k + d_k
/// A search keeps to one of the two.
struct SearchStep {
  double beta = 0.0;
  bool is_conjugate = false;

  /// Moves the numbers `x`, which the last sweep changed by `change`. `direction`: their last m, or
  /// their p.
  template <typename Numbers>
  [[gnu::always_inline]] void move(const Numbers& change, Numbers& direction, Numbers& x) const {
    if (is_conjugate) {
      const Numbers along = beta * direction;
      direction = along + change;
      x = x + along;
    } else {
      direction = beta * (direction + change);
      x = x + direction;
    }
  }
};

/// How a sweep starts: where the last one ended, or moved by a SearchStep.
enum class SearchKind { none, momentum, conjugate };

/// Groups that follow each other, their impulses and, for a search, its numbers.
template <typename Group>
struct GroupRun {
  const Group* groups;
  GroupImpulses<typename Group::Number, Group::rows>* impulses;
  GroupSearch<typename Group::Number, Group::rows>* search;
  const int* awake;     ///< the groups to sweep, ascending; null: the first `count`
  int count;            ///< number of groups to sweep
  bool is_far = false;  ///< not in a core's cache: each group is fetched one group ahead

  int group(int i) const { return awake ? awake[i] : i; }
};

/// The loops over groups of one kind. All take the groups in order.
template <typename Group>
struct GroupLoops {
  using Number = typename Group::Number;
  using Impulses = GroupImpulses<Number, Group::rows>;
  using Search = GroupSearch<Number, Group::rows>;
  using Run = GroupRun<Group>;

  /// Solves every contact once. The two runs share no body; they may be swept side by side, which
  /// hides one's divisions behind the other's and gives the same bits. With a `step` each impulse
  /// first takes the step (the caller has moved the bodies by it), and `squares` receives each
  /// run's sum of |change|^2 over its contacts.
  void (*sweep)(const Run (&runs)[2], const SearchStep* step, BodyRow<Number>* bodies,
                double (&squares)[2]);
  /// Applies all impulses once to their bodies, which are in double.
  void (*push)(const Group* groups, const Impulses* impulses, int count, BodyRow<double>* bodies);
  /// The sum over contacts of the judge's scaled natural map squared [m^2/s^2], in double. `out`
  /// may be null.
  double (*error)(const Group* groups, const Impulses* impulses, const GroupFrame* frames,
                  int count, const BodyRow<double>* bodies, GroupVelocities<Group::rows>* out);
  /// The same sum in the groups' own precision, with the velocities that a sweep sees.
  double (*rough_error)(const Group* groups, const Impulses* impulses, const GroupFrame* frames,
                        int count, const BodyRow<Number>* bodies,
                        GroupVelocities<Group::rows>* out);
};

/// Of groups in double.
template <typename Group>
struct ExactLoops : GroupLoops<Group> {
  /// Turns the rows as given, bias and mu in the frame, into the group's coordinates.
  void (*make_principal)(Group& group, GroupFrame& frame);
};

/// All loops for one number type.
template <template <typename> class Loops, typename Number>
struct KernelsOf : Kinds<Loops, Number> {
  /// Moves `count` consecutive bodies by the step of the search.
  void (*move_bodies)(int count, SearchStep step, BodyRow<Number>* w, BodyRow<Number>* before,
                      BodyRow<Number>* direction);
};

struct GroupKernels {
  const char* instruction_set;
  KernelsOf<ExactLoops, double> exact;
  KernelsOf<GroupLoops, float> single;
};

// SSE2's serve any other processor too, which has no other ones.
extern const GroupKernels sse2_group_kernels, avx2_group_kernels, avx512_group_kernels;

/// The kernels of all instruction sets that this processor has, the best first.
std::vector<const GroupKernels*> all_group_kernels();

/// Returns the slip root x = 1 + lambda of one contact in a group's coordinates from the stick
/// solution (y, t1, t2) outside the cone; 0: no tangential impulse. Uses a proven bracket, for the
/// few contacts whose root two Newton steps do not reach.
double slip_root(double s2, double c1, double c2, double mu, double y, double t1, double t2);

}  // namespace ballast
