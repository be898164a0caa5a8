#pragma once
// Warm starts: last step's impulses carried to this step's contact points by feature key.

#include <span>
#include <vector>

#include "geometry/contact/contact_detector.hpp"

namespace ballast {

/// Carries one world-frame vector (an impulse on body b [N s]) per contact point from a step to the
/// next.
///
/// Both contact lists are sorted by (body_a, body_b, feature), so that one merge matches them. The
/// impulse of a point whose key has gone goes to the nearest unmatched new point of the same pair,
/// or to the nearest of all if every one is matched. A pair that stays thus keeps its sum; a pair
/// that has gone loses its impulse. `carried` is resized to the new contacts; points without a past
/// get zero. No allocation once grown.
void carry_impulses(std::span<const ContactPoint> old_contacts, std::span<const Vec3> old_impulses,
                    std::span<const ContactPoint> new_contacts, std::vector<Vec3>& carried);

}  // namespace ballast
