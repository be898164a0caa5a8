#include "geometry/contact/convex_elements.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>

namespace ballast {

bool ConvexElements::are_needed(std::span<const ContactShape> bodies, const Period& period) {
  return period.repeats() ||
         std::ranges::any_of(bodies, [](const ContactShape& body) { return !body.parts.empty(); });
}

ConvexElements::ConvexElements(std::span<const ContactShape> bodies, const Period& period)
    : period_(period) {
  for (const bool is_image : {false, true}) {
    if (is_image && !period.repeats()) break;
    for (size_t b = 0; b < bodies.size(); ++b) {
      const int body = static_cast<int>(b);
      if (!bodies[b].polyhedron) {
        if (!is_image) elements_.push_back({bodies[b], {}, body, 0, false});
        continue;
      }
      int part = 0;
      for (const ConvexPart& convex : convex_parts(bodies[b])) {
        if (part == most_key_parts || convex.polyhedron->edge_count() >= most_key_features)
          throw std::invalid_argument("body " + std::to_string(b) +
                                      ": too many parts, or edges of one, for contact keys");
        const ContactShape shape{convex.polyhedron, {}, bodies[b].fixed};
        elements_.push_back({shape, convex.pose, body, part++, is_image});
      }
    }
  }
  poses_.resize(elements_.size());
  reach_.resize(elements_.size());
}

std::vector<ContactShape> ConvexElements::shapes() const {
  std::vector<ContactShape> shapes;
  for (const Element& element : elements_) shapes.push_back(element.shape);
  return shapes;
}

void ConvexElements::place(std::span<const Pose> bodies, std::span<const double> reach,
                           std::span<const Pose> ahead) {
  ahead_.resize(ahead.empty() ? 0 : elements_.size());
  for (size_t e = 0; e < elements_.size(); ++e) {
    const Element& element = elements_[e];
    const Pose& body = bodies[element.body];
    poses_[e].rotation = body.rotation * element.pose.rotation;
    poses_[e].position = body.rotation * element.pose.position;
    poses_[e].position += element.shape.polyhedron ? period_.wrapped(body.position) : body.position;
    if (element.is_image) poses_[e].position += period_.vector;
    reach_[e] = reach[element.body];
    if (ahead.empty()) continue;
    const Pose& next = ahead[element.body];  // shifted by as many whole periods as at present
    ahead_[e].rotation = next.rotation * element.pose.rotation;
    ahead_[e].position = poses_[e].position + (next.position - body.position) +
                         next.rotation * element.pose.position -
                         body.rotation * element.pose.position;
  }
}

void ConvexElements::name_bodies(std::vector<ContactPoint>& contacts) const {
  for (ContactPoint& contact : contacts) {
    const Element &a = elements_[contact.body_a], &b = elements_[contact.body_b];
    const bool is_turned = a.shape.polyhedron && a.body > b.body;
    contact.feature = key_of_parts(contact.feature, a.part, b.part, is_turned);
    contact.body_a = a.body;
    contact.body_b = b.body;
    if (!is_turned) continue;
    std::swap(contact.body_a, contact.body_b);
    contact.normal = -contact.normal;
  }
  std::ranges::sort(contacts, {}, [](const ContactPoint& contact) {
    return std::tuple(contact.body_a, contact.body_b, contact.feature);
  });
}

}  // namespace ballast
