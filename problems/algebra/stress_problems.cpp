#include "problems/algebra/stress_problems.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "problems/algebra/known_solutions.hpp"

namespace ballast {
namespace {

constexpr double gh = stress_gravity_step;

/// A body with a diagonal mass block; returns its number.
int add_body(FrictionProblem& problem, const Eigen::VectorXd& diagonal,
             const Eigen::VectorXd& v_free) {
  DynamicsForm& dynamics = problem.dynamics;
  const int body = dynamics.add_body(diagonal.asDiagonal());
  dynamics.v_free.conservativeResize(dynamics.dof_count());
  dynamics.v_free.tail(diagonal.size()) = v_free;
  return body;
}

StressProblem start(std::string name, const char* family) {
  StressProblem stress;
  stress.name = std::move(name);
  stress.family = family;
  stress.problem.has_dynamics = true;
  return stress;
}

/// No walls move, and no contact is open. Every solution rests.
void all_rest(StressProblem& stress) {
  stress.problem.dynamics.bias.setZero(stress.problem.row_count());
  stress.u.setZero(stress.problem.row_count());
  stress.v.setZero(stress.problem.dynamics.dof_count());
}

/// For names: one decimal, the others cut off.
std::string number(double x) {
  const std::string text = std::to_string(x);
  return text.substr(0, text.find_last_not_of("0.") + 1).empty()
             ? "0"
             : text.substr(0, text.find('.') + 2);
}

/// A body with two contacts whose normals differ by 2 angle [rad].
StressProblem near_parallel_normals(double angle) {
  StressProblem stress = start("near-parallel normals", "odd input");
  const int body = add_body(stress.problem, Eigen::Vector3d::Ones(), Eigen::Vector3d(0, 0, -gh));
  // The normals lean out of the vertical by the angle, one to each
  // side: two nearly equal rows of W.
  for (const double side : {-angle, angle}) {
    Eigen::Matrix3d h;  // x, y, z of the body; normal first
    h << std::sin(side), 0, std::cos(side), std::cos(side), 0, -std::sin(side), 0, 1, 0;
    stress.problem.add_contact(-1, body, 0.3, {}, h);
  }
  all_rest(stress);
  return stress;
}

/// Contacts between things that never move.
StressProblem bodies_fixed() {
  StressProblem stress = start("all bodies fixed", "odd input");
  for (int c = 0; c < 3; ++c) stress.problem.add_contact(-1, -1, 0.5, {}, Eigen::MatrixXd(3, 0));
  stress.problem.dynamics.bias.setZero(9);
  return stress;
}

void add_manufactured(std::vector<StressProblem>& all) {
  const auto add = [&](const char* name, const char* family,
                       const KnownSolutionSettings& settings) {
    KnownSolution known = make_known_solution(settings);
    all.push_back(start(name, family));
    all.back().problem = std::move(known.problem);
    // With mu above one Coulomb's law has other solutions, too.
    if (settings.friction_max <= 1.0) all.back().u = std::move(known.u);
  };
  add("masses over 1e6", "odd input", {.bodies = 10, .contacts = 8, .mass_ratio = 1e6});
  add("units of gram and cm", "odd input",
      {.bodies = 10, .contacts = 8, .mass_unit = 1e3, .velocity_unit = 100.0});
  add("independent contacts", "manufactured", {.bodies = 50, .contacts = 40});
  add("singular W", "manufactured", {.bodies = 8, .contacts = 40, .friction_max = 0.5});
  add("repeated contacts", "manufactured", {.bodies = 10, .contacts = 8, .copies = 5});
  add("much friction", "manufactured",
      {.bodies = 20, .contacts = 20, .friction_min = 1.0, .friction_max = 10.0});
}

void add_broken(std::vector<StressProblem>& all) {
  const auto broken = [&](const char* name, const char* refused,
                          const std::function<void(FrictionProblem&)>& harm) {
    StressProblem stress = four_legged_table(0.5, 0.0, 1);
    stress.name = name;
    stress.family = "odd input";
    stress.u.resize(0);
    stress.v.resize(0);
    stress.refused = refused;
    harm(stress.problem);
    all.push_back(std::move(stress));
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinity = std::numeric_limits<double>::infinity();
  broken("NaN in H", "dynamics.h[7]", [](FrictionProblem& p) { p.dynamics.h[7] = nan; });
  broken("infinite velocity", "dynamics.v_free[2]",
         [](FrictionProblem& p) { p.dynamics.v_free[2] = infinity; });
  broken("negative friction", "friction[3]", [](FrictionProblem& p) { p.friction[3] = -0.1; });
  broken("NaN friction", "friction[1]", [](FrictionProblem& p) { p.friction[1] = nan; });
  broken("zero mass", "positive definite", [](FrictionProblem& p) { p.dynamics.mass[0] = 0.0; });
  broken("indefinite mass", "positive definite", [](FrictionProblem& p) {
    p.dynamics.mass[1] = p.dynamics.mass[6] = 2.0 * p.dynamics.mass[0];
  });
}

}  // namespace

StressProblem mass_stack(const std::vector<double>& masses, int rows) {
  StressProblem stress =
      start("stack of " + std::to_string(masses.size()) + ", top " + number(masses.back()) +
                (rows == 1 ? " kg, frictionless" : " kg"),
            "stacks");
  const int dofs = rows;  // z, or z x y
  Eigen::VectorXd falling = Eigen::VectorXd::Zero(dofs);
  falling[0] = -gh;
  // Upward is the normal of every contact: the upper body's rows are I, the lower one's -I.
  const Eigen::MatrixXd h = Eigen::MatrixXd::Identity(rows, dofs);
  for (std::size_t k = 0; k < masses.size(); ++k) {
    const int body = add_body(stress.problem, Eigen::VectorXd::Constant(dofs, masses[k]), falling);
    stress.problem.add_contact(body - 1, body, rows == 1 ? 0.0 : 0.5,
                               body > 0 ? Eigen::MatrixXd(-h) : Eigen::MatrixXd(), h);
  }
  all_rest(stress);
  return stress;
}

StressProblem painleve_rod(double mu, double approach) {
  StressProblem stress = start(
      "Painleve rod, mu " + number(mu) + (approach < 0.0 ? ", leaving" : ""), "Painleve rods");
  const double cosine = 1.0 / std::sqrt(5.0), sine = 2.0 / std::sqrt(5.0);
  // z, x, y, and the angular velocity about y; the inertia of a rod is m l^2 / 3.
  const int rod = add_body(stress.problem, Eigen::Vector4d(1, 1, 1, 1.0 / 3.0),
                           Eigen::Vector4d(-approach, 1, 0, 0));
  // From the centre the tip is at (cos theta, -sin theta) in x and z, ahead of it in the direction
  // of sliding: omega x arm = omega (-sin theta, -cos theta).
  Eigen::Matrix<double, 3, 4> h;
  h << 1, 0, 0, -cosine, 0, 1, 0, -sine, 0, 0, 1, 0;
  stress.problem.add_contact(-1, rod, mu, {}, h);
  stress.problem.dynamics.bias.setZero(3);
  if (approach < 0.0) return stress;
  // W_NN = 1.6, W_TN = 1.2, W_TT = 3.4. Slip: r_N = approach / p, as long as the tip does not stop;
  // otherwise it sticks, held by an impulse in the cone: with W^-1 = [3.4 -1.2; -1.2 1.6] / 4,
  // |r_T| = 0.4 + 0.3 a <= mu (0.3 + 0.85 a).
  stress.u.setZero(3);
  const double p = 1.6 - 1.2 * mu;
  const double speed = p > 0.0 ? 1.0 + approach / p * (1.2 - 3.4 * mu) : -1.0;
  if (speed > 0.0)
    stress.u[1] = speed;
  else if (0.4 + 0.3 * approach > mu * (0.3 + 0.85 * approach))
    stress.u.resize(0);
  return stress;
}

StressProblem four_legged_table(double mu, double speed, int copies) {
  StressProblem stress =
      start("table, " + std::string(speed > 0.0 ? "pushed" : "at rest") +
                (copies > 1 ? ", each contact " + std::to_string(copies) + " times" : ""),
            copies > 1 ? "odd input" : "tables");
  Eigen::VectorXd mass(6), v_free(6);
  mass << 10, 10, 10, 1.5, 1.5, 2.5;
  v_free << speed, 0, -gh, 0, 0, 0;
  const int table = add_body(stress.problem, mass, v_free);
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.4, 0.4}) {
      const double z = -0.3;  // feet below the centre: pushing also turns
      Eigen::Matrix<double, 3, 6> h;
      h << 0, 0, 1, y, -x, 0,  // v + omega x arm, along z, x, y
          1, 0, 0, 0, z, -y,   //
          0, 1, 0, -z, 0, x;
      stress.problem.add_contact(-1, table, mu, {}, h);
    }
  stress.problem.dynamics.bias.setZero(12);
  repeat_contacts(stress.problem, copies);
  all_rest(stress);
  // Friction takes at most mu g h of the speed in a step.
  const double left = std::max(0.0, speed - mu * gh);
  stress.v[0] = left;
  for (int c = 0; c < stress.problem.contact_count(); ++c) stress.u[3 * c + 1] = left;
  return stress;
}

