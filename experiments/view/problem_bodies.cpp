#include "experiments/view/problem_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// What the contacts and the mass block of one body tell.
struct KnownBody {
  std::vector<Vec3> points, centres;  ///< contact points; the centre of mass by each that tells it
  std::vector<Vec3> normals;          ///< out of the body
  double mass = 0.0, radius = 0.0;    ///< [kg]; of the ball of the same mean inertia [m]

  bool is_plane() const {
    return radius == 0.0 && std::all_of(normals.begin(), normals.end(), [&](const Vec3& normal) {
             return normal.dot(normals.front()) > 1.0 - 1e-6;
           });
  }
  Vec3 centre() const {
    const std::vector<Vec3>& places = centres.empty() ? points : centres;
    Vec3 sum = Vec3::Zero();
    for (const Vec3& place : places) sum += place;
    return sum / static_cast<double>(places.size());
  }
};

/// A body turns when it has six unknowns; its mass block is principal, about the body's axes.
void read_mass(const DynamicsForm& dynamics, int body, KnownBody& known) {
  if (dynamics.body_dofs(body) != 6) return;
  const double* block = dynamics.mass.data() + dynamics.mass_begin[static_cast<size_t>(body)];
  known.mass = block[0];
  // a ball has 2/5 m r^2 about each of its three axes
  known.radius = std::sqrt(5.0 * (block[21] + block[28] + block[35]) / (6.0 * block[0]));
}

std::map<int, KnownBody> known_bodies(const CapturedProblem& captured) {
  std::map<int, KnownBody> bodies;
  for (int c = 0; c < captured.problem.contact_count(); ++c)
    for (const bool is_b : {false, true}) {
      const auto k = static_cast<size_t>(c);
      KnownBody& known = bodies[is_b ? captured.id_b[k] : captured.id_a[k]];
      const Vec3 point(captured.position.data() + 3 * k), normal(captured.frame.data() + 9 * k);
      const DynamicsForm& dynamics = captured.problem.dynamics;
      read_mass(dynamics, is_b ? dynamics.body_b[k] : dynamics.body_a[k], known);
      known.points.push_back(point);
      known.normals.push_back(is_b ? Vec3(-normal) : normal);
      if (const Vec3 lever = lever_of(captured, c, is_b); !lever.isZero())
        known.centres.push_back(point - lever);
    }
  return bodies;
}

BodySpec hull_of(const KnownBody& known, int id) {
  BodySpec body;
  body.name = printed("body %d", id);
  body.mass = known.mass;
  body.pose.position = known.centre();
  double reach = 0.0;
  for (const Vec3& point : known.points)
    reach = std::max(reach, (point - body.pose.position).norm());
  // what does not turn has no inertia: a small ball keeps its hull from being flat
  const double radius = known.radius > 0.0 ? 0.9 * known.radius : std::max(0.05 * reach, 1e-6);
  const Polyhedron ball = make_sphere(radius, 0);
  std::vector<Vec3> corners(ball.vertices().begin(), ball.vertices().end());
  for (const Vec3& point : known.points) corners.push_back(point - body.pose.position);
  body.shape = std::make_shared<const Polyhedron>(convex_hull(corners));
  return body;
}

}  // namespace

Vec3 lever_of(const CapturedProblem& captured, int contact, bool of_b) {
  const auto c = static_cast<size_t>(contact);
  const DynamicsForm& dynamics = captured.problem.dynamics;
  const int rows = captured.problem.contact_rows(contact);
  const int body = of_b ? dynamics.body_b[c] : dynamics.body_a[c];
  if (rows != 3 || dynamics.body_dofs(body) != 6) return Vec3::Zero();
  const double* block = dynamics.h.data() + dynamics.h_begin[c] +
                        (of_b ? rows * dynamics.body_dofs(dynamics.body_a[c]) : 0);
  // a row is +-(s x R^T d) for each direction d of the frame F, about the body's axes; with
  // A = F^T rows, A A^T = |s|^2 I - s s^T in the world frame
  const Eigen::Map<const Mat3> turning(block + 9);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> frame(captured.frame.data() +
                                                                             9 * c);
  const Mat3 a = frame.transpose() * turning, gram = a * a.transpose();
  const Mat3 square = 0.5 * gram.trace() * Mat3::Identity() - gram;
  int largest = 0;
  const double top = square.diagonal().maxCoeff(&largest);
  if (!(top > 0.0)) return Vec3::Zero();
  const Vec3 lever = square.col(largest) / std::sqrt(top);
  // the centre of a convex body lies behind its contact's plane
  const double outward = (of_b ? -1.0 : 1.0) * frame.row(0).dot(lever);
  return outward < 0.0 ? Vec3(-lever) : lever;
}

ViewData bodies_of_problem(const CapturedProblem& captured, std::vector<FrameContact> contacts) {
  const std::map<int, KnownBody> bodies = known_bodies(captured);
  ViewData view;
  view.has_shapes = false;
  MotionState state;
  std::map<int, int> place;  // of a body of the problem in the view
  // walls come last
  for (const bool are_walls : {false, true})
    for (const auto& [id, known] : bodies) {
      if (known.is_plane() != are_walls) continue;
      place[id] = static_cast<int>(view.system.bodies.size());
      if (are_walls) {
        WallSpec wall;
        wall.name = printed("wall %d", id);
        wall.normal = known.normals.front();
        wall.offset = wall.normal.dot(known.points.front());
        add_wall(view.system, state, wall);
      } else {
        const double volume = 4.0 / 3.0 * M_PI * std::pow(known.radius, 3);
        add_body(view.system, state, hull_of(known, id), volume);
      }
    }
  for (FrameContact& contact : contacts) {
    contact.body_a = place.at(contact.body_a);
    contact.body_b = place.at(contact.body_b);
  }
  const std::vector<double>& friction = captured.problem.friction;
  if (!friction.empty()) view.friction = *std::max_element(friction.begin(), friction.end());
  view.frames = {{captured.time, captured.step, state.pose, state.velocity, state.spin}};
  view.contacts = [contacts](size_t) { return contacts; };
  return view;
}

}  // namespace ballast
