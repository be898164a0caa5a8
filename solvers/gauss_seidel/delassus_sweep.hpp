#pragma once
// One Gauss-Seidel sweep on the Delassus form: u_c = sum_j W_cj r_j + q_c by 3 x 3 blocks in rows
// (block CSR).
//
// Contact c is solved with the symmetric part of W_cc and the velocity that the whole of W gives.
// Where W_cc is not symmetric this is another splitting of W, with the same fixed points.

#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "solvers/gauss_seidel/contact_sweep.hpp"
#include "solvers/parts/one_contact.hpp"

namespace ballast {

class DelassusSweep final : public ContactSweep {
 public:
  /// `problem` has a stored W.
  void prepare(const FrictionProblem& problem);

  void load(const FrictionProblem& problem, const Impulses& r) override;
  void store(const FrictionProblem& problem, Impulses& r) const override;
  /// Solves the contacts in the order of the problem.
  void sweep() override;
  void start_search() override;
  double sweep_along(SearchStep step) override;
  double error() override;

  struct Contact {
    PrincipalContact local;
    TangentTurn turn;
    double lambda_max = 0.0;
    double slip = 0.0;       ///< the last slip root
    double q[3]{};           ///< in the given tangents
    int begin = 0, end = 0;  ///< its row of blocks is begin .. end - 1
  };
  /// W by rows of blocks, and the contact of each block's column.
  struct BlockRows {
    const double* blocks;
    const int* contacts;
  };

 private:
  bool append_whole_blocks(const FrictionProblem& problem, int c, const int* contact_of_row);
  void append_entries(const FrictionProblem& problem, int c, const int* contact_of_row, int* slot);
  BlockRows rows() const { return {blocks_.data(), block_contact_.data()}; }

  std::vector<int> block_contact_;  ///< the contact of each block's column
  /// 3 x 3, column-major; one-row contacts are padded with zeros. One more zero follows the last.
  std::vector<double> blocks_;
  std::vector<Contact> contacts_;
  Eigen::VectorXd r_;                   ///< three per contact
  Eigen::VectorXd before_, direction_;  ///< search: iterate before the last sweep, direction
};

}  // namespace ballast
