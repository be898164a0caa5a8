#include "geometry/contact/detected_bodies.hpp"

#include <map>
#include <utility>

namespace ballast {

DetectedBodies::DetectedBodies(std::vector<ContactShape> bodies, double reuse_motion)
    : shapes(std::move(bodies)), rotations(shapes.size()), travel(shapes.size()) {
  // Bodies of one polyhedron share its tables.
  std::map<const Polyhedron*, int> number;
  std::vector<const Polyhedron*> distinct;
  for (const ContactShape& body : shapes) {
    table_of.push_back(-1);
    if (!body.polyhedron) continue;
    const auto [at, is_new] = number.emplace(body.polyhedron, static_cast<int>(distinct.size()));
    if (is_new) distinct.push_back(body.polyhedron);
    table_of.back() = at->second;
  }
  tables.reserve(distinct.size());
  for (const Polyhedron* polyhedron : distinct) tables.emplace_back(*polyhedron);
  for (int i = 0; i < count(); ++i) bounds.push_back(shape(i) ? shape(i)->bounds() : BodyBounds{});
  if (reuse_motion > 0.0)
    for (const BodyBounds& body : bounds) margin.push_back(reuse_motion * body.circumradius);
  wide_reach_.resize(margin.size());
}

void DetectedBodies::take(std::span<const Pose> new_poses, std::span<const double> new_reach) {
  poses = new_poses;
  given_reach = reach = new_reach;
  for (size_t i = 0; i < poses.size(); ++i) rotations[i] = poses[i].rotation.toRotationMatrix();
  if (holds()) {
    for (size_t i = 0; i < poses.size(); ++i) wide_reach_[i] = given_reach[i] + margin[i];
    reach = wide_reach_;
  }
  // Motion summed up step by step: of two times, the difference of the
  // sums bounds the motion between.
  for (size_t i = 0; i < previous_.size(); ++i) {
    const Travel step = step_bound(previous_[i], poses[i]);
    travel[i].shift += step.shift;
    travel[i].turn += step.turn;
  }
  previous_.assign(poses.begin(), poses.end());
}

}  // namespace ballast
