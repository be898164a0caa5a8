#pragma once
// The linear system of a Newton step where W is stored:
//
//   (B + by_u W) dr = -f,    B = by_r + alpha by_u        (newton_system.hpp)
//
// A contact that nothing presses has by_u = 0, and its own rows give its dr. The others are a dense
// system where they are few or W is nearly full, and a sparse one with W's pattern elsewhere.

#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "solvers/parts/contact_equation.hpp"
#include "solvers/parts/sparse_factor.hpp"

namespace ballast {

class NewtonMatrix {
 public:
  /// `problem` has a stored W and outlives the use.
  void prepare(const FrictionProblem& problem);
  /// False: a singular matrix. `alpha` [1/kg] and `linear` per contact.
  bool solve(const std::vector<ContactLinearisation>& linear, const std::vector<double>& alpha,
             Impulses& dr);
  /// Of the last factorisation: multiplications with their additions. 0: it was a sparse one, or
  /// there was none.
  double operations() const { return operations_; }

 private:
  /// Entries of W in one column, rows of one contact (one-row contacts: the first alone).
  struct Piece {
    int column, offset;  ///< where the first of them is among the values of matrix_
    double w[3];
  };

  void cut_into_pieces();
  bool solve_idle(const std::vector<ContactLinearisation>& linear, const std::vector<double>& alpha,
                  Impulses& dr);
  bool solve_dense(const std::vector<ContactLinearisation>& linear, Impulses& dr);
  bool solve_sparse(const std::vector<ContactLinearisation>& linear, Impulses& dr);

  const FrictionProblem* problem_ = nullptr;
  double operations_ = 0.0;
  std::vector<int> piece_begin_;  ///< of each contact; contacts + 1
  std::vector<Piece> pieces_;
  SparseColumns matrix_;  ///< made when it is first needed
  bool has_pattern_ = false;

  std::vector<Eigen::Matrix3d> b_;
  std::vector<int> pressed_;  ///< contacts with by_u != 0
  std::vector<int> place_;    ///< of each row among those of pressed contacts; -1: none
  int pressed_rows_ = 0;
  long pressed_entries_ = 0;  ///< of W among them

  Eigen::MatrixXd dense_;
  Eigen::PartialPivLU<Eigen::MatrixXd> dense_lu_;
  Eigen::VectorXd right_, solution_;
  LuFactor sparse_lu_;
};

}  // namespace ballast
