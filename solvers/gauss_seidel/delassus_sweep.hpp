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
  void sweep_by(const SweepVariant& variant, const std::vector<int>& contacts) override;
  double error() override;
  /// The impulses, three per contact: the whole of the iterate.
  Eigen::Index save(Eigen::VectorXd& state) const override;
  void restore(const Eigen::VectorXd& state) override;
  /// sqrt(lambda_max(W_cc)) for each of them.
  void impulse_weights(Eigen::VectorXd& weights) const override;

 private:
  struct Contact {
    PrincipalContact local;
    TangentTurn turn;
    double lambda_max = 0.0;
    double slip = 0.0;  ///< the last slip root
  };

  /// u_c = W_c r + q_c, in the given tangents.
  void velocity(int c, double* u) const;

  std::vector<int> block_begin_;    ///< contacts + 1
  std::vector<int> block_contact_;  ///< ascending in a row
  std::vector<double> blocks_;      ///< 3 x 3, column-major; one-row contacts are padded with zeros
  std::vector<double> q_, r_;       ///< three per contact
  std::vector<Contact> contacts_;
};

}  // namespace ballast
