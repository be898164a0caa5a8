// Factorisation of the packing and a solve with it: CHOLMOD on M + H^T Sigma H.

#include <memory>
#include <stdexcept>

#include "experiments/bench/kernels.hpp"
#include "solvers/parts/contact_operator.hpp"
#include "solvers/parts/shifted_delassus.hpp"

namespace ballast {
namespace {

struct FactorWork {
  ContactOperator w;
  ShiftedDelassus shifted;
  std::vector<Eigen::Matrix3d> shift, sigma;
  Eigen::VectorXd b, x;
};

}  // namespace

void add_factor_kernels(const KernelProblem& problem, std::vector<Kernel>& kernels) {
  const auto work = std::make_shared<FactorWork>();
  work->w.prepare(problem.problem);
  work->shifted.prepare(work->w);
  for (const double rho : work->w.rho()) {  // P_c = lambda_max(W_cc): ADMM's penalty
    const double penalty = rho > 0.0 ? 1.0 / rho : 1.0;
    work->shift.push_back(penalty * Eigen::Matrix3d::Identity());
    work->sigma.push_back(Eigen::Matrix3d::Identity() / penalty);
  }
  if (!work->shifted.factor(work->shift, work->sigma))
    throw std::runtime_error("bench kernels: W + P of the packing is not definite");
  free_contact_velocity(problem.problem, work->b);
  const double contacts = problem.problem.contact_count();
  kernels.push_back({"factor", "factorisation of the packing", "ns/contact", contacts,
                     [work] { work->shifted.factor(work->shift, work->sigma); }});
  kernels.push_back({"factor", "solve with it", "ns/contact", contacts,
                     [work] { work->shifted.solve(work->b, work->x); }});
}

}  // namespace ballast
