#include "problems/algebra/made_problems.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "platform/random.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"

namespace ballast {
namespace {

constexpr double gh = made_gravity_step;

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d in_cube(ProblemRandom& random, double half) {
  return {random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half)};
}

/// Rows n, t1, t2.
Matrix3d frame_of(const Vector3d& n) {
  return contact_frame(n, std::abs(n[0]) < 0.7 ? Vector3d::UnitX() : Vector3d::UnitY());
}

/// Bodies that touch: a = -1 is the ground, below b.
struct Pair {
  int a, b;
  double distance;
};

class Pile {
 public:
  explicit Pile(const PileSettings& settings) : settings_(settings), random_(settings.seed) {}

  FrictionProblem make() {
    problem_.has_dynamics = true;
    place_bodies();
    press_together();
    find_pairs();
    add_contacts();
    for (double& entry : problem_.dynamics.mass) entry *= settings_.mass_unit;
    if (!settings_.is_stored) return std::move(problem_);
    Eigen::VectorXd q;
    free_contact_velocity(problem_, q);
    return local_problem(delassus_matrix(problem_), std::move(q), problem_.friction);
  }

 private:
  /// Lattice points along a side of the ground.
  int side_of(int bodies) const {
    // A lattice of width w and slenderness s has w x w x (s w) bodies.
    const double side = std::cbrt(bodies / settings_.slenderness);
    return std::max(1, static_cast<int>(std::lround(side)));
  }

  /// Places bodies near the points of a cubic lattice of spacing 1, in layers from below.
  void place_bodies() {
    // The number of bodies that gives the wanted redundancy: with B bodies and C contacts W has 3 C
    // rows and at most rank 6 B.
    const double wanted = (1.0 - settings_.redundancy) * 0.5 * settings_.contacts;
    const int bodies = std::max(1, static_cast<int>(std::lround(wanted)));
    const int side = side_of(bodies);
    for (int b = 0; b < bodies; ++b) {
      const int row = b / side % side, layer = b / (side * side);
      const Vector3d lattice(b % side, row, layer);
      centre_.push_back(lattice + in_cube(random_, 0.2));
      // Bodies have about unit size: inertia about a tenth of mass times square size.
      const double mass = random_.log_uniform(1.0, settings_.mass_ratio);
      Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(6, mass);
      for (int i = 3; i < 6; ++i) diagonal[i] = mass * random_.uniform(0.05, 0.15);
      problem_.dynamics.add_body(diagonal.asDiagonal());
    }
  }

  /// Sets v_free: all bodies fall, move towards the middle of the ground, and are stirred.
  void press_together() {
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& x : centre_) middle += x / static_cast<double>(centre_.size());
    middle[2] = 0.0;
    Eigen::VectorXd& v = problem_.dynamics.v_free;
    v.resize(problem_.dynamics.dof_count());
    for (size_t b = 0; b < centre_.size(); ++b) {
      const Vector3d towards = -0.2 * gh * (centre_[b] - middle);
      const Vector3d stirred = in_cube(random_, settings_.shear * gh);
      v.segment<3>(6 * static_cast<Eigen::Index>(b)) = towards + stirred - Vector3d(0.0, 0.0, gh);
      v.segment<3>(6 * static_cast<Eigen::Index>(b) + 3) = in_cube(random_, settings_.shear * gh);
    }
  }

  /// Finds the nearest pairs, up to three per body. The lowest layer neighbours the ground.
  void find_pairs() {
    const int bodies = static_cast<int>(centre_.size());
    const int side = side_of(bodies);
    const int layer = side * side;
    for (int b = 0; b < bodies; ++b) {
      if (b < layer) pairs_.push_back({-1, b, 0.0});
      // Steps between the numbers of lattice neighbours. A step over the end of a row joins bodies
      // far apart, which the sort by distance puts last.
      for (int step : {1, side, layer, side + 1, side - 1, layer + 1, layer + side})
        if (b >= step && step > 0)
          pairs_.push_back({b - step, b, (centre_[b] - centre_[b - step]).norm()});
    }
    std::ranges::stable_sort(pairs_, {}, &Pair::distance);
    const size_t most = static_cast<size_t>(std::min(settings_.contacts, 3 * bodies));
    pairs_.resize(std::min(pairs_.size(), std::max<size_t>(1, most)));
  }

