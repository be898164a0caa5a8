#pragma once
// The friction problem that every solver receives, whether it comes from a time step or from a
// file.
//
//   M (v - v_free) = H^T r,    u = H v + bias,    W = H M^-1 H^T,    q = H v_free + bias
//   Coulomb-Signorini:  K_mu ∋ r  ⟂  u + mu |u_T| n  ∈ K_mu*          (De Saxce 1998)
//
// Contact frame normal first (N, T1, T2). u: relative velocity of b against a [m/s], r: impulse on
// b [N s], u_N > 0 opens. A contact with friction has three rows, a frictionless one has one.

#include <stdexcept>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "problems/algebra/mass_root.hpp"

namespace ballast {

/// Stacked contact impulses (or relative velocities), one segment of 1 or 3 rows per contact.
using Impulses = Eigen::VectorXd;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The greatest friction coefficient: an angle of friction of 89.994 degrees, which holds a closed
/// contact as a bond would. With more, u_N is lost in mu |u_T|, of which double precision keeps 16
/// digits, before a solver's tolerance is reached. "Infinite" friction is given as this number.
inline constexpr double largest_friction = 1e4;
/// Greatest magnitude of any entry, and least magnitude of a mass and of a W_cc that is not zero.
/// In between, no square, product or determinant that a solver computes overflows.
inline constexpr double largest_entry = 1e30, smallest_scale = 1e-30;

/// Thrown for a problem that no solver may see; what() names the array, the index and the value.
class InvalidProblem : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The problem as the dynamics gives it: bodies with up to 6 unknowns each, contacts between at
/// most two of them.
struct DynamicsForm {
  /// Bodies. Body b has unknowns dof_begin[b] .. dof_begin[b+1]; only bodies that can move are
  /// listed. Size bodies + 1.
  std::vector<int> dof_begin{0};
  /// Mass blocks, dense d x d (column-major) per body, one after the other: mass_begin[b] .. .
  /// Symmetric positive definite [kg, kg m^2].
  std::vector<int> mass_begin{0};
  std::vector<double> mass;

  /// Contacts. The two bodies of contact c (-1: nothing that moves); body_a[c] != body_b[c] unless
  /// both are -1.
  std::vector<int> body_a, body_b;
  /// H by blocks: for contact c, column-major rows x dof(a), then rows x dof(b), from h_begin[c].
  /// Size contacts + 1.
  std::vector<int> h_begin{0};
  std::vector<double> h;

  Eigen::VectorXd v_free;  ///< velocity without contact impulses, per unknown [m/s, rad/s]
  Eigen::VectorXd bias;    ///< per contact row [m/s]: walls that move, open gaps, restitution

  int body_count() const { return static_cast<int>(dof_begin.size()) - 1; }
  int dof_count() const { return dof_begin.back(); }
  int body_dofs(int body) const { return body < 0 ? 0 : dof_begin[body + 1] - dof_begin[body]; }
  /// |M v_free| of a body: the impulse that would stop it. It mixes linear and angular momenta.
  double momentum(int body) const {
    const int dofs = body_dofs(body);
    const Eigen::Map<const Eigen::MatrixXd> block(mass.data() + mass_begin[body], dofs, dofs);
    return (block * v_free.segment(dof_begin[body], dofs)).norm();
  }

  /// Appends a body with this mass block, 1 x 1 to 6 x 6, and returns its number. The caller sizes
  /// v_free.
  int add_body(const Eigen::MatrixXd& block);
};

/// The problem as files often give it: W (rows x rows) and q.
struct DelassusForm {
  /// Positive semidefinite [1/kg]. Symmetric when it comes from a DynamicsForm; stored problems
  /// with implicit gyroscopic terms are unsymmetric by some per cent, some by more, and the law
  /// must hold for u = W r + q with W as it is.
  SparseRows w;
  Eigen::VectorXd q;  ///< [m/s]
};

/// Either form, or both (they must then agree; validate() does not check that). Refilled every step
/// without allocation.
struct FrictionProblem {
  /// Contact c has rows row_begin[c] .. row_begin[c+1]: 1 (frictionless) or 3. Size contacts + 1.
  std::vector<int> row_begin{0};
  std::vector<double> friction;  ///< 0 <= mu <= largest_friction; 0 for one-row contacts

  bool has_dynamics = false;
  bool has_delassus = false;
  DynamicsForm dynamics;
  DelassusForm delassus;

  int contact_count() const { return static_cast<int>(friction.size()); }
  int row_count() const { return row_begin.back(); }
  int contact_rows(int c) const { return row_begin[c + 1] - row_begin[c]; }

  /// Removes all contacts and keeps the bodies. v_free, bias and h keep their sizes: the caller
  /// that refills the problem resizes them, and nothing is allocated while the sizes stay.
  void clear_contacts();

  /// Appends a contact of b against a to the dynamics form. `h_a` and `h_b` are rows x unknowns of
  /// their body, `h_a` empty where a is -1; h_b sets the rows. The caller sizes bias.
  void add_contact(int a, int b, double mu, const Eigen::MatrixXd& h_a, const Eigen::MatrixXd& h_b);

