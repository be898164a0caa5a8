#include "problems/algebra/pile_problems.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "platform/random.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"

namespace ballast {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double gravity_step = 9.81e-3;  ///< what falls gains in a step of 1 ms [m/s]

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
    FrictionProblem stored;
    stored.row_begin = problem_.row_begin;
    stored.friction = problem_.friction;
    stored.has_delassus = true;
    stored.delassus.w = delassus_matrix(problem_);
    free_contact_velocity(problem_, stored.delassus.q);
    return stored;
  }

 private:
  /// As many as leave the redundancy that is asked for: 6 unknowns a body, 3 rows a contact.
  int body_count() const {
    // With B bodies and C contacts W has 3 C rows and the rank 6 B at
    // most: 1 - 6 B / 3 C is redundant.
    const double bodies = (1.0 - settings_.redundancy) * 0.5 * settings_.contacts;
    return std::max(1, static_cast<int>(std::lround(bodies)));
  }

  /// Lattice points along a side of the ground.
  int side_of(int bodies) const {
    // A lattice of width w and slenderness s has w x w x (s w) bodies.
    const double side = std::cbrt(bodies / settings_.slenderness);
    return std::max(1, static_cast<int>(std::lround(side)));
  }

  /// Near the points of a cubic lattice of spacing 1, in layers from below.
  void place_bodies() {
    const int bodies = body_count();
    const int side = side_of(bodies);
    for (int b = 0; b < bodies; ++b) {
      const int row = b / side % side, layer = b / (side * side);
      const Vector3d lattice(b % side, row, layer);
      centre_.push_back(lattice + in_cube(random_, 0.2));
      // Of about unit size: inertia about a tenth of mass times square size.
      const double mass = random_.log_uniform(1.0, settings_.mass_ratio);
      Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(6, mass);
      for (int i = 3; i < 6; ++i) diagonal[i] = mass * random_.uniform(0.05, 0.15);
      problem_.dynamics.add_body(diagonal.asDiagonal());
    }
  }

  /// All fall, move towards the middle of the ground, and are stirred.
  void press_together() {
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& x : centre_) middle += x / static_cast<double>(centre_.size());
    middle[2] = 0.0;
    Eigen::VectorXd& v = problem_.dynamics.v_free;
    v.resize(problem_.dynamics.dof_count());
    for (size_t b = 0; b < centre_.size(); ++b) {
      const Vector3d towards = -0.2 * gravity_step * (centre_[b] - middle);
      const Vector3d stirred = in_cube(random_, settings_.shear * gravity_step);
      v.segment<3>(6 * static_cast<Eigen::Index>(b)) =
          towards + stirred - Vector3d(0.0, 0.0, gravity_step);
      v.segment<3>(6 * static_cast<Eigen::Index>(b) + 3) =
          in_cube(random_, settings_.shear * gravity_step);
    }
  }

  /// The nearest pairs, three for a body: the lowest layer has the ground for a neighbour.
  void find_pairs() {
    const int bodies = static_cast<int>(centre_.size());
    const int side = side_of(bodies);
    const int layer = side * side;
    for (int b = 0; b < bodies; ++b) {
      if (b < layer) pairs_.push_back({-1, b, 0.0});
      // Steps between the numbers of lattice neighbours. One that leads over the end of a row joins
      // bodies far apart, which the sort by distance puts last.
      for (int step : {1, side, layer, side + 1, side - 1, layer + 1, layer + side})
        if (b >= step && step > 0)
          pairs_.push_back({b - step, b, (centre_[b] - centre_[b - step]).norm()});
    }
    std::stable_sort(pairs_.begin(), pairs_.end(),
                     [](const Pair& x, const Pair& y) { return x.distance < y.distance; });
    const size_t most = static_cast<size_t>(std::min(settings_.contacts, 3 * bodies));
    pairs_.resize(std::min(pairs_.size(), std::max<size_t>(1, most)));
  }

  /// The points are spread evenly over the pairs.
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

  /// A point of the pair's common face, which goes through `middle`.
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
    // An open gap, which is wider than what the step closes. Never below zero: rest stays allowed.
    const double gap = is_closed ? 0.0 : 2.0 * std::abs(free[0]) + gravity_step;
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

}  // namespace ballast
