#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>

#include "platform/clock.hpp"
#include "solvers/backends/backends.hpp"
#include "solvers/parts/cone_program.hpp"

namespace ballast {
namespace {

using Eigen::VectorXd;
using Ipopt::Index;
using Ipopt::Number;

// Polar coordinates y: the normal entry stays, the tangential ones are d with x_T = mu x_N d and
// |d| <= 1. The cone is then a half-line times a disc, without the apex where no constraint has a
// gradient, though 1/2 x.W x is no longer convex in y.

VectorXd from_polar(const ConeProgram& cones, const VectorXd& y) {
  VectorXd x = y;
  for (int k = 0; k < cones.contact_count(); ++k)
    if (cones.has_friction(k))
      x.segment<2>(cones.row_begin[k] + 1) *= cones.friction[k] * y[cones.row_begin[k]];
  return x;
}

/// A point near the request's start, with x_N >= 0.1 and |d| <= 0.9. Where x_N = 0 leaves d open,
/// it points halfway to the disc's edge against the sliding, as friction most likely does.
VectorXd start_inside(const ConeProgram& cones, const ConeRequest& request) {
  constexpr double floor = 0.1, longest = 0.9;
  const VectorXd &x = request.start, u = cones.w * x + request.q;
  VectorXd y(cones.row_count());
  for (int k = 0; k < cones.contact_count(); ++k) {
    const int at = cones.row_begin[k];
    y[at] = std::max(floor, x[at]);
    if (!cones.has_friction(k)) continue;
    Eigen::Vector2d d = x.segment<2>(at + 1) / (cones.friction[k] * y[at]);
    const Eigen::Vector2d sliding = u.segment<2>(at + 1);
    if (!(x[at] > 0.0) && sliding.norm() > 0.0) d = -0.5 * sliding.normalized();
    y.segment<2>(at + 1) = d * std::min(1.0, longest / std::max(longest, d.norm()));
  }
  return y;
}

/// Derivatives as a list (row, column, value); entries of the same place are added. Ipopt asks for
/// the places once: every call lists the same ones in the same order.
struct Entries {
  std::vector<Index> row, column;
  std::vector<Number> value;
  void clear() { row.clear(), column.clear(), value.clear(); }
  void add(int i, int j, double x) { row.push_back(i), column.push_back(j), value.push_back(x); }
};

/// min 1/2 x.W x + q.x in polar coordinates y (n, d1, d2): n >= 0 and 1 - |d|^2 >= 0 for each
/// contact with friction.
class ConeNlp final : public Ipopt::TNLP {
 public:
  ConeNlp(const ConeProgram& cones, const VectorXd& q, const VectorXd& start)
      : cones_(cones), q_(q), start_(start), answer_(start) {
    for (int k = 0; k < cones.contact_count(); ++k) {
      if (cones.has_friction(k)) with_friction_.push_back(k);
      for (int row = cones.row_begin[k]; row < cones.row_begin[k + 1]; ++row) contact_.push_back(k);
    }
  }

