#include "solvers/seam/solver.hpp"

#include <algorithm>
#include <cmath>

#include "platform/text.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/friction_cone.hpp"

namespace ballast {

const char* name_of(StopReason reason) {
  return name_in(
      {"reached_tolerance", "iteration_limit", "time_limit", "stalled", "numerical_failure"},
      reason);
}

const char* name_of(Verdict verdict) { return name_in(verdict_names, verdict); }

const char* name_of(ContactLaw law) {
  return name_in({"coulomb", "convex_relaxation", "pyramid"}, law);
}

FclibStop::FclibStop(const FrictionProblem& problem, double tolerance)
    : problem_(&problem), tolerance_(tolerance) {
  if (problem.has_dynamics) factor_masses(problem.dynamics, roots_);
  free_contact_velocity(problem, q_);
  q_norm_ = q_.norm();
}

double FclibStop::measure(const Impulses& r) {
  // u = W r + q, with the masses factored once.
  if (problem_->has_dynamics) {
    const DynamicsForm& dynamics = problem_->dynamics;
    contact_to_body_impulse(dynamics, problem_->row_begin, r, v_);
    for (int b = 0; b < dynamics.body_count(); ++b) {
      roots_[b].solve_lower(v_.data() + dynamics.dof_begin[b]);
      roots_[b].solve_upper(v_.data() + dynamics.dof_begin[b]);
    }
    v_ += dynamics.v_free;
    body_to_contact_velocity(dynamics, problem_->row_begin, v_, u_);
  } else {
    u_ = q_;
    u_.noalias() += problem_->delassus.w * r;
  }
  // The natural map with rho = 1, contact by contact; a one-row contact is padded with zeros.
  double square = 0.0;
  for (int c = 0; c < problem_->contact_count(); ++c) {
    const int first = problem_->row_begin[c];
    const bool is_one_row = problem_->contact_rows(c) == 1;
    const Eigen::Vector3d rc =
        is_one_row ? Eigen::Vector3d(r[first], 0.0, 0.0) : Eigen::Vector3d(r.segment<3>(first));
    const Eigen::Vector3d uc =
        is_one_row ? Eigen::Vector3d(u_[first], 0.0, 0.0) : Eigen::Vector3d(u_.segment<3>(first));
    square += natural_map(rc, uc, problem_->friction[c], 1.0).squaredNorm();
  }
  const double scale = std::max({q_norm_, r.norm(), u_.norm()});
  const double value = std::sqrt(square);
  return scale > std::numeric_limits<double>::epsilon() ? value / scale : value;
}

bool FclibStop::reached(const Impulses& r, double natural_map) {
  if (!std::isfinite(natural_map)) return false;
  const bool is_idle = natural_map > 0.5 * looked_at_ && natural_map > near_aim * aim_;
  if (looks_ >= first_looks && is_idle) return false;
  ++looks_;
  looked_at_ = natural_map;
  const double value = measure(r);
  aim_ = value > 0.0 ? natural_map * tolerance_ / value : natural_map;
  return value <= tolerance_ * (1.0 - margin);
}

double Budget::aim() const { return fclib ? fclib->aim() : tolerance; }

Budget Budget::after(int iterations, double seconds) const {
  Budget rest = *this;
  rest.max_iterations = std::max(0, max_iterations - iterations);
  rest.max_seconds = std::max(0.0, max_seconds - seconds);
  return rest;
}

int contacts_with_friction(const FrictionProblem& problem) {
  return static_cast<int>(std::count_if(problem.friction.begin(), problem.friction.end(),
                                        [](double mu) { return mu > 0.0; }));
}

bool SizeLimit::admits(const FrictionProblem& problem) const {
  return none() ||
         (problem.contact_count() <= contacts && contacts_with_friction(problem) <= with_friction);
}

}  // namespace ballast
