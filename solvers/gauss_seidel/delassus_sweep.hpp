#pragma once
// One Gauss-Seidel sweep on the Delassus form: u_c = sum_j W_cj r_j + q_c by 3 x 3 blocks in rows
// (block CSR).
//
// The contact at hand is solved with the symmetric part of W_cc from the velocity that the whole of
// W gives: where W_cc is not symmetric this is another splitting of W, with the same fixed points.

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
  /// In the given order.
  void sweep() override;
  void start_search() override;
  double sweep_along(SearchStep step) override;
  void sweep_by(const SweepVariant& variant, const std::vector<int>& contacts) override;
  double error() override;

 private:
  struct Contact {
    PrincipalContact local;
    TangentTurn turn;
    double lambda_max = 0.0;
    double slip = 0.0;  ///< the last slip root
  };

  /// u_c = W_c r + q_c, in the given tangents.
  void velocity(int c, double* u) const;

  std::vector<int> block_begin_;  ///< contacts + 1
  std::vector<int> block_contact_;
  std::vector<double> blocks_;  ///< 3 x 3, column-major; one-row contacts are padded with zeros
  std::vector<Contact> contacts_;
  Eigen::VectorXd q_, r_;               ///< three per contact
  Eigen::VectorXd before_, direction_;  ///< of a search: where the last sweep began
};

}  // namespace ballast
