#pragma once
// Splits bodies of several convex parts, and worlds that repeat themselves, into the convex shapes
// that detection works on.
//
// An element is one convex part of a body, or a plane. In a world that repeats itself every part
// has a second element, its image one period on: bodies stand within the first period, so that two
// bodies that touch across its end touch as a body and an image, and the contact is found once.

#include <span>
#include <vector>

#include "geometry/contact/contact_point.hpp"

namespace ballast {

class ConvexElements {
 public:
  /// Planes must contain the period, bodies be smaller than half of it: read_bodies() checks both.
  /// Throws std::invalid_argument on too many parts, or edges of one, for contact keys.
  ConvexElements(std::span<const ContactShape> bodies, const Period& period);

  /// Whether some body has `parts` or the world repeats itself, so that bodies are no elements.
  static bool are_needed(std::span<const ContactShape> bodies, const Period& period);

  int count() const { return static_cast<int>(elements_.size()); }
  int body(int element) const { return elements_[element].body; }
  bool is_image(int element) const { return elements_[element].is_image; }
  std::vector<ContactShape> shapes() const;

  /// Places the elements with their bodies, at present and at the next detection (empty: unknown).
  void place(std::span<const Pose> bodies, std::span<const double> reach,
             std::span<const Pose> ahead = {});
  std::span<const Pose> poses() const { return poses_; }
  std::span<const Pose> ahead() const { return ahead_; }
  std::span<const double> reach() const { return reach_; }

  /// Turns contacts of elements into contacts of bodies: a is the plane or the smaller index, the
  /// keys also name the parts, and the order is again by (body_a, body_b, feature). The position of
  /// a contact with an image is beside body a, or beside it one period on.
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
