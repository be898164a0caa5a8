#pragma once
// Newton's law of restitution, u_N+ >= -e u_N-, with a limit on the energy that the rebound gives
// back: alone it can add energy (Kane and Levinson 1985; Glocker 2013; docs/theory/method.md). With
// u_free the relative velocity without contact impulses and u the one at the step's end, the
// contacts of an island take from the free motion the energy
//
//   L(r) = -1/2 sum_c r_c . (u_c + u_free,c)      [J], without the walls' own work
//
// The limit is L >= (1 - e^2) L_0, where L_0 >= 0 is that of the inelastic impact, e = 0. Where
// Newton's law violates it, the island's e is lowered until it holds; with e = 0 it always holds.

#include <span>
#include <vector>

#include "solvers/seam/run_solver.hpp"

namespace ballast {

class ImpactLaw {
 public:
  /// `highest`: the highest of all coefficients of restitution.
  explicit ImpactLaw(double highest) : highest_(highest) {}

  /// Solves `problem`. The normal row of contact c in its bias includes rebound[c] = e u_N- <= 0
  /// with e = restitution[c]; the bias is left as in the last solve. An island's e is the highest
  /// of its contacts'. There are two solves where something rebounds, and more where e is lowered.
  /// Throws as SolverRunner::run.
  SolverRun solve(SolverRunner& runner, Solver& solver, FrictionProblem& problem,
                  std::span<const double> rebound, std::span<const double> restitution,
                  Impulses start, const Budget& budget);

  /// The lowest coefficient in force in the last solve(): the highest of all, or the lowest value
  /// to which an island's was lowered.
  double least_restitution() const { return least_; }

 private:
  struct Impact {
    Impulses r;
    Eigen::VectorXd u;  ///< contact velocities with the walls' motion, without the rebound
    double error = 0.0;
  };

  void measure(FrictionProblem& problem, const SolverRun& run, const Eigen::VectorXd& v,
               Impact& impact) const;
  bool lower_restitution(const FrictionProblem& problem, int times, bool to_zero);
  double lowering_factor(const FrictionProblem& problem, size_t island, double most) const;
  void set_bias(FrictionProblem& problem, std::span<const double> rebound) const;

  double highest_, least_ = 0.0;
  std::vector<std::vector<int>> islands_;  ///< the contacts of each
  std::vector<double> e_;                  ///< per island
  std::vector<double> e_factor_;           ///< on e, per island
  Eigen::VectorXd newton_, walls_, u_free_;
  Impact inelastic_, rebounding_;
};

}  // namespace ballast
