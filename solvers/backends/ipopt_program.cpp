#include "solvers/backends/ipopt_program.hpp"

#include <algorithm>
#include <cmath>

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>

#include "platform/child_process.hpp"
#include "platform/clock.hpp"
#include "platform/pack.hpp"

namespace ballast {
namespace {

using Eigen::VectorXd;
using Ipopt::Index;
using Ipopt::Number;

/// Ipopt's interface in terms of ours.
class Adapter final : public Ipopt::TNLP {
 public:
  Adapter(const IpoptProgram& program, const VectorXd& start)
      : program_(program), start_(start), answer_(start) {}

  const VectorXd& answer() const { return answer_; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_entries, Index& hessian_entries,
                    IndexStyleEnum& style) override {
    n = program_.variables();
    m = program_.constraints();
    // Ipopt asks for the patterns once: they may not depend on x.
    program_.jacobian(start_, jacobian_);
    program_.hessian(start_, 1.0, VectorXd::Ones(m), hessian_);
    jacobian_entries = static_cast<Index>(jacobian_.value.size());
    hessian_entries = static_cast<Index>(hessian_.value.size());
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* x_low, Number* x_high, Index m, Number* g_low,
                       Number* g_high) override {
    VectorXd xl(n), xh(n), gl(m), gh(m);
    program_.bounds(xl, xh, gl, gh);
    std::copy(xl.begin(), xl.end(), x_low);
    std::copy(xh.begin(), xh.end(), x_high);
    std::copy(gl.begin(), gl.end(), g_low);
    std::copy(gh.begin(), gh.end(), g_high);
    return true;
  }
  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool,
                          Number*) override {
    std::copy(start_.begin(), start_.end(), x);
    return true;
  }
  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = program_.objective(take(x, n));
    return std::isfinite(value);
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    program_.gradient(take(x, n), work_);
    return give(work_, gradient);
  }
  bool eval_g(Index n, const Number* x, bool, Index, Number* g) override {
    program_.constraint_values(take(x, n), work_);
    return give(work_, g);
  }
  bool eval_jac_g(Index n, const Number* x, bool, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (values) program_.jacobian(take(x, n), jacobian_);
    return give(jacobian_, rows, columns, values);
  }
  bool eval_h(Index n, const Number* x, bool, Number factor, Index m, const Number* multipliers,
              bool, Index, Index* rows, Index* columns, Number* values) override {
    if (values) program_.hessian(take(x, n), factor, take(multipliers, m), hessian_);
    return give(hessian_, rows, columns, values);
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*,
                         const Number*, Index, const Number*, const Number*, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    answer_ = take(x, n);
  }

 private:
  static VectorXd take(const Number* x, Index size) { return Eigen::Map<const VectorXd>(x, size); }
  /// Ipopt shortens its step when it is told that a value is none.
  static bool give(const VectorXd& x, Number* out) {
    std::copy(x.begin(), x.end(), out);
    return x.allFinite();
  }
  /// Ipopt asks twice: first for the pattern (no values), then for values.
  static bool give(const IpoptProgram::Entries& entries, Index* rows, Index* columns,
                   Number* values) {
    if (values) {
      std::copy(entries.value.begin(), entries.value.end(), values);
      return std::all_of(values, values + entries.value.size(),
                         [](double x) { return std::isfinite(x); });
    }
    std::copy(entries.row.begin(), entries.row.end(), rows);
    std::copy(entries.column.begin(), entries.column.end(), columns);
    return true;
  }

  const IpoptProgram& program_;
  VectorXd start_, answer_, work_;
  IpoptProgram::Entries jacobian_, hessian_;
};

void set_options(Ipopt::OptionsList& options, const IpoptSettings& settings) {
  options.SetIntegerValue("print_level", 0);
  options.SetStringValue("sb", "yes");
  options.SetStringValue("linear_solver", "mumps");
  options.SetStringValue("nlp_scaling_method", "none");  // the program is scaled already
  options.SetNumericValue("bound_relax_factor", 0.0);    // the cone is the cone
  // No "acceptable" level: a round ends where the program is solved, or at a limit.
  options.SetNumericValue("tol", settings.tolerance);
  options.SetNumericValue("constr_viol_tol", 1e-10);
  options.SetNumericValue("compl_inf_tol", settings.tolerance);
  options.SetIntegerValue("acceptable_iter", 0);
  options.SetNumericValue("mu_init", settings.first_barrier);
  options.SetIntegerValue("max_iter", settings.max_iterations);
  // In time to hand out what there is; the parent kills at the limit itself.
  if (settings.max_seconds < 1e6)
    options.SetNumericValue("max_cpu_time", std::max(1e-3, 0.9 * settings.max_seconds));
}

}  // namespace

IpoptAnswer run_ipopt(const IpoptProgram& program, const Eigen::VectorXd& start,
                      const IpoptSettings& settings) {
  const auto work = [&]() -> std::string {
    // Never destroyed: the answer is sent after this function, and Ipopt's destructors may
    // crash.
    Adapter* adapter = new Adapter(program, start);
    auto* held = new Ipopt::SmartPtr<Ipopt::TNLP>(adapter);
    auto* application =
        new Ipopt::SmartPtr<Ipopt::IpoptApplication>(new Ipopt::IpoptApplication(false));
    set_options(*(*application)->Options(), settings);
    if ((*application)->Initialize("") != Ipopt::Solve_Succeeded) return {};
    const Stopwatch watch;
    const Ipopt::ApplicationReturnStatus status = (*application)->OptimizeTNLP(*held);
    const double seconds = watch.seconds();
    const bool limited =
        status == Ipopt::Maximum_Iterations_Exceeded || status == Ipopt::Maximum_CpuTime_Exceeded;
    const Ipopt::SmartPtr<Ipopt::SolveStatistics> statistics = (*application)->Statistics();
    Packer packer;
    packer.list(adapter->answer());
    packer.number(IsValid(statistics) ? static_cast<int>(statistics->IterationCount()) : 1);
    packer.number(!limited);
    packer.number(seconds);
    return packer.bytes();
  };
  // A process that is a comparison's child already needs no other.
  const std::string bytes =
      is_expendable_process() ? work() : run_in_child(settings.max_seconds, work).answer;
  IpoptAnswer answer;
  if (bytes.empty()) return answer;  // no child that came to its end, or no start for Ipopt
  Unpacker unpacker(bytes, "ipopt: a child's answer");
  unpacker.list(answer.x);
  unpacker.number(answer.iterations);
  unpacker.number(answer.finished);
  unpacker.number(answer.seconds);
  unpacker.finish();
  return answer;
}

}  // namespace ballast
