#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/backends/ipopt.hpp"
#include "solvers/backends/ipopt_program.hpp"
#include "solvers/parts/cone_program.hpp"

namespace ballast {
namespace {

using Eigen::VectorXd;

// Unknowns of a contact with friction, in this order: n, d1, d2, speed, u_N, u_1, u_2; without
// friction n, u_N. r_N = n, r_T = mu n d:
//   u = W r + q,   0 <= n ⟂ u_N >= 0,   u_T + speed d = 0,   0 <= speed ⟂ 1 - |d|^2 >= 0
// Both products are held below `relaxation`, and their sum is minimised.
class MpccNlp final : public IpoptProgram {
 public:
  explicit MpccNlp(const ConeProgram& cones) : cones_(cones) {
    for (int k = 0; k < cones.contact_count(); ++k) {
      variable_.push_back(variables_);
      constraint_.push_back(constraints_);
      variables_ += cones.has_friction(k) ? 7 : 2;
      constraints_ += cones.has_friction(k) ? 5 : 1;
    }
  }

  double relaxation = 1.0;

  int variables() const override { return variables_; }
  int constraints() const override { return cones_.row_count() + constraints_; }

  void bounds(VectorXd& x_low, VectorXd& x_high, VectorXd& g_low, VectorXd& g_high) const override {
    x_low.setConstant(-ipopt_unbounded);
    x_high.setConstant(ipopt_unbounded);
    g_low.setZero();
    g_high.setZero();
    // The constraints of a contact, behind the rows of u = W r + q;
    // those behind +0 with friction only:
    //
    //     +0     n u_N <= relaxation                 +3     1 - |d|^2 >= 0
    //     +1,+2  u_T + speed d = 0                   +4     speed (1 - |d|^2) <= relaxation
    for (int k = 0; k < cones_.contact_count(); ++k) {
      const int v = variable_[k], g = row(k);
      x_low[v] = 0.0;
      x_low[velocity(k)] = 0.0;
      g_low[g] = -ipopt_unbounded;
      g_high[g] = relaxation;
      if (!cones_.has_friction(k)) continue;
      x_low[v + 3] = 0.0;
      g_low[g + 3] = 0.0;  // 1 - |d|^2
      g_high[g + 3] = ipopt_unbounded;
      g_low[g + 4] = -ipopt_unbounded;
      g_high[g + 4] = relaxation;
    }
  }

  double objective(const VectorXd& x) const override {
    double gap = 0.0;
    for (int k = 0; k < cones_.contact_count(); ++k) {
      const int v = variable_[k];
      gap += x[v] * x[velocity(k)];
      if (cones_.has_friction(k))
        gap += x[v + 3] * (1.0 - x[v + 1] * x[v + 1] - x[v + 2] * x[v + 2]);
    }
    return gap;
  }
  void gradient(const VectorXd& x, VectorXd& gradient) const override {
    gradient.setZero(variables_);
    for (int k = 0; k < cones_.contact_count(); ++k) {
      const int v = variable_[k];
      gradient[v] = x[velocity(k)];
      gradient[velocity(k)] = x[v];
      if (!cones_.has_friction(k)) continue;
      gradient[v + 1] = -2.0 * x[v + 3] * x[v + 1];
      gradient[v + 2] = -2.0 * x[v + 3] * x[v + 2];
      gradient[v + 3] = 1.0 - x[v + 1] * x[v + 1] - x[v + 2] * x[v + 2];
    }
  }

  void constraint_values(const VectorXd& x, VectorXd& g) const override {
    g.resize(constraints());
    g.head(cones_.row_count()) = velocities(x) - cones_.w_as_is * impulses(x) - cones_.q;
    for (int k = 0; k < cones_.contact_count(); ++k) {
      const int v = variable_[k], at = row(k);
      g[at] = x[v] * x[velocity(k)];
      if (!cones_.has_friction(k)) continue;
      g[at + 1] = x[v + 5] + x[v + 3] * x[v + 1];
      g[at + 2] = x[v + 6] + x[v + 3] * x[v + 2];
      g[at + 3] = 1.0 - x[v + 1] * x[v + 1] - x[v + 2] * x[v + 2];
      g[at + 4] = x[v + 3] * g[at + 3];
    }
  }

  void jacobian(const VectorXd& x, Entries& entries) const override {
    entries.clear();
    for (int k = 0; k < cones_.contact_count(); ++k)
      for (int i = cones_.row_begin[k]; i < cones_.row_begin[k + 1]; ++i) {
        entries.add(i, velocity(k) + i - cones_.row_begin[k], 1.0);
        for (SparseRows::InnerIterator entry(cones_.w_as_is, i); entry; ++entry)
          add_impulse_derivative(x, i, static_cast<int>(entry.col()), -entry.value(), entries);
      }
    for (int k = 0; k < cones_.contact_count(); ++k) {
      const int v = variable_[k], at = row(k);
      entries.add(at, v, x[velocity(k)]);
      entries.add(at, velocity(k), x[v]);
      if (!cones_.has_friction(k)) continue;
      for (int i = 1; i <= 2; ++i) {
        entries.add(at + i, v + 4 + i, 1.0);
        entries.add(at + i, v + 3, x[v + i]);
        entries.add(at + i, v + i, x[v + 3]);
        entries.add(at + 3, v + i, -2.0 * x[v + i]);
        entries.add(at + 4, v + i, -2.0 * x[v + 3] * x[v + i]);
      }
      entries.add(at + 4, v + 3, 1.0 - x[v + 1] * x[v + 1] - x[v + 2] * x[v + 2]);
    }
  }

