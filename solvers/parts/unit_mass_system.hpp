#pragma once
// (I + G^T K G) x = b with one 3 x 3 block K_c per contact, any of them unsymmetric: the linear
// system of a Newton step in the bodies' unknowns.

#include <array>
#include <vector>

#include "solvers/parts/front_lu.hpp"
#include "solvers/parts/unit_mass_contacts.hpp"

namespace ballast {

class UnitMassSystem {
 public:
  /// The pattern of bodies in contact, its order and analysis. `contacts` must outlive the use of
  /// the system.
  void prepare(const UnitMassContacts& contacts);
  /// With K_c = gain[c]; blocks of zeros cost nothing. False: the elimination broke down.
  bool factor(const std::vector<Eigen::Matrix3d>& gain);
  /// x of the system above, with the K of factor(). Improved by its residual, once, where that is
  /// larger than 1e-10 of b: there are no pivots. `x` must not be `b`.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);
  /// FrontLu::use_team
  void use_team(WorkerTeam* team) { factor_.use_team(team); }
  /// What factor() costs at most, with no block of zeros (FrontLu::operations).
  double operations() const { return factor_.operations(); }

 private:
  void add_block(const UnitMassContacts::Contact& contact, const Eigen::Matrix<double, 6, 3>& left,
                 int side, int offset);

  const UnitMassContacts* contacts_ = nullptr;
  const std::vector<Eigen::Matrix3d>* gain_ = nullptr;
  SparseColumns matrix_;
  /// Per contact and sides (aa, ab, ba, bb): where in the first column of the right body the rows
  /// of the left one begin; -1: no such block.
  std::vector<std::array<int, 4>> offset_;
  std::vector<int> diagonal_;  ///< per body: where its own block begins
  FrontLu factor_;
  Eigen::VectorXd residual_, correction_;
};

}  // namespace ballast