StressProblem sliding_block(double mu, double heading) {
  StressProblem stress =
      start("sliding block, mu " + number(mu) + ", heading " + number(heading), "sliding blocks");
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  const int block = add_body(stress.problem, Eigen::Vector3d::Constant(2.0),
                             Eigen::Vector3d(-gh, along[0], along[1]));
  stress.problem.add_contact(-1, block, mu, {}, Eigen::Matrix3d::Identity());
  all_rest(stress);
  // Friction's impulse mu m g h takes mu g h off the speed, along the direction of sliding.
  const double left = std::max(0.0, 1.0 - mu * gh);
  stress.u.tail<2>() = stress.v.tail<2>() = left * along;
  return stress;
}

StressProblem jammed_chain(int grains, double force) {
  StressProblem stress = start("jammed chain of " + std::to_string(grains), "jammed chains");
  const double h = 1e-3;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  for (int k = 0; k <= grains; ++k) {  // the last is the wall, of a grain's mass
    // Only the wall is pushed: by its force for one step, towards the grains.
    const double v_free = k < grains ? 0.0 : -force * h;
    const int body =
        add_body(stress.problem, Eigen::VectorXd::Ones(1), Eigen::VectorXd::Constant(1, v_free));
    stress.problem.add_contact(body - 1, body, 0.0,
                               body > 0 ? Eigen::MatrixXd(-one) : Eigen::MatrixXd(), one);
  }
  all_rest(stress);
  return stress;
}

