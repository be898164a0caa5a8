#include "problems/algebra/answer_distance.hpp"

#include <algorithm>
#include <cmath>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"

namespace ballast {
namespace {

double part_of(double difference, double whole) {
  return difference == 0.0 ? 0.0 : std::abs(difference / whole);
}

/// Sets the differences of body velocities and of the wall force (dynamics form only).
void compare_bodies(const FrictionProblem& problem, const Impulses& answer,
                    const Impulses& solution, AnswerDistance& distance) {
  const DynamicsForm& dynamics = problem.dynamics;
  Eigen::VectorXd velocity, exact, impulse, exact_impulse;
  body_velocity(dynamics, problem.row_begin, answer, velocity);
  body_velocity(dynamics, problem.row_begin, solution, exact);
  contact_to_body_impulse(dynamics, problem.row_begin, answer, impulse);
  contact_to_body_impulse(dynamics, problem.row_begin, solution, exact_impulse);
  // dv . M dv = dv . H^T dr
  const double energy = (velocity - exact).dot(impulse - exact_impulse);
  double mass = 0.0;
  for (int b = 0; b < dynamics.body_count(); ++b) mass += dynamics.mass[dynamics.mass_begin[b]];
  distance.velocity = mass > 0.0 ? std::sqrt(std::max(0.0, energy) / mass) : 0.0;
  const int wall = driven_wall(problem);
  if (wall < 0) return;
  const int unknown = dynamics.dof_begin[wall];
  distance.wall_force = part_of(impulse[unknown] - exact_impulse[unknown], exact_impulse[unknown]);
}

/// The status by r - rho u, rho = 1 / `lambda_max` of W_cc: open where its normal part is not
/// positive, stick inside Coulomb's cone. Where r or u is zero to rounding, the other decides.
ContactStatus contact_status(const Eigen::Vector3d& r, const Eigen::Vector3d& u, double mu,
                             double lambda_max) {
  const Eigen::Vector3d z = lambda_max * r - u;
  if (!(z[0] > 0.0)) return ContactStatus::open;
  return tangential_norm(z) <= mu * z[0] ? ContactStatus::stick : ContactStatus::slip;
}

}  // namespace

int driven_wall(const FrictionProblem& problem) {
  for (int b = 0; problem.has_dynamics && b < problem.dynamics.body_count(); ++b)
    if (problem.dynamics.body_dofs(b) == 1) return b;
  return -1;
}

AnswerDistance answer_distance(const FrictionProblem& problem, const Impulses& answer,
                               const Impulses& solution, double velocity_scale) {
  AnswerDistance distance;
  if (solution.size() == 0 && problem.row_count() > 0) return distance;
  Eigen::VectorXd u, exact, q;
  contact_velocity(problem, answer, u);
  contact_velocity(problem, solution, exact);
  free_contact_velocity(problem, q);
  distance.contact_velocity = (u - exact).norm() / std::sqrt(std::max(1, problem.contact_count()));
  distance.body_impulse =
      std::sqrt(part_of((answer - solution).dot(u - exact), solution.dot(exact - q)));
  if (problem.has_dynamics) compare_bodies(problem, answer, solution, distance);
  distance.statuses = 0;
  std::vector<Eigen::Matrix3d> blocks;
  delassus_diagonal(problem, blocks);
  for (int c = 0; c < problem.contact_count(); ++c) {
    const double lambda_max = largest_eigenvalue(blocks[c]);
    const auto status = [&](const Impulses& r, const Eigen::VectorXd& at) {
      return contact_status(rows_of_contact(problem, r, c), rows_of_contact(problem, at, c),
                            problem.friction[c], lambda_max);
    };
    if (status(answer, u) != status(solution, exact)) ++distance.statuses;
  }
  distance.velocity /= velocity_scale;
  distance.contact_velocity /= velocity_scale;
  return distance;
}

}  // namespace ballast
