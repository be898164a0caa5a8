#include "solvers/parts/newton_system.hpp"

namespace ballast {

void NewtonSystem::prepare(const ContactOperator& w) {
  operations_ = 0.0;
  if (!w.problem().has_dynamics) return matrix_form_.prepare(w.problem());
  matrix_.prepare(w.problem());
  operations_ = matrix_.operations();
}

bool NewtonSystem::solve_bodies(const ContactOperator& w,
                                const std::vector<ContactLinearisation>& linear,
                                const std::vector<double>& alpha, Impulses& dr) {
  const FrictionProblem& problem = w.problem();
  const DynamicsForm& d = problem.dynamics;
  // B^-1 f and E = B^-1 by_u of every contact.
  // The contacts' equations give dr = -B^-1 f - E du, du = H dv, and the bodies' M dv = H^T dr.
  gain_.resize(linear.size());
  source_.resize(linear.size());
  dr.resize(problem.row_count());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const Eigen::Matrix3d inverse = (linear[c].by_r + alpha[c] * linear[c].by_u).inverse();
    source_[c] = inverse * linear[c].f;
    gain_[c] = inverse * linear[c].by_u;
    if (problem.contact_rows(c) == 1)
      gain_[c] = Eigen::Vector3d(gain_[c](0, 0), 0.0, 0.0).asDiagonal();
    if (!source_[c].allFinite() || !gain_[c].allFinite()) return false;
    w.put(dr, c, -source_[c]);
  }
  // dv, and from it the impulses that were eliminated.
  contact_to_body_impulse(d, problem.row_begin, dr, right_);
  if (!matrix_.solve(gain_, right_, dv_)) return false;
  body_to_contact_velocity(d, problem.row_begin, dv_, u_);
  // It adds the bias, which a change of velocity has not.
  u_ -= d.bias;
  for (int c = 0; c < problem.contact_count(); ++c)
    w.put(dr, c, -source_[c] - gain_[c] * w.at(u_, c));
  return true;
}

bool NewtonSystem::solve(const ContactOperator& w, const std::vector<ContactLinearisation>& linear,
                         const std::vector<double>& alpha, Impulses& dr) {
  if (w.problem().has_dynamics) return solve_bodies(w, linear, alpha, dr);
  const bool is_solved = matrix_form_.solve(linear, alpha, dr);
  operations_ = matrix_form_.operations();
  return is_solved;
}

}  // namespace ballast