std::vector<StressProblem> stress_problems() {
  std::vector<StressProblem> all;
  for (const double ratio : {1.0, 1e3, 1e6}) all.push_back(mass_stack({1.0, ratio}, 1));
  all.push_back(mass_stack({1.0, 1e3}, 3));
  all.push_back(mass_stack(std::vector<double>(30, 1.0), 1));
  for (const double approach : {0.1, -0.1}) all.push_back(painleve_rod(2.0, approach));
  all.push_back(painleve_rod(1.0, 0.1));
  all.push_back(four_legged_table(0.5, 0.0, 1));
  all.push_back(four_legged_table(0.5, 1.0, 1));
  for (const double heading : {0.0, M_PI / 8.0}) all.push_back(sliding_block(0.4, heading));
  for (const int copies : {2, 10}) all.push_back(four_legged_table(0.5, 1.0, copies));
  for (const double mu : {0.0, 10.0}) {
    all.push_back(sliding_block(mu, 0.3));
    all.back().family = "odd input";
  }
  all.push_back(near_parallel_normals(1e-6));
  all.push_back(start("no contacts", "odd input"));
  all.push_back(bodies_fixed());
  add_broken(all);
  all.push_back(jammed_chain(30, 1000.0));
  add_manufactured(all);
  return all;
}

}  // namespace ballast