  /// Spreads the contact points evenly over the pairs.
  void add_contacts() {
    const int pairs = static_cast<int>(pairs_.size());
    for (int k = 0; k < pairs; ++k) {
      const int points = settings_.contacts / pairs + (k < settings_.contacts % pairs ? 1 : 0);
      const Pair& pair = pairs_[k];
      const Vector3d b = centre_[pair.b];
      const Vector3d a = pair.a < 0 ? Vector3d(b[0], b[1], b[2] - 1.0) : centre_[pair.a];
      // Faces of polyhedra are not square to the line of centres.
      const Vector3d normal = ((b - a).normalized() + in_cube(random_, 0.2)).normalized();
      const bool is_closed = random_.uniform() < settings_.active;
      const double mu = random_.uniform(settings_.friction_min, settings_.friction_max);
      for (int point = 0; point < points; ++point)
        add_contact(pair, frame_of(normal), 0.5 * (a + b), mu, is_closed);
    }
    problem_.dynamics.bias =
        Eigen::Map<const Eigen::VectorXd>(bias_.data(), static_cast<Eigen::Index>(bias_.size()));
  }

  /// Adds a random point of the pair's common face, which goes through `middle`.
  void add_contact(const Pair& pair, const Matrix3d& frame, const Vector3d& middle, double mu,
                   bool is_closed) {
    const DynamicsForm& dynamics = problem_.dynamics;
    const Vector3d point = middle + random_.uniform(-0.4, 0.4) * frame.row(1).transpose() +
                           random_.uniform(-0.4, 0.4) * frame.row(2).transpose();
    Vector3d free = Vector3d::Zero();  // the contact's velocity without impulses
    const auto side = [&](int body, double sign) {
      const Eigen::MatrixXd rows = sign * rigid_rows(frame, point - centre_[body]);
      free += rows * dynamics.v_free.segment<6>(6 * static_cast<Eigen::Index>(body));
      return rows;
    };
    const Eigen::MatrixXd h_a = pair.a < 0 ? Eigen::MatrixXd() : side(pair.a, -1.0);
    problem_.add_contact(pair.a, pair.b, mu, h_a, side(pair.b, 1.0));
    // An open gap is wider than the step can close. No gap is below zero: rest stays a solution.
    const double gap = is_closed ? 0.0 : 2.0 * std::abs(free[0]) + gh;
    bias_.insert(bias_.end(), {gap, 0.0, 0.0});
  }

  PileSettings settings_;
  ProblemRandom random_;
  FrictionProblem problem_;
  std::vector<Vector3d> centre_;
  std::vector<Pair> pairs_;
  std::vector<double> bias_;
};

}  // namespace

FrictionProblem make_pile(const PileSettings& settings) { return Pile(settings).make(); }

PileSettings random_pile(std::uint64_t seed, int most_contacts) {
  ProblemRandom random(seed);
  PileSettings settings;
  settings.contacts =
      static_cast<int>(std::lround(random.log_uniform(2.0, std::max(2, most_contacts))));
  settings.redundancy = random.uniform(0.0, 0.8);
  settings.mass_ratio = random.log_uniform(1.0, 1e4);
  settings.friction_min = random.uniform(0.1, 1.0);
  settings.friction_max = random.uniform(settings.friction_min, 1.0);
  settings.active = random.uniform(0.4, 1.0);
  settings.shear = random.log_uniform(0.05, 5.0);
  settings.mass_unit = random.log_uniform(1e-2, 1e4);
  settings.slenderness = random.log_uniform(1.0, 30.0);
  settings.is_stored = random.uniform() < 0.75;
  settings.seed = seed;
  return settings;
}

// Small problems.

namespace {

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
  StressProblem stress{std::move(name), family, {}, {}, {}};
  stress.problem.has_dynamics = true;
  return stress;
}

/// No wall moves and no contact is open. Every solution is at rest.
void all_rest(StressProblem& stress) {
  stress.problem.dynamics.bias.setZero(stress.problem.row_count());
  stress.u.setZero(stress.problem.row_count());
  stress.v.setZero(stress.problem.dynamics.dof_count());
}

/// For names: one decimal, the others cut off.
std::string number(double x) {
  const std::string text = std::to_string(x);
  return x == 0.0 ? "0" : text.substr(0, text.find('.') + 2);
}

/// A body with two contacts whose normals differ by 2 angle [rad].
StressProblem near_parallel_normals(double angle) {
  StressProblem stress = start("near-parallel normals", "odd input");
  const int body = add_body(stress.problem, Eigen::Vector3d::Ones(), Eigen::Vector3d(0, 0, -gh));
  // The normals lean from the vertical by the angle, to opposite sides: two nearly equal rows of W.
  for (const double side : {-angle, angle}) {
    Eigen::Matrix3d h;  // x, y, z of the body; normal first
    h << std::sin(side), 0, std::cos(side), std::cos(side), 0, -std::sin(side), 0, 1, 0;
    stress.problem.add_contact(-1, body, 0.3, {}, h);
  }
  all_rest(stress);
  return stress;
}

/// Contacts between bodies that never move.
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
  all.push_back(jammed_chain(30, 1000.0));
  add_manufactured(all);
  return all;
}

}  // namespace ballast
