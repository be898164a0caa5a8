#pragma once
// Problems of the kind that a time step gives, for the wide sweep: grains along a line, contacts
// between near ones, contacts with unmoved things on either side, one-row contacts, a driven wall.
// Also a wide sweep of such a problem.

#include <Eigen/Dense>

#include "platform/random.hpp"
#include "platform/worker_team.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "solvers/gauss_seidel/wide_sweep.hpp"

namespace ballast::samples {

struct GrainSettings {
  int grains = 150, contacts = 600;
  int reach = 12;           ///< contacts join grain k with k + 1 ... k + reach
  bool has_wall = true;     ///< the last body: one unknown, every tenth contact, one row
  double mass_ratio = 1.0;  ///< masses log-uniform in [1e-3, 1e-3 mass_ratio] kg
  std::uint64_t seed = 1;
};

/// diag(m, m, m, J), where J is a full block or a diagonal one; the radius is 1 cm.
inline Eigen::MatrixXd grain_mass(double m, bool is_full, Random& random) {
  Eigen::Matrix3d root = Eigen::Matrix3d::Identity();
  if (is_full)
    for (double& x : root.reshaped()) x += random.uniform(-0.2, 0.2);
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(6, 6);
  mass.topLeftCorner<3, 3>().diagonal().setConstant(m);
  mass.bottomRightCorner<3, 3>() = 4e-5 * m * (root * root.transpose());
  return mass;
}

inline void add_contact(FrictionProblem& problem, int a, int b, int rows, Random& random) {
  Eigen::MatrixXd line(rows, 3);
  for (double& x : line.reshaped()) x = random.uniform(-1.0, 1.0);
  for (int i = 0; i < rows; ++i) line(i, i) += 2.0;
  const auto block = [&](int body, double sign) {
    Eigen::MatrixXd entries(rows, problem.dynamics.body_dofs(body));
    for (double& x : entries.reshaped()) x = random.uniform(-0.01, 0.01);
    if (entries.cols() == 6)
      entries.leftCols(3) = sign * line;
    else
      entries.setOnes();
    return entries;
  };
  const Eigen::MatrixXd at_a = block(a, -1.0), at_b = block(b, 1.0);
  problem.add_contact(a, b, rows == 1 ? 0.0 : random.uniform(0.1, 0.8), at_a, at_b);
}

inline FrictionProblem grain_problem(const GrainSettings& settings = {}) {
  Random random(settings.seed);
  FrictionProblem problem;
  problem.has_dynamics = true;
  DynamicsForm& d = problem.dynamics;
  for (int g = 0; g < settings.grains; ++g) {
    const double m = random.log_uniform(1e-3, 1e-3 * settings.mass_ratio);
    d.add_body(grain_mass(m, /*is_full=*/g % 2, random));
  }
  if (settings.has_wall) d.add_body(Eigen::MatrixXd::Constant(1, 1, 0.5));
  for (int c = 0; c < settings.contacts; ++c) {
    int a = random.below(settings.grains), b = a + 1 + random.below(settings.reach);
    if (b >= settings.grains) b = -1;
    if (random.below(4) == 0) std::swap(a, b);
    const bool on_wall = settings.has_wall && c % 10 == 0;
    if (on_wall) (a >= 0 ? b : a) = settings.grains;
    add_contact(problem, a, b, on_wall || c % 7 == 0 ? 1 : 3, random);
  }
  d.v_free.resize(d.dof_count());
  for (double& v : d.v_free) v = random.uniform(-0.1, 0.1);
  d.bias.resize(problem.row_count());
  for (double& b : d.bias) b = random.uniform(-0.03, 0.01);
  return problem;
}

/// A search's step before its k-th sweep: zero, later along the sweeps before.
inline SearchStep varied_step(int k, bool is_conjugate) {
  return {k < 2 ? 0.0 : 0.3 + 0.05 * (k % 7), is_conjugate};
}

/// A wide sweep from zero impulses, in double or single precision.
struct Wide {
  SweepPlan plan;
  WorkerTeam team;
  WideSweep sweep{plan};
  bool fits;

  explicit Wide(const FrictionProblem& problem, bool single = false,
                const GroupKernels& kernels = *all_group_kernels().front(), int threads = 1) {
    team.resize(threads);
    plan.use_team(&team);
    plan.prepare(problem);
    sweep.use_kernels(kernels);
    fits = sweep.prepare(problem);
    sweep.allow_single(single);
    if (fits) sweep.load(problem, Impulses::Zero(problem.row_count()));
  }
};

}  // namespace ballast::samples