  const VectorXd& answer() const { return answer_; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_entries, Index& hessian_entries,
                    IndexStyleEnum& style) override {
    n = cones_.row_count();
    m = constraints();
    jacobian(start_);
    hessian(start_, 1.0, VectorXd::Ones(m));
    jacobian_entries = static_cast<Index>(jacobian_.value.size());
    hessian_entries = static_cast<Index>(hessian_.value.size());
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* x_low, Number* x_high, Index m, Number* g_low,
                       Number* g_high) override {
    constexpr double unbounded = 1e20;
    std::fill(x_low, x_low + n, -unbounded);
    std::fill(x_high, x_high + n, unbounded);
    for (int k = 0; k < cones_.contact_count(); ++k) x_low[cones_.row_begin[k]] = 0.0;
    std::fill(g_low, g_low + m, 0.0);
    std::fill(g_high, g_high + m, unbounded);
    return true;
  }
  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool,
                          Number*) override {
    std::copy(start_.begin(), start_.end(), x);
    return true;
  }
  bool eval_f(Index n, const Number* y, bool, Number& value) override {
    const VectorXd x = from_polar(cones_, take(y, n));
    value = 0.5 * x.dot(cones_.w * x) + q_.dot(x);
    return std::isfinite(value);
  }
  bool eval_grad_f(Index n, const Number* y, bool, Number* gradient) override {
    // By the chain rule for x_T = mu x_N d: dx_T / dx_N = mu d and dx_T / dd = mu x_N.
    const VectorXd at = take(y, n), u = velocity(at);
    VectorXd slope = u;
    for (const int k : with_friction_) {
      const int row = cones_.row_begin[k];
      slope[row] += cones_.friction[k] * at.segment<2>(row + 1).dot(u.segment<2>(row + 1));
      slope.segment<2>(row + 1) *= cones_.friction[k] * at[row];
    }
    return give(slope, gradient);
  }
  bool eval_g(Index n, const Number* y, bool, Index m, Number* g) override {
    VectorXd values(m);
    for (int i = 0; i < m; ++i)
      values[i] = 1.0 - take(y, n).segment<2>(first_row(i) + 1).squaredNorm();
    return give(values, g);
  }
  bool eval_jac_g(Index n, const Number* y, bool, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (values) jacobian(take(y, n));
    return give(jacobian_, rows, columns, values);
  }
  bool eval_h(Index n, const Number* y, bool, Number factor, Index m, const Number* multipliers,
              bool, Index, Index* rows, Index* columns, Number* values) override {
    if (values) hessian(take(y, n), factor, take(multipliers, m));
    return give(hessian_, rows, columns, values);
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* y, const Number*,
                         const Number*, Index, const Number*, const Number*, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    answer_ = take(y, n);
  }

 private:
  /// The derivatives of x_row, which depends on at most two entries of y.
  struct Slopes {
    int count, entry[2];
    double slope[2];
  };

  int constraints() const { return static_cast<int>(with_friction_.size()); }
  int first_row(int i) const { return cones_.row_begin[with_friction_[i]]; }
  VectorXd velocity(const VectorXd& y) const { return cones_.w * from_polar(cones_, y) + q_; }

  Slopes slopes(const VectorXd& y, int row) const {
    // x_N is n itself; an entry of x_T is mu n d and depends on n and its own d.
    const int k = contact_[row], normal = cones_.row_begin[k];
    if (row == normal) return {1, {row, 0}, {1.0, 0.0}};
    return {2, {normal, row}, {cones_.friction[k] * y[row], cones_.friction[k] * y[normal]}};
  }
  /// Adds the lower triangle of value * x_i' x_j'^T, the product of two first derivatives.
  void add_product(const VectorXd& y, int i, int j, double value) {
    const Slopes a = slopes(y, i), b = slopes(y, j);
    for (int p = 0; p < a.count; ++p)
      for (int q = 0; q < b.count; ++q)
        if (a.entry[p] >= b.entry[q])
          hessian_.add(a.entry[p], b.entry[q], value * a.slope[p] * b.slope[q]);
  }

  void jacobian(const VectorXd& y) {
    jacobian_.clear();
    for (int i = 0; i < constraints(); ++i)
      for (int j = 1; j <= 2; ++j) jacobian_.add(i, first_row(i) + j, -2.0 * y[first_row(i) + j]);
  }

  /// Lower triangle of factor * f'' + sum multiplier_i g_i''.
  void hessian(const VectorXd& y, double factor, const VectorXd& multipliers) {
    hessian_.clear();
    // With x = x(y) and u = W x + q the second derivatives are J^T W J + sum_i u_i x_i''. Of x_T =
    // mu n d only the mixed ones, mu, are not zero. Each 1 - |d|^2 adds -2 times its multiplier.
    for (int row = 0; row < cones_.row_count(); ++row)
      for (SparseRows::InnerIterator entry(cones_.w, row); entry; ++entry)
        add_product(y, row, static_cast<int>(entry.col()), factor * entry.value());
    const VectorXd u = velocity(y);
    for (int i = 0; i < constraints(); ++i)
      for (int j = 1; j <= 2; ++j) {
        const int row = first_row(i) + j;
        hessian_.add(row, first_row(i), factor * cones_.friction[with_friction_[i]] * u[row]);
        hessian_.add(row, row, -2.0 * multipliers[i]);
      }
  }

