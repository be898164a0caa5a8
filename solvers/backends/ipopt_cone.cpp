#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/backends/ipopt.hpp"
#include "solvers/backends/ipopt_program.hpp"
#include "solvers/parts/cone_program.hpp"

namespace ballast {
namespace {

using Eigen::VectorXd;

/// min 1/2 x.W x + q.x in polar coordinates y (n, d1, d2): n >= 0 and 1 - |d|^2 >= 0 for each
/// contact with friction.
class ConeNlp final : public IpoptProgram {
 public:
  ConeNlp(const ConeProgram& cones, const VectorXd& q) : cones_(cones), q_(q) {
    for (int k = 0; k < cones.contact_count(); ++k) {
      if (cones.has_friction(k)) with_friction_.push_back(k);
      for (int row = cones.row_begin[k]; row < cones.row_begin[k + 1]; ++row) contact_.push_back(k);
    }
  }

  int variables() const override { return cones_.row_count(); }
  int constraints() const override { return static_cast<int>(with_friction_.size()); }

  void bounds(VectorXd& x_low, VectorXd& x_high, VectorXd& g_low, VectorXd& g_high) const override {
    x_low.setConstant(-ipopt_unbounded);
    x_high.setConstant(ipopt_unbounded);
    for (int k = 0; k < cones_.contact_count(); ++k) x_low[cones_.row_begin[k]] = 0.0;
    g_low.setZero();
    g_high.setConstant(ipopt_unbounded);
  }
  double objective(const VectorXd& y) const override {
    const VectorXd x = cones_.from_polar(y);
    return 0.5 * x.dot(cones_.w * x) + q_.dot(x);
  }
  void gradient(const VectorXd& y, VectorXd& gradient) const override {
    gradient = cones_.polar_gradient(y, velocity(y));
  }

  void constraint_values(const VectorXd& y, VectorXd& g) const override {
    g.resize(constraints());
    for (int i = 0; i < constraints(); ++i)
      g[i] = 1.0 - y.segment<2>(first_row(i) + 1).squaredNorm();
  }
  void jacobian(const VectorXd& y, Entries& entries) const override {
    entries.clear();
    for (int i = 0; i < constraints(); ++i)
      for (int j = 1; j <= 2; ++j) entries.add(i, first_row(i) + j, -2.0 * y[first_row(i) + j]);
  }
  void hessian(const VectorXd& y, double factor, const VectorXd& multipliers,
               Entries& entries) const override {
    entries.clear();
    // With x = x(y) and u = W x + q the second derivatives are J^T W J + sum_i u_i x_i''. Of x_T =
    // mu n d only the mixed ones, mu, are not zero. Each 1 - |d|^2 adds -2 times its multiplier.
    for (int row = 0; row < cones_.row_count(); ++row)
      for (SparseRows::InnerIterator entry(cones_.w, row); entry; ++entry)
        add_product(y, row, static_cast<int>(entry.col()), factor * entry.value(), entries);
    const VectorXd u = velocity(y);
    for (int i = 0; i < constraints(); ++i)
      for (int j = 1; j <= 2; ++j) {
        const int row = first_row(i) + j;
        entries.add(row, first_row(i), factor * cones_.friction[with_friction_[i]] * u[row]);
        entries.add(row, row, -2.0 * multipliers[i]);
      }
  }

 private:
  /// x_row depends on at most two entries of y.
  struct Slopes {
    int count, entry[2];
    double slope[2];
  };

  int first_row(int i) const { return cones_.row_begin[with_friction_[i]]; }
  VectorXd velocity(const VectorXd& y) const { return cones_.w * cones_.from_polar(y) + q_; }

  Slopes slopes(const VectorXd& y, int row) const {
    // x_N is n itself; an entry of x_T is mu n d and depends on n and its own d.
    const int k = contact_[row], normal = cones_.row_begin[k];
    if (row == normal) return {1, {row, 0}, {1.0, 0.0}};
    return {2, {normal, row}, {cones_.friction[k] * y[row], cones_.friction[k] * y[normal]}};
  }
  /// value * x_i x_j, second derivatives of products of first ones: lower triangle.
  void add_product(const VectorXd& y, int i, int j, double value, Entries& entries) const {
    const Slopes a = slopes(y, i), b = slopes(y, j);
    for (int p = 0; p < a.count; ++p)
      for (int q = 0; q < b.count; ++q)
        if (a.entry[p] >= b.entry[q])
          entries.add(a.entry[p], b.entry[q], value * a.slope[p] * b.slope[q]);
  }

  const ConeProgram& cones_;
  const VectorXd& q_;
  std::vector<int> with_friction_;  ///< contact of each constraint
  std::vector<int> contact_;        ///< of each row
};

class IpoptCone final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override { cones_.take(problem); }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    constexpr int patience = 12;
    return cones_.solve(problem, std::move(start), budget, patience,
                        [this](const ConeRequest& request, RoundAnswer& answer) {
                          const ConeNlp nlp(cones_, request.q);
                          const VectorXd u = cones_.w * request.start + request.q;
                          const VectorXd inside = cones_.to_polar(request.start, u, 0.1, 0.9);
                          IpoptSettings settings;
                          settings.tolerance = std::clamp(1e-2 * request.accuracy, 1e-13, 1e-6);
                          settings.max_iterations = std::min(500, request.left.max_iterations);
                          settings.max_seconds = request.left.max_seconds;
                          const IpoptAnswer ipopt = run_ipopt(nlp, inside, settings);
                          if (ipopt.x.size() > 0) answer.x = cones_.from_polar(ipopt.x);
                          answer.iterations = ipopt.iterations;
                          answer.seconds = ipopt.seconds;
                        });
  }

 private:
  ConeProgram cones_;
};

}  // namespace

bool has_ipopt() { return true; }

std::unique_ptr<Solver> make_ipopt() { return std::make_unique<IpoptCone>(); }

}  // namespace ballast
