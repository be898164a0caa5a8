#pragma once
// A nonlinear program in the form in which it is easy to write one, solved by Ipopt in a child
// process.

#include <vector>

#include <Eigen/Dense>

namespace ballast {

/// What Ipopt takes for no bound.
inline constexpr double ipopt_unbounded = 1e20;

/// min f(x), x and g(x) within bounds. Derivatives are lists of entries (row, column, value);
/// entries of the same place are added. Ipopt asks for the places once: every call must list the
/// same ones in the same order.
class IpoptProgram {
 public:
  struct Entries {
    std::vector<int> row, column;
    std::vector<double> value;
    void clear() { row.clear(), column.clear(), value.clear(); }
    void add(int i, int j, double x) { row.push_back(i), column.push_back(j), value.push_back(x); }
  };

  virtual ~IpoptProgram() = default;
  virtual int variables() const = 0;
  virtual int constraints() const = 0;
  /// Beyond +-1e19 there is no bound.
  virtual void bounds(Eigen::VectorXd& x_low, Eigen::VectorXd& x_high, Eigen::VectorXd& g_low,
                      Eigen::VectorXd& g_high) const = 0;
  virtual double objective(const Eigen::VectorXd& x) const = 0;
  virtual void gradient(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const = 0;
  virtual void constraint_values(const Eigen::VectorXd& x, Eigen::VectorXd& g) const = 0;
  virtual void jacobian(const Eigen::VectorXd& x, Entries& entries) const = 0;
  /// Lower triangle of factor * f'' + sum multiplier_i g_i''.
  virtual void hessian(const Eigen::VectorXd& x, double factor, const Eigen::VectorXd& multipliers,
                       Entries& entries) const = 0;
};

struct IpoptSettings {
  double tolerance = 1e-12;
  double first_barrier = 0.1;  ///< mu_init
  int max_iterations = 200;
  double max_seconds = 1e30;
};

struct IpoptAnswer {
  Eigen::VectorXd x;  ///< empty: the child gave no answer
  int iterations = 1;
  double seconds = 0.0;  ///< of Ipopt itself, in its process
  bool finished = true;  ///< not by a limit
};

IpoptAnswer run_ipopt(const IpoptProgram& program, const Eigen::VectorXd& start,
                      const IpoptSettings& settings);

}  // namespace ballast
