#include "solvers/backends/jacobi.hpp"

#include <algorithm>
#include <utility>

#include "solvers/parts/contact_operator.hpp"
#include "solvers/parts/one_contact.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

// r := r + theta (r^ - r), r^_c the exact solution of contact c while the others are held. With D
// the diagonal blocks of W, a frictionless problem's energy falls for theta < 2 / lambda_max(D^-1
// W); theta = 1 / lambda_max falls most surely. Where the error grows all the same (friction, an
// estimate from below) theta is halved.
class Jacobi final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    w_.prepare(problem);
    contacts_.assign(w_.contact_count(), {});
    for (int c = 0; c < w_.contact_count(); ++c)
      make_principal(w_.diagonal()[c], w_.friction(c), contacts_[c].local, contacts_[c].turn);
    const double lambda =
        largest_eigenvalue(w_, [this](Eigen::VectorXd& x) { divide_by_diagonal(x); });
    damping_ = lambda > 1.0 ? 1.0 / lambda : 1.0;
  }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {1, 1.1});
    for (Contact& contact : contacts_) contact.slip = 0.0;
    for (int c = 0; c < w_.contact_count(); ++c)
      if (!(contacts_[c].local.inverse_normal > 0.0))
        w_.put(r, c, Eigen::Vector3d::Zero());  // it would stay
    u_.resize(problem.row_count());
    w_.velocity(r, u_);
    double theta = damping_, last_error = w_.error(r, u_);
    iteration.evaluated(last_error, r);
    while (iteration.next()) {
      relax(r, theta);
      w_.velocity(r, u_);
      if (!iteration.error_due()) continue;
      const double error = w_.error(r, u_);
      iteration.evaluated(error, r);
      if (error > 2.0 * last_error) theta = std::max(0.5 * theta, 1e-3 * damping_);
      last_error = error;
    }
    return iteration.finish(std::move(r));
  }

 private:
  struct Contact {
    PrincipalContact local;
    TangentTurn turn;
    double slip = 0.0;
  };

  /// Every contact's exact answer to the same velocities u, a part theta of the way.
  void relax(Impulses& r, double theta) {
    for (int c = 0; c < w_.contact_count(); ++c) {
      Contact& contact = contacts_[c];
      const Eigen::Vector3d before = w_.at(r, c), u = w_.at(u_, c);
      Eigen::Vector3d after = before;
      resolve_contact(contact.local, contact.turn, u.data(), after.data(), contact.slip);
      w_.put(r, c, before + theta * (after - before));
    }
  }

  /// x := D^-1 x, in the principal coordinates of each contact.
  void divide_by_diagonal(Eigen::VectorXd& x) const {
    for (int c = 0; c < w_.contact_count(); ++c) {
      // W_cc y = x by the Schur complement of the tangents, which is diagonal in principal ones.
      const PrincipalContact& local = contacts_[c].local;
      Eigen::Vector3d u = w_.at(x, c);
      contacts_[c].turn.to_principal(u[1], u[2]);
      u[1] = (u[1] - local.c1 * u[0]) * local.inverse_s1;
      u[2] = (u[2] - local.c2 * u[0]) * local.inverse_s2;
      u[0] = u[0] * local.inverse_normal - local.c1 * u[1] - local.c2 * u[2];
      contacts_[c].turn.from_principal(u[1], u[2]);
      w_.put(x, c, u);
    }
  }

  ContactOperator w_;
  std::vector<Contact> contacts_;
  Eigen::VectorXd u_;
  double damping_ = 1.0;
};

}  // namespace

std::unique_ptr<Solver> make_jacobi() { return std::make_unique<Jacobi>(); }

}  // namespace ballast
