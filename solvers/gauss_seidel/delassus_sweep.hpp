#pragma once
// One Gauss-Seidel sweep on the Delassus form: u_c = sum_j W_cj r_j + q_c by 3 x 3 blocks in rows
// (block CSR).
//
// The contact at hand is solved with the symmetric part of W_cc from the velocity that the whole of
// W gives: where W_cc is not symmetric this is another splitting of W, with the same fixed points.

#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "solvers/gauss_seidel/sweep_variant.hpp"
#include "solvers/parts/one_contact.hpp"

namespace ballast {

class DelassusSweep {
 public:
  void prepare(const FrictionProblem& problem);
  void load(const FrictionProblem& problem, const Impulses& r);
  void store(const FrictionProblem& problem, Impulses& r) const;

  /// Every contact once, in the given order.
  void sweep();
  /// The contacts named, in that order, another way: for comparison, not for speed.
  void sweep(const SweepVariant& variant, const std::vector<int>& contacts);
  /// The judge's scaled natural map at the current iterate, rms over contacts [m/s].
  double error() const;

  /// The impulses, three per contact: the whole of the iterate.
  void save(Eigen::VectorXd& state) const;
  void restore(const Eigen::VectorXd& state);
  /// sqrt(lambda_max(W_cc)) for each of them.
  void impulse_weights(Eigen::VectorXd& weights) const;

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
