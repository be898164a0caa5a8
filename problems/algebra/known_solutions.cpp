#include "problems/algebra/known_solutions.hpp"

#include <cmath>

#include "platform/random.hpp"

namespace ballast {
namespace {

Eigen::Vector3d random_direction(ProblemRandom& random) {
  for (;;) {  // rejection from the cube
    const Eigen::Vector3d x(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double length = x.norm();
    if (length > 0.1 && length <= 1.0) return x / length;
  }
}

/// Rows n, t1, t2 of a right-handed frame.
Eigen::Matrix3d random_frame(ProblemRandom& random) {
  const Eigen::Vector3d n = random_direction(random);
  Eigen::Vector3d other = random_direction(random);
  while (std::abs(n.dot(other)) > 0.9) other = random_direction(random);
  return contact_frame(n, other);
}

/// Adds a rigid body of about unit size: mass m, inertia about m/10, and turned axes, so that its
/// block is not diagonal.
void add_body(double mass, ProblemRandom& random, DynamicsForm& dynamics) {
  const Eigen::Vector3d inertia(random.uniform(0.05, 0.15), random.uniform(0.05, 0.15),
                                random.uniform(0.05, 0.15));
  const Eigen::Matrix3d axes = random_frame(random);
  Eigen::Matrix<double, 6, 6> block = Eigen::Matrix<double, 6, 6>::Zero();
  block.topLeftCorner<3, 3>().diagonal().setConstant(mass);
  const Eigen::Matrix3d turned = mass * axes.transpose() * inertia.asDiagonal() * axes;
  block.bottomRightCorner<3, 3>() = 0.5 * (turned + turned.transpose());
  dynamics.add_body(block);
}

/// The block of H for a random point at distance 0.5 from the centre of the body.
Eigen::MatrixXd random_side(const Eigen::Matrix3d& frame, int rows, ProblemRandom& random) {
  return rigid_rows(frame, 0.5 * random_direction(random)).topRows(rows);
}

/// Chooses (r, u) of one contact that obeys Coulomb's law to rounding: open, slip or stick.
void choose_solution(const KnownSolutionSettings& settings, double mu, int rows,
                     ProblemRandom& random, double* r, double* u) {
  const double kind = random.uniform(), angle = 2.0 * M_PI * random.uniform();
  const double t1 = std::cos(angle), t2 = std::sin(angle);
  const double force = random.uniform(0.1, 1.0), speed = random.uniform(0.1, 1.0);
  // Open: no impulse, and any velocity that separates.
  if (kind < settings.open_fraction) {
    u[0] = speed;
    if (rows == 3) {
      u[1] = random.uniform(-1, 1);
      u[2] = random.uniform(-1, 1);
    }
    return;
  }
  // Closed: with r on the cone's side it slips against r, with r inside the cone it sticks.
  r[0] = force;
  if (rows == 1) return;
  const bool slips = kind < settings.open_fraction + settings.slip_fraction;
  const double share = slips ? 1.0 : random.uniform(0.0, 0.95);
  r[1] = share * mu * force * t1;
  r[2] = share * mu * force * t2;
  if (slips) {
    u[1] = -speed * t1;
    u[2] = -speed * t2;
  }
}

}  // namespace

KnownSolution make_known_solution(const KnownSolutionSettings& settings) {
  ProblemRandom random(settings.seed);
  KnownSolution known;
  FrictionProblem& problem = known.problem;
  DynamicsForm& dynamics = problem.dynamics;
  problem.has_dynamics = true;
  // A seed stands for random numbers in this order: bodies, contacts, solutions, v_free.
  for (int b = 0; b < settings.bodies; ++b)
    add_body(random.log_uniform(1.0, settings.mass_ratio), random, dynamics);

  for (int c = 0; c < settings.contacts; ++c) {
    const bool frictionless = random.uniform() < settings.frictionless_fraction;
    const int b = random.below(settings.bodies);
    const int a = random.below(settings.bodies + 1) - 1;  // -1: against the ground
    // No body touches itself: a == b means the ground, too.
    const Eigen::Matrix3d frame = random_frame(random);
    const int rows = frictionless ? 1 : 3;
    Eigen::MatrixXd h_a;
    if (a >= 0 && a != b) h_a = -random_side(frame, rows, random);
    const Eigen::MatrixXd h_b = random_side(frame, rows, random);
    const double mu =
        frictionless ? 0.0 : random.uniform(settings.friction_min, settings.friction_max);
    problem.add_contact(a == b ? -1 : a, b, mu, h_a, h_b);
  }

  known.r.setZero(problem.row_count());
  known.u.setZero(problem.row_count());
  for (int c = 0; c < settings.contacts; ++c)
    choose_solution(settings, problem.friction[c], problem.contact_rows(c), random,
                    known.r.data() + problem.row_begin[c], known.u.data() + problem.row_begin[c]);

  dynamics.v_free.resize(dynamics.dof_count());
  for (double& v : dynamics.v_free) v = random.uniform(-1, 1);
  // bias = u - H v makes (r, u) the solution.
  dynamics.bias.setZero(problem.row_count());
  Eigen::VectorXd moved;
  contact_velocity(problem, known.r, moved);
  dynamics.bias = known.u - moved;

  // Copies share their contact's impulse and have its velocity.
  if (settings.copies > 1) {
    const std::vector<int> first = problem.row_begin;
    repeat_contacts(problem, settings.copies);
    Eigen::VectorXd r(problem.row_count()), u(problem.row_count());
    for (int c = 0; c < problem.contact_count(); ++c) {
      const int from = first[c / settings.copies], rows = problem.contact_rows(c);
      r.segment(problem.row_begin[c], rows) = known.r.segment(from, rows) / settings.copies;
      u.segment(problem.row_begin[c], rows) = known.u.segment(from, rows);
    }
    known.r = r;
    known.u = u;
  }
  // Angular unknowns count as velocities at a distance of one length unit, so that H stays the
  // same.
  for (double& entry : dynamics.mass) entry *= settings.mass_unit;
  dynamics.v_free *= settings.velocity_unit;
  dynamics.bias *= settings.velocity_unit;
  known.r *= settings.mass_unit * settings.velocity_unit;
  known.u *= settings.velocity_unit;
  return known;
}

void repeat_contacts(FrictionProblem& problem, int copies) {
  const FrictionProblem once = problem;
  const DynamicsForm& from = once.dynamics;
  problem.clear_contacts();
  problem.dynamics.h.clear();
  problem.dynamics.bias.resize(static_cast<Eigen::Index>(once.row_count()) * copies);
  for (int c = 0; c < once.contact_count(); ++c)
    for (int copy = 0; copy < copies; ++copy) {
      const int rows = once.contact_rows(c), a = from.body_a[c], b = from.body_b[c];
      const double* block = from.h.data() + from.h_begin[c];
      using Block = Eigen::Map<const Eigen::MatrixXd>;
      problem.dynamics.bias.segment(problem.row_count(), rows) =
          from.bias.segment(once.row_begin[c], rows);
      problem.add_contact(a, b, once.friction[c], Block(block, rows, from.body_dofs(a)),
                          Block(block + rows * from.body_dofs(a), rows, from.body_dofs(b)));
    }
}

}  // namespace ballast