  static VectorXd take(const Number* x, Index size) { return Eigen::Map<const VectorXd>(x, size); }
  /// False where a value is not finite: Ipopt then shortens its step.
  static bool give(const VectorXd& x, Number* out) {
    std::copy(x.begin(), x.end(), out);
    return x.allFinite();
  }
  /// Ipopt asks twice: first for the pattern (no values), then for values.
  static bool give(const Entries& entries, Index* rows, Index* columns, Number* values) {
    const Index count = static_cast<Index>(entries.value.size());
    if (values) return give(take(entries.value.data(), count), values);
    std::copy(entries.row.begin(), entries.row.end(), rows);
    std::copy(entries.column.begin(), entries.column.end(), columns);
    return true;
  }

  const ConeProgram& cones_;
  const VectorXd& q_;
  VectorXd start_, answer_;
  Entries jacobian_, hessian_;
  std::vector<int> with_friction_;  ///< contact of each constraint
  std::vector<int> contact_;        ///< of each row
};

class IpoptCone final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override { cones_.take(problem); }

  /// Each of Ipopt's solves runs in a child process: Debian's Ipopt 3.11 with MUMPS does not
  /// survive a second one in the same process.
  Solved solve(const FrictionProblem&, Impulses start, const Budget& budget) override {
    const auto convex = [this](const ConeRequest& request, RoundAnswer& answer) {
      const auto run = [&](RoundAnswer& called) { return call(request, called); };
      answer_apart(request.left, run, answer);
    };
    return cones_.solve(std::move(start), budget, /*patience=*/12, convex);
  }

 private:
  static void set_options(Ipopt::OptionsList& options, const ConeRequest& request) {
    options.SetIntegerValue("print_level", 0);
    options.SetStringValue("sb", "yes");
    options.SetStringValue("linear_solver", "mumps");
    options.SetStringValue("nlp_scaling_method", "none");  // the program is scaled already
    options.SetNumericValue("bound_relax_factor", 0.0);    // the cone is not relaxed
    // No "acceptable" level: a round ends where the program is solved, or at a limit.
    const double tolerance = std::clamp(1e-2 * request.accuracy, 1e-13, 1e-6);
    options.SetNumericValue("tol", tolerance);
    options.SetNumericValue("constr_viol_tol", 1e-10);
    options.SetNumericValue("compl_inf_tol", tolerance);
    options.SetIntegerValue("acceptable_iter", 0);
    options.SetIntegerValue("max_iter", std::min(500, request.left.max_iterations));
    // Leaves time to return the iterate; the parent kills the process at the limit itself.
    if (request.left.max_seconds < 1e6)
      options.SetNumericValue("max_cpu_time", std::max(1e-3, 0.9 * request.left.max_seconds));
  }

  /// False where Ipopt did not start. Nothing is destroyed: the answer is sent after this function,
  /// and Ipopt's destructors may crash.
  bool call(const ConeRequest& request, RoundAnswer& answer) const {
    ConeNlp* nlp = new ConeNlp(cones_, request.q, start_inside(cones_, request));
    auto* held = new Ipopt::SmartPtr<Ipopt::TNLP>(nlp);
    auto* application =
        new Ipopt::SmartPtr<Ipopt::IpoptApplication>(new Ipopt::IpoptApplication(false));
    set_options(*(*application)->Options(), request);
    if ((*application)->Initialize("") != Ipopt::Solve_Succeeded) return false;
    const Stopwatch watch;
    (*application)->OptimizeTNLP(*held);
    answer.seconds = watch.seconds();
    answer.x = from_polar(cones_, nlp->answer());
    const Ipopt::SmartPtr<Ipopt::SolveStatistics> statistics = (*application)->Statistics();
    if (IsValid(statistics)) answer.iterations = static_cast<int>(statistics->IterationCount());
    return true;
  }

  ConeProgram cones_;
};

}  // namespace

std::unique_ptr<Solver> make_ipopt() { return std::make_unique<IpoptCone>(); }

}  // namespace ballast