  void hessian(const VectorXd& x, double factor, const VectorXd& multipliers,
               Entries& entries) const override {
    entries.clear();
    const VectorXd push = cones_.w_as_is.transpose() * multipliers.head(cones_.row_count());
    // Second derivatives come from products alone: n u_N, speed d, n d
    // within r_T, speed |d|^2, |d|^2.
    for (int k = 0; k < cones_.contact_count(); ++k) {
      const int v = variable_[k], at = row(k);
      entries.add(velocity(k), v, factor + multipliers[at]);
      if (!cones_.has_friction(k)) continue;
      const double slip = factor + multipliers[at + 4];
      for (int i = 1; i <= 2; ++i) {
        entries.add(v + i, v, -cones_.friction[k] * push[cones_.row_begin[k] + i]);
        entries.add(v + i, v + i, -2.0 * (multipliers[at + 3] + slip * x[v + 3]));
        entries.add(v + 3, v + i, multipliers[at + i] - 2.0 * slip * x[v + i]);
      }
    }
  }

  VectorXd impulses(const VectorXd& x) const {
    VectorXd r(cones_.row_count());
    for (int k = 0; k < cones_.contact_count(); ++k) {
      const int v = variable_[k], at = cones_.row_begin[k];
      r[at] = x[v];
      if (cones_.has_friction(k))
        r.segment<2>(at + 1) = cones_.friction[k] * x[v] * x.segment<2>(v + 1);
    }
    return r;
  }

  /// Well inside all bounds, near the impulses r.
  VectorXd start(const VectorXd& r) const {
    VectorXd x = VectorXd::Zero(variables_);
    const VectorXd u = cones_.w_as_is * r + cones_.q;
    for (int k = 0; k < cones_.contact_count(); ++k) {
      const int v = variable_[k], at = cones_.row_begin[k];
      x[v] = std::max(0.1, r[at]);
      x[velocity(k)] = std::max(0.1, u[at]);
      if (!cones_.has_friction(k)) continue;
      x.segment<2>(velocity(k) + 1) = u.segment<2>(at + 1);
      x[v + 3] = 0.1 + u.segment<2>(at + 1).norm();
      x.segment<2>(v + 1) = -0.9 * u.segment<2>(at + 1) / x[v + 3];
    }
    return x;
  }

 private:
  int row(int k) const {
    return cones_.row_count() + constraint_[k];
  }  ///< first constraint of the contact
  int velocity(int k) const { return variable_[k] + (cones_.has_friction(k) ? 4 : 1); }

  VectorXd velocities(const VectorXd& x) const {
    VectorXd u(cones_.row_count());
    for (int k = 0; k < cones_.contact_count(); ++k)
      u.segment(cones_.row_begin[k], cones_.row_begin[k + 1] - cones_.row_begin[k]) =
          x.segment(velocity(k), cones_.row_begin[k + 1] - cones_.row_begin[k]);
    return u;
  }

  /// d r_j / d x times `factor`, into constraint i.
  void add_impulse_derivative(const VectorXd& x, int i, int j, double factor,
                              Entries& entries) const {
    const int k =
        static_cast<int>(std::upper_bound(cones_.row_begin.begin(), cones_.row_begin.end(), j) -
                         cones_.row_begin.begin()) -
        1;
    const int v = variable_[k], part = j - cones_.row_begin[k];
    if (part == 0) return entries.add(i, v, factor);
    entries.add(i, v, factor * cones_.friction[k] * x[v + part]);
    entries.add(i, v + part, factor * cones_.friction[k] * x[v]);
  }

  const ConeProgram& cones_;
  int variables_ = 0, constraints_ = 0;
  std::vector<int> variable_, constraint_;
};

class IpoptMpcc final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override { cones_.take(problem); }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    MpccNlp nlp(cones_);
    // The relaxation goes to zero round by round, a tenth at a time.
    nlp.relaxation = 1e-1;
    const double last_relaxation =
        std::clamp(1e-2 * budget.aim() / cones_.velocity_unit(), 1e-13, 1e-4);
    VectorXd x;
    constexpr int patience = 12;
    return solve_in_rounds(problem, cones_.moving(), std::move(start), budget, patience,
                           [&](const RoundRequest& request, RoundAnswer& answer) {
                             if (x.size() == 0) x = nlp.start(cones_.from_rows(request.last));
                             IpoptSettings settings;
                             settings.tolerance = std::min(1e-8, 0.1 * nlp.relaxation);
                             settings.first_barrier = std::min(0.1, nlp.relaxation);
                             settings.max_iterations = std::min(300, request.left.max_iterations);
                             settings.max_seconds = request.left.max_seconds;
                             const IpoptAnswer ipopt = run_ipopt(nlp, x, settings);
                             answer.iterations = ipopt.iterations;
                             answer.seconds = ipopt.seconds;
                             nlp.relaxation = std::max(last_relaxation, 0.1 * nlp.relaxation);
                             if (ipopt.x.size() == 0 || !ipopt.x.allFinite()) return;
                             x = ipopt.x;
                             answer.x = cones_.to_rows(nlp.impulses(x));
                           });
  }

 private:
  ConeProgram cones_;
};

}  // namespace

std::unique_ptr<Solver> make_ipopt_mpcc() { return std::make_unique<IpoptMpcc>(); }

}  // namespace ballast
