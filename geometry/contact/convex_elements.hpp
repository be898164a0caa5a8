#pragma once
// Bodies of several convex parts, and worlds that repeat themselves, as the convex shapes that
// detection looks at.
//
// An element is one convex part of a body, or a plane. In a world that repeats itself every part
// has a second element, its image one period on: bodies stand within the first period, so that two
// that touch across its end touch as a body and an image, and are found once.

#include <span>
#include <vector>

#include "geometry/contact/contact_point.hpp"
#include "geometry/shape/period.hpp"

namespace ballast {

class ConvexElements {
 public:
  /// Planes contain the period, bodies are smaller than half of it: read_bodies() asks for both.
  /// Throws std::invalid_argument: too many parts or edges of one for the keys of contacts.
  ConvexElements(std::span<const ContactShape> bodies, const Period& period);

  /// Whether bodies are anything else than elements.
  static bool are_needed(std::span<const ContactShape> bodies, const Period& period);

  int count() const { return static_cast<int>(elements_.size()); }
  int body(int element) const { return elements_[element].body; }
  bool is_image(int element) const { return elements_[element].is_image; }
  std::vector<ContactShape> shapes() const;

  /// Places the elements with their bodies, now and at the next detection (which may be unknown).
  void place(std::span<const Pose> bodies, std::span<const double> reach,
             std::span<const Pose> ahead = {});
  std::span<const Pose> poses() const { return poses_; }
  std::span<const Pose> ahead() const { return ahead_; }
  std::span<const double> reach() const { return reach_; }

  /// Contacts of elements become contacts of bodies: a plane or the smaller index is a, the keys
  /// name the parts too, and the order is by (body_a, body_b, feature) again. Of a contact with an
  /// image the position is beside body a, or beside it one period on.
  void name_bodies(std::vector<ContactPoint>& contacts) const;

 private:
  struct Element {
    ContactShape shape;
    Pose pose;  // in the body frame
    int body, part;
    bool is_image;
  };
  std::vector<Element> elements_;
  Period period_;
  std::vector<Pose> poses_, ahead_;
  std::vector<double> reach_;
};

}  // namespace ballast