  /// Throws InvalidProblem naming the first bad entry: sizes that disagree, an index out of range,
  /// an entry that is not finite or beyond largest_entry, mu < 0 or beyond largest_friction, a mass
  /// block that is not symmetric positive definite, a Delassus diagonal block whose symmetric part
  /// is not positive semidefinite or is outweighed by the rest. O(entries), which `team` shares.
  /// Masses that equal the `valid` ones are not checked again; others are kept there.
  void validate(class KnownMasses* valid = nullptr, class WorkerTeam* team = nullptr) const;
};

/// The roots of the bodies' masses, and a copy of the masses that tells whether others are the same
/// bit by bit: in a run every step has the same masses.
class KnownMasses {
 public:
  bool has_masses_of(const DynamicsForm& dynamics) const;
  /// Throws InvalidProblem for a block that is not positive definite, and then keeps nothing.
  void keep(const DynamicsForm& dynamics);
  const std::vector<MassRoot>& roots() const { return roots_; }

 private:
  std::vector<int> dof_begin_, mass_begin_;
  std::vector<double> mass_;  // only the diagonal of a diagonal block
  std::vector<MassRoot> roots_;
};

/// A problem u = W r + q with three rows per contact and without bodies.
FrictionProblem local_problem(SparseRows&& w, Eigen::VectorXd q, std::vector<double> mu);

/// The rows of contact c in a vector over all rows, as three; rows that it lacks are zero.
inline Eigen::Vector3d rows_of_contact(const FrictionProblem& problem, const Eigen::VectorXd& all,
                                       int c) {
  const double* rows = all.data() + problem.row_begin[c];
  return problem.contact_rows(c) == 3 ? Eigen::Vector3d(rows[0], rows[1], rows[2])
                                      : Eigen::Vector3d(rows[0], 0.0, 0.0);
}

/// Calls visit(unknown, entry) over the normal row of H of contact c; dynamics form only.
template <class Visit>
void for_normal_row(const FrictionProblem& problem, int c, const Visit& visit) {
  const DynamicsForm& dynamics = problem.dynamics;
  const int rows = problem.contact_rows(c);
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
    const int dofs = dynamics.body_dofs(body), first = body < 0 ? 0 : dynamics.dof_begin[body];
    for (int d = 0; d < dofs; ++d, block += rows) visit(first + d, *block);
  }
}

/// The islands, the independent parts of a problem in dynamics form: the contacts of each,
/// ascending, in the order of their first bodies. Contacts join the bodies that can move; bodies
/// without unknowns (undriven walls, fixed bodies) join nothing, and a contact between two of them
/// belongs to no island.
std::vector<std::vector<int>> contact_islands(const FrictionProblem& problem);

/// The diagonal block of contact c in the stored W, as it is; entries beyond its rows are zero.
Eigen::Matrix3d stored_diagonal_block(const FrictionProblem& problem, int c);

/// q = H v_free + bias (dynamics) or the stored q. `q` is resized.
void free_contact_velocity(const FrictionProblem& problem, Eigen::VectorXd& q);

/// Throws InvalidProblem unless the contacts have as many rows as r.
void require_rows(const Impulses& r, int rows);

/// u = W r + q, matrix-free for the dynamics form. Throws InvalidProblem when r has the wrong size.
void contact_velocity(const FrictionProblem& problem, const Impulses& r, Eigen::VectorXd& u);

/// v = v_free + M^-1 H^T r (dynamics form only).
void body_velocity(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                   const Impulses& r, Eigen::VectorXd& v);

/// u = H v + bias (dynamics form only).
void body_to_contact_velocity(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                              const Eigen::VectorXd& v, Eigen::VectorXd& u);
/// The same for contacts begin <= c < end alone; `u` has its size already.
void body_to_contact_velocity(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                              const Eigen::VectorXd& v, int begin, int end, Eigen::VectorXd& u);

/// p = H^T r: the impulse of the contacts on each unknown [N s, N m s] (dynamics form only).
void contact_to_body_impulse(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                             const Impulses& r, Eigen::VectorXd& p);
/// The same for bodies begin <= b < end alone; `p` has its size already.
void contact_to_body_impulse(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                             const Impulses& r, int begin, int end, Eigen::VectorXd& p);

/// Factors every mass block. Throws InvalidProblem for one that is not positive definite.
void factor_masses(const DynamicsForm& dynamics, std::vector<MassRoot>& roots);
/// v := M^-1 v, block by block.
void solve_masses(const DynamicsForm& dynamics, const std::vector<MassRoot>& roots,
                  Eigen::VectorXd& v);

/// M and H as sparse matrices, for backends that factorise: built only when asked for (dynamics
/// form only).
Eigen::SparseMatrix<double> sparse_mass(const DynamicsForm& dynamics);
SparseRows sparse_h(const FrictionProblem& problem);

}  // namespace ballast
