#pragma once
// What the wide sweep keeps of contacts and bodies, in the order in which it is read.
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
  template <typename Other>
  using Of = FrictionGroup<Other>;
  Number s2[group_lanes], inverse_s2[group_lanes], c1[group_lanes], c2[group_lanes],
      mu[group_lanes], inverse_mu[group_lanes];
};

template <typename Number>
struct OneRowGroup : RowGroup<Number, 1> {
  template <typename Other>
  using Of = OneRowGroup<Other>;
};

/// Contacts of grains with one and the same body that has one unknown, the driven wall. Its side
/// is a number a contact, and the lanes see its velocity one after the other.
template <typename Number>
struct WallGroup : RowGroup<Number, 1> {
  template <typename Other>
  using Of = WallGroup<Other>;
  Number wall[group_lanes];  ///< the row's entry for the wall's unknown L^T v
  int wall_body;             ///< distance of its velocity in bytes
};

/// The impulses y' of a group's contacts.
template <typename Number, int Rows>
struct alignas(64) GroupImpulses {
  Number y[Rows][group_lanes];
  Number miss[group_lanes];  ///< by how much the closed form missed the last slip root (friction)
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

}  // namespace ballast
