#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <nlopt.h>

#include "solvers/backends/backends.hpp"
#include "solvers/parts/cone_program.hpp"

namespace ballast {
namespace {

using Eigen::VectorXd;

/// The data of NLopt's callbacks: the cone program over the contacts that are not left at zero.
struct Program {
  SparseRows w;
  VectorXd q;
  std::vector<int> row_begin;  ///< first row of each contact with friction
  std::vector<double> friction;
};

double objective(unsigned n, const double* values, double* gradient, void* data) {
  const Program& program = *static_cast<const Program*>(data);
  const Eigen::Map<const VectorXd> x(values, n);
  const VectorXd wx = program.w * x;
  if (gradient) Eigen::Map<VectorXd>(gradient, n) = wx + program.q;
  return 0.5 * x.dot(wx) + x.dot(program.q);
}

/// |x_T| - mu x_N <= 0 per contact with friction.
void cones(unsigned m, double* result, unsigned n, const double* x, double* gradient, void* data) {
  const Program& program = *static_cast<const Program*>(data);
  if (gradient) std::fill(gradient, gradient + static_cast<std::size_t>(m) * n, 0.0);
  for (unsigned i = 0; i < m; ++i) {
    const int at = program.row_begin[i];
    const double length = std::hypot(x[at + 1], x[at + 2]);
    result[i] = length - program.friction[i] * x[at];
    if (!gradient) continue;
    double* slope = gradient + static_cast<std::size_t>(i) * n + at;
    slope[0] = -program.friction[i];
    slope[1] = length > 0.0 ? x[at + 1] / length : 0.0;
    slope[2] = length > 0.0 ? x[at + 2] / length : 0.0;
  }
}

class Nlopt final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    if (problem.contact_count() > nlopt_limit)
      throw UnsupportedProblem("nlopt_slsqp: " + std::to_string(problem.contact_count()) +
                               " contacts; at most " + std::to_string(nlopt_limit) +
                               " (a dense quadratic program per step)");
    cones_.take(problem);
  }

  Solved solve(const FrictionProblem&, Impulses start, const Budget& budget) override {
    return cones_.solve(
        std::move(start), budget, /*patience=*/40,
        [this](const ConeRequest& request, RoundAnswer& answer) { run(request, answer); });
  }

 private:
  /// Contacts whose projected gradient step P_K(x - u) ends at the apex stay there for this round:
  /// no constraint of theirs has a gradient that NLopt could use. The others start from that step.
  void run(const ConeRequest& request, RoundAnswer& answer) {
    VectorXd x = request.start - cones_.w * request.start - request.q;
    Program program;
    std::vector<int> row;
    cones_.project(x);
    for (int k = 0; k < cones_.contact_count(); ++k) {
      const int at = cones_.row_begin[k], rows = cones_.row_begin[k + 1] - at;
      if (!(x[at] > 0.0)) continue;
      if (rows == 3) {
        program.row_begin.push_back(static_cast<int>(row.size()));
        program.friction.push_back(cones_.friction[k]);
      }
      for (int i = 0; i < rows; ++i) row.push_back(at + i);
    }
    answer.x = std::move(x);
    if (row.empty()) return;
    // NLopt solves the program of the contacts that are left.
    program.w = chosen(cones_.w, row);
    program.q = request.q(row);
    VectorXd y = answer.x(row);
    answer.iterations = optimise(request, program, row, y);
    answer.finished = answer.iterations < std::min(most_evaluations, request.left.max_iterations);
    answer.x(row) = y;
  }

  /// Returns the evaluations spent; `y` is the start and becomes the answer.
  int optimise(const ConeRequest& request, Program& program, const std::vector<int>& row,
               VectorXd& y) const {
    const unsigned n = static_cast<unsigned>(row.size()),
                   m = static_cast<unsigned>(program.row_begin.size());
    // Normal impulses are bounded below by zero; the tangential ones by the cones alone.
    VectorXd low = VectorXd::Constant(n, -HUGE_VAL);
    for (unsigned i = 0; i < n; ++i)
      if (std::binary_search(cones_.row_begin.begin(), cones_.row_begin.end(), row[i]))
        low[i] = 0.0;
    const double small = std::clamp(1e-2 * request.accuracy, 1e-14, 1e-4);
    nlopt_opt optimiser = nlopt_create(NLOPT_LD_SLSQP, n);
    nlopt_set_lower_bounds(optimiser, low.data());
    nlopt_set_min_objective(optimiser, objective, &program);
    const VectorXd violation = VectorXd::Constant(m, small);
    if (m > 0) nlopt_add_inequality_mconstraint(optimiser, m, cones, &program, violation.data());
    nlopt_set_xtol_abs1(optimiser, small);
    nlopt_set_maxeval(optimiser, std::min(most_evaluations, request.left.max_iterations));
    nlopt_set_maxtime(optimiser, std::max(1e-3, request.left.max_seconds));
    double value = 0.0;
    nlopt_optimize(optimiser, y.data(), &value);  // its status is ignored: the judge looks at y
    const int evaluations = nlopt_get_numevals(optimiser);
    nlopt_destroy(optimiser);
    return evaluations;
  }

  static constexpr int most_evaluations = 400;  ///< of one round
  ConeProgram cones_;
};

}  // namespace

std::unique_ptr<Solver> make_nlopt() { return std::make_unique<Nlopt>(); }

}  // namespace ballast
