#pragma once
// The convex cone program behind Coulomb's law, in units of its own, for general optimisers:
//
//   min 1/2 x.W x + x.(q + s n)   over x in K_mu
//
// and the s-update (slip_shift.hpp) around any solver of it.

#include <functional>
#include <vector>

#include "solvers/parts/contact_operator.hpp"
#include "solvers/parts/slip_shift.hpp"
#include "solvers/seam/rounds.hpp"

namespace ballast {

/// What a solver of the convex program is handed, and gives back. No units: every block of W's
/// diagonal has largest eigenvalue one, and the largest entry of the problem's q is one.
struct ConeRequest {
  const Eigen::VectorXd& q;      ///< with s, one entry per row of ConeProgram
  const Eigen::VectorXd& start;  ///< in the cones
  double accuracy;  ///< natural map that the budget asks for, in the program's unit of velocity
  Budget left;
};

/// Contacts that nothing moves are left out; contacts with mu = 0 keep one row.
class ConeProgram {
 public:
  void take(const FrictionProblem& problem);

  int contact_count() const { return static_cast<int>(friction.size()); }
  int row_count() const { return row_begin.back(); }
  bool has_friction(int k) const { return row_begin[k + 1] - row_begin[k] == 3; }

  std::vector<int> row_begin{0};  ///< 1 or 3 rows per contact, normal first
  std::vector<double> friction;   ///< mu; > 0 where there are three rows
  SparseRows w;                   ///< symmetric part
  SparseRows w_as_is;  ///< a stored W may be unsymmetric: in solve() the rest goes into q, like s
  Eigen::VectorXd q;   ///< without s

  /// Polar coordinates y: the normal entry stays, the tangential ones are d with x_T = mu x_N d,
  /// |d| <= 1. The cone is then a half-line times a disc, without the apex where no constraint has
  /// a gradient. (General optimisers need many times fewer steps, though 1/2 x.W x is no longer
  /// convex in y.)
  Eigen::VectorXd from_polar(const Eigen::VectorXd& y) const;
  /// Gradient in y of what has gradient g in x.
  Eigen::VectorXd polar_gradient(const Eigen::VectorXd& y, const Eigen::VectorXd& g) const;
  /// Near x, with x_N >= floor and |d| <= longest < 1. Where x_T says nothing, d points against the
  /// velocity `u`.
  Eigen::VectorXd to_polar(const Eigen::VectorXd& x, const Eigen::VectorXd& u, double floor,
                           double longest) const;

  /// Every contact to the nearest point of its cone, or half-line.
  void project(Eigen::VectorXd& x) const;

  /// Rounds of `convex` with the s-update between them; `convex` sets answer.x (rows of
  /// ConeProgram), iterations, finished. `problem` is the one of take().
  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget, int patience,
               const std::function<void(const ConeRequest&, RoundAnswer&)>& convex);

  /// Between this program's rows and those of MovingContacts: an impulse is x times a scale.
  Eigen::VectorXd to_rows(const Eigen::VectorXd& x) const;
  Eigen::VectorXd from_rows(const Eigen::VectorXd& r) const;
  const MovingContacts& moving() const { return moving_; }

 private:
  Eigen::VectorXd linear_term(const Eigen::VectorXd& x) const;

  MovingContacts moving_;
  std::vector<int> row_;   ///< in MovingContacts, of each row here
  Eigen::VectorXd scale_;  ///< per row: impulse = scale * x [N s]
  double unit_ = 1.0;      ///< of q scaled by 1 / sqrt(W_cc) [sqrt(J)]
  double velocity_unit_ = 1.0;
  ContactOperator operator_;
  SlipShift shift_;
};

}  // namespace ballast
