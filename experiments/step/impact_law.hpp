#pragma once
// Newton's law of restitution, limited by energy.
//
// Newton's e speaks of normal velocities alone: u_N+ >= -e u_N-. With friction, or where a contact
// that opens is pushed shut by others, it can give energy (Kane and Levinson 1985; Glocker 2013).
// So it is limited. With u_free the relative velocity without contact impulses and u the one at the
// step's end, the contacts of an island take from the free motion
//
//   L(r) = -1/2 sum_c r_c . (u_c + u_free,c)      [J], walls' own work apart
//
// of which the inelastic impact, e = 0, takes L_0 >= 0 always. Asked is L >= (1 - e^2) L_0: the
// rebound gives back at most e^2 of what the inelastic impact takes. Moreau's law with one e for
// all velocities keeps to that; so does Newton's without friction, with equality where no force
// acts within the step, else to O(h). Where Newton's doesn't, the island's e is lowered to where it
// does; e = 0 always does.

#include <span>
#include <vector>

#include "problems/algebra/islands.hpp"
#include "solvers/seam/run_solver.hpp"

namespace ballast {

class ImpactLaw {
 public:
  /// `highest`: of all coefficients of restitution.
  explicit ImpactLaw(double highest) : highest_(highest) {}

  /// Solves `problem`, in whose bias the normal row of contact c holds rebound[c] = e u_N- <= 0
  /// among the rest, e = restitution[c]; the bias is left as it was solved with. An island's e is
  /// the highest of its contacts'. Two solves where something rebounds,
  /// some more where e is lowered. Throws as SolverRunner::run.
  SolverRun solve(SolverRunner& runner, Solver& solver, FrictionProblem& problem,
                  std::span<const double> rebound, std::span<const double> restitution,
                  Impulses start, const Budget& budget);

  /// The lowest coefficient in force in the last solve(): the highest of all, or what an island's
  /// was lowered to.
  double least_restitution() const { return least_; }

 private:
  struct Impact {
    Impulses r;
    Eigen::VectorXd u;  ///< with the walls' motion, without the rebound
    double error = 0.0;
  };

  void measure(FrictionProblem& problem, const SolverRun& run, const Eigen::VectorXd& v,
               Impact& impact) const;
  bool lower_restitution(const FrictionProblem& problem, int times, bool to_zero);
  double lowering_factor(const FrictionProblem& problem, size_t island, double most) const;
  void set_bias(FrictionProblem& problem, std::span<const double> rebound) const;

  double highest_, least_ = 0.0;
  std::vector<std::vector<int>> islands_;  ///< contacts of each
  std::vector<double> e_;                  ///< per island
  std::vector<double> e_factor_;           ///< of e, per island
  Eigen::VectorXd newton_, walls_, u_free_;
  Impact inelastic_, rebounding_;
};

}  // namespace ballast
