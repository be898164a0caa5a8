#pragma once
// M + H^T E H with one 3 x 3 block E_c per contact, any of them unsymmetric: the matrix of every
// method that eliminates the impulses. Few unknowns, and the pattern of bodies that touch.

#include <array>
#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "solvers/parts/front_lu.hpp"
#include "solvers/parts/unit_mass_contacts.hpp"

namespace ballast {

class BodyMatrix {
 public:
  /// Pattern, order, analysis and the places of all blocks. `problem`, which has a dynamics form,
  /// must outlive the use of the matrix.
  void prepare(const FrictionProblem& problem);
  /// The same of I + G^T E G. Its unknowns are those of `contacts`, which must outlive its use.
  void prepare(const UnitMassContacts& contacts);
  /// FrontLu::use_team
  void use_team(WorkerTeam* team) { fronts_.use_team(team); }

  /// With E_c = gain[c]; of a contact of one row only entry 0,0 is read. False: the elimination
  /// broke down, and solve_once() must not be called.
  bool factor(const std::vector<Eigen::Matrix3d>& gain);
  /// x = A^-1 b by the factors alone. `x` may be `b`.
  void solve_once(const Eigen::VectorXd& b, Eigen::VectorXd& x) { fronts_.solve(b, x); }
  /// The matrix with E_c = gain[c] and x = A^-1 b, improved once by its residual. Where that stays
  /// large, as no rows are exchanged, by an LU that exchanges them. False: singular. `x` must not
  /// be `b`.
  bool solve(const std::vector<Eigen::Matrix3d>& gain, const Eigen::VectorXd& b,
             Eigen::VectorXd& x);

 private:
  /// A block: its first entry among the matrix's values, and entries from one of its columns to the
  /// next. height 0: no such block.
  struct Place {
    int first, height;
  };
  void analyse(const std::vector<int>& dof_begin);
  void add_masses();
  void add_contact(int c, const Eigen::Matrix3d& gain);
  void add_unit_contact(int c, const Eigen::Matrix3d& gain);
  double* column(const Place& block, int j) {
    return matrix_.valuePtr() + block.first + j * block.height;
  }

  const FrictionProblem* problem_ = nullptr;
  const UnitMassContacts* unit_ = nullptr;  ///< in place of the problem
  SparseColumns matrix_;
  std::vector<std::array<int, 2>> pair_;      ///< bodies of each contact; -1: does not move
  std::vector<std::array<Place, 4>> blocks_;  ///< of each contact: aa, ab, ba, bb
  std::vector<Place> masses_;                 ///< of each body: its own block
  FrontLu fronts_;
  LuFactor exchanging_;  ///< where fronts_ do not do
  Eigen::VectorXd rest_, correction_;
};

}  // namespace ballast
