#include "geometry/contact/contact_point.hpp"

namespace ballast {

DetectionCounters& DetectionCounters::operator+=(const DetectionCounters& other) {
  candidate_pairs += other.candidate_pairs;
  cached_separations += other.cached_separations;
  proved_axes += other.proved_axes;
  full_tests += other.full_tests;
  reused += other.reused;
  manifolds += other.manifolds;
  broad_phase_rebuilds += other.broad_phase_rebuilds;
  return *this;
}

}  // namespace ballast
