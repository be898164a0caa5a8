#pragma once
// M + H^T E H with one 3 x 3 block E_c per contact, symmetric or not: the matrix of every method
// that eliminates the impulses. It has few unknowns, and entries only between bodies that touch.

#include <array>
#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "solvers/parts/front_lu.hpp"

namespace ballast {

class BodyMatrix {
 public:
  /// Finds the pattern and the places of all blocks, orders and analyses. `problem` must have a
  /// dynamics form and outlive the use of the matrix.
  void prepare(const FrictionProblem& problem);
  /// See FrontLu::use_team().
  void use_team(WorkerTeam* team) { fronts_.use_team(team); }

  /// Factors the matrix with E_c = gain[c]; of a one-row contact only entry 0,0 is read. False: the
  /// elimination broke down, and solve_once() must not be called.
  bool factor(const std::vector<Eigen::Matrix3d>& gain);
  /// x = A^-1 b by the factors alone. `x` may be `b`.
  void solve_once(const Eigen::VectorXd& b, Eigen::VectorXd& x) { fronts_.solve(b, x); }
  /// Factors the matrix with E_c = gain[c] and solves x = A^-1 b. x is refined once where its
  /// residual is above `enough` |b|. Where the residual stays large, as no rows are exchanged, an
  /// LU that exchanges rows solves instead. False: singular. `x` must not be `b`.
  bool solve(const std::vector<Eigen::Matrix3d>& gain, const Eigen::VectorXd& b, Eigen::VectorXd& x,
             double enough = 0.0);

 private:
  /// A block: the index of its first entry among the matrix's values, and the number of entries
  /// from one of its columns to the next. height 0: no such block.
  struct Place {
    int first, height;
  };
  void add_contact(int c, const Eigen::Matrix3d& gain);

  const FrictionProblem* problem_ = nullptr;
  SparseColumns matrix_;
  std::vector<std::array<Place, 4>> blocks_;  ///< of each contact: aa, ab, ba, bb
  std::vector<Place> masses_;                 ///< of each body: its own block
  FrontLu fronts_;
  LuFactor exchanging_;  ///< used where fronts_ fails
  Eigen::VectorXd rest_, correction_;
};

}  // namespace ballast
